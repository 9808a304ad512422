//! Which windings of a four-phase motor carry current, step after step.

use crate::Polarity;
use thiserror::Error;

/// Windings that carry current from step to step.
///
/// A winding is a bit of a nibble: 1, 2, 4, 8 for A, B, A', B', where A' is A with the current
/// reversed, by another winding of a unipolar motor or by the bridge of a bipolar one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the sequences of four windings")]
pub enum Stepping {
    /// One winding at a time: 1, 2, 4, 8. The full step of \[Dancer\].
    Wave,
    /// Two windings at a time, with more torque: 3, 6, 12, 9.
    Full,
    /// One and two in turn, half the angle: 1, 3, 2, 6, 4, 12, 8, 9.
    #[default]
    Half,
}

/// Where in the byte the nibble stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a byte has two nibbles")]
pub enum Placement {
    /// In bits 0 to 3; the others are 0.
    #[default]
    Low,
    /// In bits 4 to 7; the others are 0.
    High,
    /// In both: two motors in step, or a nibble taken from either end of the bus.
    Doubled,
}

/// How the windings are wired to the byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "a setting written as a literal; `..Wiring::default()` keeps old code"
)]
pub struct Wiring {
    /// The bit of the nibble, 0 to 3, of each winding A, B, A', B'.
    pub bits: [u8; 4],
    /// Level at which a winding carries current; active low inverts the nibble.
    pub polarity: Polarity,
    /// Where in the byte the nibble stands.
    pub placement: Placement,
}

impl Wiring {
    /// A, B, A', B' at bits 0 to 3 of the byte, active high: the four windings of a unipolar motor
    /// in the order in which they turn it.
    pub const UNIPOLAR: Self = Self {
        bits: [0, 1, 2, 3],
        polarity: Polarity::ActiveHigh,
        placement: Placement::Low,
    };

    /// The four inputs of two H-bridges, A+ A- B+ B- at bits 0 to 3: a bipolar motor. Never are
    /// both inputs of a bridge on.
    pub const BIPOLAR: Self = Self {
        bits: [0, 2, 1, 3],
        ..Self::UNIPOLAR
    };

    /// The wiring with the order of the four bits reversed.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            bits: self.bits.map(|bit| bit ^ 3),
            ..self
        }
    }
}

impl Default for Wiring {
    fn default() -> Self {
        Self::UNIPOLAR
    }
}

/// Why a wiring is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WiringError {
    /// A bit that no nibble has.
    #[error("winding {winding} at bit {bit} of a nibble; the last is 3")]
    NoSuchBit {
        /// Index of the winding: 0 to 3 for A, B, A', B'.
        winding: usize,
        /// Bit given.
        bit: u8,
    },
    /// Two windings at the same bit.
    #[error("windings {first} and {second} both at bit {bit}")]
    SharedBit {
        /// Index of the winding that has the bit.
        first: usize,
        /// Index of the winding that would have it too.
        second: usize,
        /// Bit given.
        bit: u8,
    },
}

/// Where in its electrical turn a motor stands: one of eight half steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Phase {
    // 0 to 7.
    half_step: u8,
}

impl Phase {
    /// Half steps since the phase in which A alone carries current, 0 to 7.
    #[must_use]
    pub const fn half_step(self) -> u8 {
        self.half_step
    }
}

/// Half steps of an electrical turn.
const TURN: [u8; 8] = [1, 3, 2, 6, 4, 12, 8, 9];

/// The phases of a motor: the byte of each, and their order.
///
/// The phase itself is a small value of each motor, so that motors with the same windings share
/// this table of 11 bytes. A change of direction starts from the phase at hand: the rotor does not
/// jump.
///
/// # Examples
/// ```
/// use motor_phases::{Phases, Stepping, Wiring};
/// let phases = Phases::new(Stepping::Half, Wiring::UNIPOLAR)?;
/// let mut phase = phases.start();
/// let mut bytes = [0; 4];
/// for (byte, step) in bytes.iter_mut().zip([1, 1, -1, -1]) {
///     phase = phases.advance(phase, step);
///     *byte = phases.byte(phase);
/// }
/// assert_eq!(bytes, [3, 2, 3, 1]);
/// # Ok::<(), motor_phases::WiringError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Phases {
    // As wired, in bits 0 to 3.
    nibbles: [u8; 8],
    off: u8,
    stepping: Stepping,
    placement: Placement,
}

impl Phases {
    /// The phases of a motor wired so.
    ///
    /// # Errors
    /// [`WiringError`] unless the four bits are 0 to 3, each once.
    pub fn new(stepping: Stepping, wiring: Wiring) -> Result<Self, WiringError> {
        for (second, &bit) in wiring.bits.iter().enumerate() {
            if bit > 3 {
                return Err(WiringError::NoSuchBit {
                    winding: second,
                    bit,
                });
            }
            match wiring.bits.iter().position(|&other| other == bit) {
                Some(first) if first != second => {
                    return Err(WiringError::SharedBit { first, second, bit });
                }
                _ => {}
            }
        }
        let off = match wiring.polarity {
            Polarity::ActiveHigh => 0,
            Polarity::ActiveLow => 0xF,
        };
        let wired = |windings: u8| {
            let levels = (0..).zip(wiring.bits);
            levels.fold(off, |nibble, (winding, bit)| {
                nibble ^ (windings.wrapping_shr(winding) & 1).wrapping_shl(u32::from(bit))
            })
        };
        Ok(Self {
            nibbles: TURN.map(wired),
            off,
            stepping,
            placement: wiring.placement,
        })
    }

    /// The phase in which a motor starts: A alone, or A and B under [`Stepping::Full`].
    #[must_use]
    pub const fn start(&self) -> Phase {
        let half_step = match self.stepping {
            Stepping::Wave | Stepping::Half => 0,
            Stepping::Full => 1,
        };
        Phase { half_step }
    }

    /// The phase `steps` steps further; backwards when negative.
    #[inline]
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "only the low three bits count"
    )]
    pub fn advance(&self, phase: Phase, steps: impl Into<i32>) -> Phase {
        let half_steps = match self.stepping {
            Stepping::Wave | Stepping::Full => steps.into().wrapping_shl(1),
            Stepping::Half => steps.into(),
        };
        // 8 divides 2^8: wrapping keeps the phase.
        Phase {
            half_step: phase.half_step.wrapping_add(half_steps as u8) & 7,
        }
    }

    /// The nibble of a phase as wired, in bits 0 to 3.
    #[inline]
    #[must_use]
    pub fn nibble(&self, phase: Phase) -> u8 {
        // `get` never misses: a phase is 0 to 7.
        let nibble = self.nibbles.get(usize::from(phase.half_step & 7));
        nibble.copied().unwrap_or(self.off)
    }

    /// The byte of a phase.
    #[inline]
    #[must_use]
    pub fn byte(&self, phase: Phase) -> u8 {
        self.place(self.nibble(phase))
    }

    /// The nibble with no winding on.
    #[must_use]
    pub const fn off_nibble(&self) -> u8 {
        self.off
    }

    /// The byte with no winding on: the motor neither turns nor holds.
    #[must_use]
    pub const fn off_byte(&self) -> u8 {
        self.place(self.off)
    }

    /// The phase whose byte this is, if it is one that the motor can stand in.
    #[must_use]
    pub fn phase_of(&self, byte: u8) -> Option<Phase> {
        let turns = 0..8;
        turns
            .map(|step: i8| self.advance(self.start(), step))
            .find(|&phase| self.byte(phase) == byte)
    }

    const fn place(&self, nibble: u8) -> u8 {
        let high = nibble.wrapping_shl(4);
        match self.placement {
            Placement::Low => nibble,
            Placement::High => high,
            Placement::Doubled => high | nibble,
        }
    }
}
