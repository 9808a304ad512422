//! What the firmware does with an accumulator at its threshold, for planning and for simulation.

use core::str::FromStr;

use motor_phases::SpeedLaw;
use serde::Serialize;
use thiserror::Error;

/// What the firmware does every tick with the speed v of a motor, its accumulator a and the
/// threshold L, 600 in \[Dancer\].
///
/// ```text
/// Reset            a += |v|   a >= L:   a = 0,    one half step in the direction of v
/// CarryMagnitude   a += |v|   a >= L:   a -= L,   the same
/// CarrySigned      a += v     |a| >= L: a -= ±L,  one half step in the direction of a
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize)]
#[expect(
    clippy::exhaustive_enums,
    reason = "the firmware is compiled for one of three"
)]
pub enum Law {
    /// The law of the source. The overshoot is lost: at a threshold of 600 there are 44 distinct
    /// speeds, and 119 is 16 % slow.
    #[default]
    #[serde(rename = "reset")]
    Reset,
    /// The overshoot is kept, whatever the direction.
    #[serde(rename = "carry")]
    CarryMagnitude,
    /// The overshoot is kept with its sign.
    #[serde(rename = "signed")]
    CarrySigned,
}

impl Law {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Reset, Self::CarryMagnitude, Self::CarrySigned];

    /// Its name on a command line and in a report: `reset`, `carry` or `signed`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reset => "reset",
            Self::CarryMagnitude => "carry",
            Self::CarrySigned => "signed",
        }
    }

    /// The law to compare with: an exact one beside the source's, the source's beside an exact one.
    pub(crate) const fn other(self) -> Self {
        match self {
            Self::Reset => Self::CarrySigned,
            Self::CarryMagnitude | Self::CarrySigned => Self::Reset,
        }
    }
}

/// A law that is none of [`Law::ALL`].
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{name:?} is not reset, carry or signed")]
#[non_exhaustive]
pub struct UnknownLaw {
    /// What it was called.
    pub name: String,
}

impl FromStr for Law {
    type Err = UnknownLaw;

    fn from_str(name: &str) -> Result<Self, UnknownLaw> {
        let mut all = Self::ALL.into_iter();
        let known = all.find(|law| law.name() == name);
        known.ok_or_else(|| UnknownLaw {
            name: name.to_owned(),
        })
    }
}

/// The law of the simulated firmware.
impl From<Law> for SpeedLaw {
    fn from(law: Law) -> Self {
        match law {
            Law::Reset => Self::Reset,
            Law::CarryMagnitude => Self::CarryMagnitude,
            Law::CarrySigned => Self::CarrySigned,
        }
    }
}
