//! The memory areas of the partner and how they are addressed.

use core::fmt;

use thiserror::Error;

/// The kind of a memory area: byte 4 of a FETCH command.
///
/// | kind | code | unit of length |
/// |---|---|---|
/// | data block | `D` 44h | word |
/// | extended data block | `X` 58h | word |
/// | inputs | `E` 45h | byte |
/// | outputs | `A` 41h | byte |
/// | flags | `M` 4Dh | byte |
/// | timers | `T` 54h | word |
/// | counters | `Z` 5Ah | word |
/// | peripheral (S5) | `P` 50h | byte |
/// | absolute addresses (S5) | `S` 53h | word |
/// | system data (S5) | `B` 42h | word |
///
/// The letters are German. A translated manual that prints `I`, `O`, `C` gives the same
/// hexadecimal codes, and those hold. The sources name the three S5 areas without their units:
/// the units above are this crate's reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum AreaKind {
    /// Data block, DB.
    DataBlock,
    /// Extended data block, DX.
    ExtendedDataBlock,
    /// Process image of the inputs.
    Inputs,
    /// Process image of the outputs.
    Outputs,
    /// Flags (bit memory).
    Flags,
    /// Timers, one word each.
    Timers,
    /// Counters, one word each.
    Counters,
    /// S5 peripheral bytes.
    Peripheral,
    /// S5 absolute addresses.
    Absolute,
    /// S5 system data words.
    System,
}

impl AreaKind {
    /// Every kind, in the order of the table.
    const ALL: [Self; 10] = [
        Self::DataBlock,
        Self::ExtendedDataBlock,
        Self::Inputs,
        Self::Outputs,
        Self::Flags,
        Self::Timers,
        Self::Counters,
        Self::Peripheral,
        Self::Absolute,
        Self::System,
    ];

    /// The code in byte 4 of a FETCH command.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::DataBlock => b'D',
            Self::ExtendedDataBlock => b'X',
            Self::Inputs => b'E',
            Self::Outputs => b'A',
            Self::Flags => b'M',
            Self::Timers => b'T',
            Self::Counters => b'Z',
            Self::Peripheral => b'P',
            Self::Absolute => b'S',
            Self::System => b'B',
        }
    }

    /// The kind that `code` stands for, if any.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.code() == code)
    }

    /// Bytes in one unit of length: 1 where lengths count bytes, 2 where they count words.
    #[must_use]
    pub const fn bytes_per_unit(self) -> usize {
        match self {
            Self::Inputs | Self::Outputs | Self::Flags | Self::Peripheral => 1,
            _ => 2,
        }
    }

    /// Whether byte 5 of a command means something here; elsewhere it is 0.
    ///
    /// It is the block's number in DB and DX. For S5 absolute addresses and system data the
    /// sources do not describe it: any value passes.
    const fn has_number(self) -> bool {
        matches!(
            self,
            Self::DataBlock | Self::ExtendedDataBlock | Self::Absolute | Self::System
        )
    }
}

impl fmt::Display for AreaKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::DataBlock => "DB",
            Self::ExtendedDataBlock => "DX",
            Self::Inputs => "inputs",
            Self::Outputs => "outputs",
            Self::Flags => "flags",
            Self::Timers => "timers",
            Self::Counters => "counters",
            Self::Peripheral => "peripheral",
            Self::Absolute => "absolute addresses",
            Self::System => "system data",
        })
    }
}

/// An area without numbers was addressed with a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{kind} has no number (byte 5): {number} instead of 0")]
#[non_exhaustive]
pub struct AreaError {
    /// The area's kind.
    pub kind: AreaKind,
    /// The number given.
    pub number: u8,
}

/// An address in the partner's memory: kind, number, first unit (bytes 4 to 6 of a FETCH command).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(try_from = "(AreaKind, u8, u8)", into = "(AreaKind, u8, u8)")
)]
pub struct Area {
    kind: AreaKind,
    number: u8,
    start: u8,
}

impl Area {
    /// An address of any kind.
    ///
    /// # Errors
    /// [`AreaError`] if `number` is not 0 and the kind has none.
    pub const fn new(kind: AreaKind, number: u8, start: u8) -> Result<Self, AreaError> {
        if number != 0 && !kind.has_number() {
            return Err(AreaError { kind, number });
        }
        Ok(Self {
            kind,
            number,
            start,
        })
    }

    const fn plain(kind: AreaKind, start: u8) -> Self {
        Self {
            kind,
            number: 0,
            start,
        }
    }

    /// Data block `number` from data word `word` on.
    #[must_use]
    pub const fn db(number: u8, word: u8) -> Self {
        Self {
            kind: AreaKind::DataBlock,
            number,
            start: word,
        }
    }

    /// Extended data block `number` from data word `word` on.
    #[must_use]
    pub const fn dx(number: u8, word: u8) -> Self {
        Self {
            kind: AreaKind::ExtendedDataBlock,
            number,
            start: word,
        }
    }

    /// Inputs from byte `byte` on.
    #[must_use]
    pub const fn inputs(byte: u8) -> Self {
        Self::plain(AreaKind::Inputs, byte)
    }

    /// Outputs from byte `byte` on.
    #[must_use]
    pub const fn outputs(byte: u8) -> Self {
        Self::plain(AreaKind::Outputs, byte)
    }

    /// Flags from byte `byte` on.
    #[must_use]
    pub const fn flags(byte: u8) -> Self {
        Self::plain(AreaKind::Flags, byte)
    }

    /// Timers from timer `first` on.
    #[must_use]
    pub const fn timers(first: u8) -> Self {
        Self::plain(AreaKind::Timers, first)
    }

    /// Counters from counter `first` on.
    #[must_use]
    pub const fn counters(first: u8) -> Self {
        Self::plain(AreaKind::Counters, first)
    }

    /// The area's kind.
    #[must_use]
    pub const fn kind(self) -> AreaKind {
        self.kind
    }

    /// Number of the data block; 0 in areas without numbers.
    #[must_use]
    pub const fn number(self) -> u8 {
        self.number
    }

    /// First data word, byte, timer or counter.
    #[must_use]
    pub const fn start(self) -> u8 {
        self.start
    }
}

impl TryFrom<(AreaKind, u8, u8)> for Area {
    type Error = AreaError;

    fn try_from((kind, number, start): (AreaKind, u8, u8)) -> Result<Self, AreaError> {
        Self::new(kind, number, start)
    }
}

impl From<Area> for (AreaKind, u8, u8) {
    fn from(area: Area) -> Self {
        (area.kind, area.number, area.start)
    }
}

impl fmt::Display for Area {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.kind.has_number() {
            write!(f, "{} {} from {}", self.kind, self.number, self.start)
        } else {
            write!(f, "{} from {}", self.kind, self.start)
        }
    }
}
