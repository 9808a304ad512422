//! The presets by their names on a command line.

use clap::ValueEnum;
use proto3964r::{Config, Priority};

/// A parameter set of `proto3964r`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Preset {
    /// Siemens 3964R: QVZ 2000 ms, ZVZ 220 ms, with BCC.
    #[value(name = "siemens-3964r")]
    Siemens3964r,
    /// Siemens 3964: QVZ 550 ms, without BCC.
    #[value(name = "siemens-3964")]
    Siemens3964,
    /// EUCHNER hand-held unit HBLS.
    Hbls,
    /// EUCHNER hand-held unit HBAS.
    Hbas,
    /// The former Linux line discipline.
    Linux,
    /// Buderus KM271.
    Km271,
}

impl Preset {
    /// The parameters, for this priority.
    pub(crate) fn config(self, priority: Priority) -> Config {
        match self {
            Self::Siemens3964r => Config::siemens_3964r(priority),
            Self::Siemens3964 => Config::siemens_3964(priority),
            Self::Hbls => Config::euchner_hbls(),
            Self::Hbas => Config::euchner_hbas(),
            Self::Linux => Config::linux(priority),
            Self::Km271 => Config::km271(),
        }
        .with_priority(priority)
    }
}

/// The character frame.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Parity {
    /// 8N1.
    None,
    /// 8E1.
    Even,
    /// 8O1.
    Odd,
}

impl Parity {
    /// The same for the port.
    pub(crate) fn of_port(self) -> serialport::Parity {
        match self {
            Self::None => serialport::Parity::None,
            Self::Even => serialport::Parity::Even,
            Self::Odd => serialport::Parity::Odd,
        }
    }
}
