//! The machine: a platform file with its numbers checked.

use anyhow::{Result, bail};
use machine_sim::input::parse_settings;
use nalgebra::Isometry3;
use pose_pt::{Locator, Platform};

use crate::panel::PanelSettings;
use crate::pose::{CONVENTION, Pose, vector};
use crate::settings::Settings;

/// An alignment platform with its panel.
#[derive(Debug)]
pub struct Machine {
    pub(crate) settings: Settings,
    pub(crate) locators: Locators,
    pub(crate) panel: PanelSettings,
}

/// The platform, by the number of its locators.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "a machine has one")]
pub(crate) enum Locators {
    Three(Platform<3>),
    Four(Platform<4>),
    Five(Platform<5>),
    Six(Platform<6>),
}

impl Machine {
    /// Reads a machine, as in [`PLATFORM`](crate::PLATFORM).
    ///
    /// # Errors
    /// A mistake with its line and column, a number that no machine has, or a jog speed above the
    /// rated speed of an axis.
    pub fn parse(text: &str) -> Result<Self> {
        let settings: Settings = parse_settings(text)?;
        let locators = Locators::new(&settings.locators())?;
        let panel = settings.panel()?;
        Ok(Self {
            settings,
            locators,
            panel,
        })
    }

    /// Where the body is, and where it goes, as the platform file has it.
    #[must_use]
    pub fn poses(&self) -> [Pose; 2] {
        self.settings.poses()
    }
}

impl Locators {
    fn new(locators: &[Locator]) -> Result<Self> {
        Ok(match *locators {
            [a, b, c] => Self::Three(Platform::new([a, b, c])?),
            [a, b, c, d] => Self::Four(Platform::new([a, b, c, d])?),
            [a, b, c, d, e] => Self::Five(Platform::new([a, b, c, d, e])?),
            [a, b, c, d, e, f] => Self::Six(Platform::new([a, b, c, d, e, f])?),
            _ => bail!("{} locators: this machine takes 3 to 6", locators.len()),
        })
    }
}

pub(crate) fn isometry(pose: Pose) -> Isometry3<f64> {
    vector(pose).to_isometry(CONVENTION)
}
