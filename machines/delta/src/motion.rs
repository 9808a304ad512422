//! How the platform goes along its lines.

use core::fmt;
use core::str::FromStr;

use anyhow::{Error, Result, bail};

/// How the platform goes along its lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Motion {
    /// As fast as feed, arms and motors allow, round the corners, from rest to rest.
    #[default]
    Rounded,
    /// Each line at its feed from its first step to its last: motors of a real machine stall.
    Trains,
}

impl Motion {
    /// Its name on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rounded => "rounded",
            Self::Trains => "trains",
        }
    }
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Motion {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Ok(match name {
            "rounded" => Self::Rounded,
            "trains" => Self::Trains,
            _ => bail!("the motions are rounded and trains"),
        })
    }
}
