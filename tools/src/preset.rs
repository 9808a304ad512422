//! Parameter sets by their names.

use proto3964r::{Config, Line, Priority};
use serde::Deserialize;

/// A parameter set of `proto3964r`, by name on a command line and in a configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Preset {
    /// Siemens 3964R: QVZ 2000 ms, ZVZ 220 ms, with BCC.
    #[serde(rename = "siemens-3964r")]
    #[cfg_attr(feature = "cli", value(name = "siemens-3964r"))]
    Siemens3964r,
    /// Siemens 3964: QVZ 550 ms, without BCC.
    #[serde(rename = "siemens-3964")]
    #[cfg_attr(feature = "cli", value(name = "siemens-3964"))]
    Siemens3964,
    /// EUCHNER hand-held pendant HBLS.
    Hbls,
    /// EUCHNER hand-held pendant HBAS.
    Hbas,
    /// The former Linux line discipline.
    Linux,
    /// Buderus KM271.
    Km271,
}

impl Preset {
    /// The parameters, for this priority and this line.
    #[must_use]
    pub const fn config(self, priority: Priority, line: Line) -> Config {
        let preset = match self {
            Self::Siemens3964r => Config::siemens_3964r(priority, line),
            Self::Siemens3964 => Config::siemens_3964(priority, line),
            Self::Hbls => Config::euchner_hbls(line),
            Self::Hbas => Config::euchner_hbas(line),
            Self::Linux => Config::linux(priority, line),
            Self::Km271 => Config::km271(line),
        };
        Config { priority, ..preset }
    }
}
