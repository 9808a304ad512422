//! Coordination flag and CPU number: bytes 9 and 10 of a command.

use thiserror::Error;

/// Byte 9 without a coordination flag.
const NO_FLAG: u8 = 0xFF;
/// A nibble of byte 10 that says nothing.
const NO_NIBBLE: u8 = 0x0F;

/// One CPU of a partner with several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_enums, reason = "the header has four, no more")]
pub enum Cpu {
    /// CPU 1.
    One,
    /// CPU 2.
    Two,
    /// CPU 3.
    Three,
    /// CPU 4.
    Four,
}

impl Cpu {
    /// The CPU's number, 1 to 4.
    const fn number(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Three => 3,
            Self::Four => 4,
        }
    }

    /// The CPU with that number, if it is 1 to 4.
    const fn from_number(number: u8) -> Option<Self> {
        match number {
            1 => Some(Self::One),
            2 => Some(Self::Two),
            3 => Some(Self::Three),
            4 => Some(Self::Four),
            _ => None,
        }
    }
}

/// Why bytes 9 and 10 of a command mean nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CoordinationError {
    /// Flag byte and flag bit do not go together: bits are 0 to 7, and Fh exactly with flag byte
    /// `FFh`.
    #[error("coordination flag (bytes 9, 10): byte {byte:02X}h with bit {bit:X}h")]
    Flag {
        /// Byte 9.
        byte: u8,
        /// Low nibble of byte 10.
        bit: u8,
    },
    /// CPUs are 1 to 4; 0h stands next to a flag, Fh where there is no flag.
    #[error("CPU number (high nibble of byte 10): {nibble:X}h")]
    Cpu {
        /// High nibble of byte 10.
        nibble: u8,
    },
}

/// The flag bit by which a partner locks data against being overwritten or read too early.
///
/// A partner that finds the bit set refuses the command
/// ([`ReactionError::Locked`](crate::ReactionError::Locked)); when the data have moved it sets
/// the bit, and its own program clears it again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "(u8, u8)", into = "(u8, u8)"))]
pub struct CoordinationFlag {
    byte: u8,
    bit: u8,
}

impl CoordinationFlag {
    /// Bit `bit` (0 to 7) of flag byte `byte` (0 to 254).
    ///
    /// # Errors
    /// [`CoordinationError::Flag`] outside these ranges.
    pub const fn new(byte: u8, bit: u8) -> Result<Self, CoordinationError> {
        if byte == NO_FLAG || bit > 7 {
            return Err(CoordinationError::Flag { byte, bit });
        }
        Ok(Self { byte, bit })
    }

    /// Number of the flag byte.
    #[must_use]
    pub const fn byte(self) -> u8 {
        self.byte
    }

    /// The byte in which this flag alone is set.
    #[must_use]
    pub const fn mask(self) -> u8 {
        1 << self.bit
    }
}

impl TryFrom<(u8, u8)> for CoordinationFlag {
    type Error = CoordinationError;

    fn try_from((byte, bit): (u8, u8)) -> Result<Self, CoordinationError> {
        Self::new(byte, bit)
    }
}

impl From<CoordinationFlag> for (u8, u8) {
    fn from(flag: CoordinationFlag) -> Self {
        (flag.byte, flag.bit)
    }
}

/// Coordination flag and CPU number of a command, each or neither.
///
/// | given | byte 9 | byte 10, high nibble | low nibble |
/// |---|---|---|---|
/// | neither | FFh | Fh | Fh |
/// | flag | flag byte | 0h | flag bit |
/// | CPU | FFh | 1h to 4h | Fh |
/// | both | flag byte | 1h to 4h | flag bit |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(
    clippy::exhaustive_structs,
    reason = "bytes 9 and 10 hold these two, no more"
)]
pub struct Coordination {
    /// The coordination flag, if any.
    pub flag: Option<CoordinationFlag>,
    /// The CPU, if any.
    pub cpu: Option<Cpu>,
}

impl Coordination {
    /// Neither flag nor CPU.
    pub(crate) const NONE: Self = Self {
        flag: None,
        cpu: None,
    };

    /// Bytes 9 and 10.
    pub(crate) const fn encode(self) -> [u8; 2] {
        let (byte, bit) = match self.flag {
            Some(flag) => (flag.byte, flag.bit),
            None => (NO_FLAG, NO_NIBBLE),
        };
        let cpu = match (self.cpu, self.flag) {
            (Some(cpu), _) => cpu.number(),
            (None, Some(_)) => 0,
            (None, None) => NO_NIBBLE,
        };
        [byte, cpu << 4 | bit]
    }

    /// What bytes 9 and 10 say; [`CoordinationError`] for pairs outside the table.
    pub(crate) const fn decode([byte, nibbles]: [u8; 2]) -> Result<Self, CoordinationError> {
        let (cpu, bit) = (nibbles >> 4, nibbles & 0x0F);
        let flag = if byte == NO_FLAG && bit == NO_NIBBLE {
            None
        } else {
            match CoordinationFlag::new(byte, bit) {
                Ok(flag) => Some(flag),
                Err(error) => return Err(error),
            }
        };
        let cpu = match (cpu, flag) {
            (0, Some(_)) | (NO_NIBBLE, None) => None,
            _ => match Cpu::from_number(cpu) {
                Some(cpu) => Some(cpu),
                None => return Err(CoordinationError::Cpu { nibble: cpu }),
            },
        };
        Ok(Self { flag, cpu })
    }
}

impl From<CoordinationFlag> for Coordination {
    fn from(flag: CoordinationFlag) -> Self {
        Self {
            flag: Some(flag),
            cpu: None,
        }
    }
}

impl From<Cpu> for Coordination {
    fn from(cpu: Cpu) -> Self {
        Self {
            flag: None,
            cpu: Some(cpu),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordination_follows_the_nibble_rules() {
        let flag = Some(CoordinationFlag::new(20, 3).unwrap());
        let cpu = Some(Cpu::Two);
        let table = [
            (Coordination::NONE, [0xFF, 0xFF]),
            (Coordination { flag, cpu: None }, [20, 0x03]),
            (Coordination { flag: None, cpu }, [0xFF, 0x2F]),
            (Coordination { flag, cpu }, [20, 0x23]),
        ];
        for (coordination, bytes) in table {
            assert_eq!(coordination.encode(), bytes);
            assert_eq!(Coordination::decode(bytes), Ok(coordination));
        }
    }

    #[test]
    fn coordination_accepts_exactly_what_it_encodes() {
        let mut accepted = 0;
        for bytes in (0..=u16::MAX).map(u16::to_be_bytes) {
            if let Ok(coordination) = Coordination::decode(bytes) {
                assert_eq!(coordination.encode(), bytes);
                accepted += 1;
            }
        }
        // 255 flag bytes of 8 bits or no flag, each with one of four CPUs or none.
        assert_eq!(accepted, (255 * 8 + 1) * 5);
    }

    #[test]
    fn wrong_coordination_names_the_bytes() {
        let flag = |byte, bit| Err(CoordinationError::Flag { byte, bit });
        assert_eq!(Coordination::decode([0xFF, 0x03]), flag(0xFF, 3));
        assert_eq!(Coordination::decode([20, 0x08]), flag(20, 8));
        assert_eq!(Coordination::decode([20, 0x0F]), flag(20, 0x0F));
        let cpu = |nibble| Err(CoordinationError::Cpu { nibble });
        assert_eq!(Coordination::decode([20, 0x53]), cpu(5));
        assert_eq!(Coordination::decode([20, 0xF3]), cpu(0xF));
        assert_eq!(Coordination::decode([0xFF, 0x0F]), cpu(0));
    }
}
