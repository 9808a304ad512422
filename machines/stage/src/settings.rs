//! How the simulated stage is driven.

use core::fmt;
use core::str::FromStr;

use anyhow::{Error, Result, bail, ensure};

use crate::paths::PathRule;

/// When the axes step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Stepping {
    /// Each axis by itself, along smoothed lines and arcs as fast as feed and motors allow.
    #[default]
    Timed,
    /// On the path of an interpolator, at the feed from the first step to the last, as published.
    AtFeed(PathRule),
}

impl Stepping {
    /// Its name on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Timed => "timed",
            Self::AtFeed(rule) => rule.name(),
        }
    }

    /// The interpolator's, or that with the least deviation.
    pub(crate) const fn path_rule(self) -> PathRule {
        match self {
            Self::Timed => PathRule::Nearest,
            Self::AtFeed(rule) => rule,
        }
    }
}

impl fmt::Display for Stepping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Stepping {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Ok(Self::AtFeed(match name {
            "timed" => return Ok(Self::Timed),
            "published" => PathRule::Published,
            "nearest" => PathRule::Nearest,
            "bresenham" => PathRule::Bresenham,
            _ => bail!("it is one of timed, published, nearest and bresenham"),
        }))
    }
}

/// How the simulated stage is driven, and what it does wrong.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "settings, set by their names")]
pub struct Settings {
    /// When the axes step.
    pub stepping: Stepping,
    /// How far timed steps may leave the lines to pass their corners faster, in mm.
    pub tolerance_mm: f64,
    /// The probability with which a step is lost, within 0..=1.
    pub lose_steps: f64,
    /// Which steps are lost.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            stepping: Stepping::Timed,
            tolerance_mm: 0.01,
            lose_steps: 0.0,
            seed: 0,
        }
    }
}

/// The largest tolerance: more is another drawing.
const MAX_TOLERANCE_MM: f64 = 1.0;

impl Settings {
    /// Whether the numbers are within their ranges.
    ///
    /// # Errors
    /// Which is not.
    pub(crate) fn check(&self) -> Result<()> {
        ensure!(
            (0.0..=MAX_TOLERANCE_MM).contains(&self.tolerance_mm),
            "a tolerance of {} mm, not within 0..={MAX_TOLERANCE_MM}",
            self.tolerance_mm
        );
        Ok(())
    }
}
