//! The law of the accumulators, as every crate calls it.

use clap::ValueEnum;
use pose2pulse::{pattern_codec::dance, stepper_sync::SpeedLaw};
use serde::Serialize;

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Law {
    /// Back to 0, as in the source: the overshoot is lost.
    #[default]
    Reset,
    /// The overshoot is kept.
    Carry,
    /// The overshoot is kept with its sign.
    Signed,
}

impl Law {
    /// The law to compare with: exact beside the source's, the source's beside an exact one.
    pub(crate) const fn other(self) -> Self {
        match self {
            Self::Reset => Self::Signed,
            Self::Carry | Self::Signed => Self::Reset,
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Reset => "reset",
            Self::Carry => "carry",
            Self::Signed => "signed",
        }
    }
}

/// For planning.
impl From<Law> for dance::Law {
    fn from(law: Law) -> Self {
        match law {
            Law::Reset => Self::Reset,
            Law::Carry => Self::CarryMagnitude,
            Law::Signed => Self::CarrySigned,
        }
    }
}

/// For the simulated firmware.
impl From<Law> for SpeedLaw {
    fn from(law: Law) -> Self {
        match law {
            Law::Reset => Self::Reset,
            Law::Carry => Self::CarryMagnitude,
            Law::Signed => Self::CarrySigned,
        }
    }
}
