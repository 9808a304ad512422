//! The mode in which a tool swings.

use anyhow::{Result, anyhow};
use path_timing::{Mode, Shaper};
use serde::{Deserialize, Serialize};

/// `[mode]`, as written.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ModeSettings {
    hz: f64,
    damping: f64,
    shaper: String,
}

/// A mode in which a tool swings, and the shaper for it.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "a mode and its shaper")]
pub struct Elastic {
    /// The mode.
    pub mode: Mode,
    /// [`Shaper::none`] for the same tool, not shaped.
    pub shaper: Shaper,
}

impl ModeSettings {
    /// The mode and its shaper; `table` is what the machine file calls them.
    ///
    /// # Errors
    /// A mode that is none, or no shaper of this name.
    pub fn check(&self, table: &str) -> Result<Elastic> {
        let Self { hz, damping, .. } = *self;
        let mode = Mode { hz, damping };
        let shaper = commissioning::shaper(&self.shaper, mode)
            .map_err(|error| anyhow!("[{table}] {error:#}"))?;
        Ok(Elastic { mode, shaper })
    }
}

impl Elastic {
    /// The same tool, not shaped.
    #[must_use]
    pub const fn unshaped(self) -> Self {
        Self {
            shaper: Shaper::none(),
            ..self
        }
    }
}
