//! The machine: from its settings in TOML to checked numbers.

use anyhow::{Result, bail, ensure};
use known_load::{Elastic, ModeSettings, MotorSettings};
use machine_sim::input::parse_settings;
use path_timing::{AxisLimits, Shaper};
use serde::Deserialize;

use crate::load::{Load, LoadSettings};

/// The settings, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    axis: AxisSettings,
    load: Option<LoadSettings>,
    torque: Option<MotorSettings>,
    mode_x: Option<ModeSettings>,
    mode_y: Option<ModeSettings>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AxisSettings {
    max_speed_mm_s: f64,
    max_acceleration_mm_s2: f64,
    start_stop_mm_s: f64,
}

/// The checked machine.
#[derive(Debug, Clone, Copy)]
pub struct Machine {
    pub(crate) max_speed_mm_s: f64,
    pub(crate) max_acceleration_mm_s2: f64,
    /// By what an axis may change its speed at once.
    pub(crate) start_stop_mm_s: f64,
    /// What the axes carry, where that is known.
    pub(crate) load: Option<Load>,
    /// In which the tables of X and Y swing, where these are known.
    pub(crate) modes: Option<[Elastic; 2]>,
}

impl Machine {
    /// Reads a machine, as in [`MACHINE`](crate::MACHINE).
    ///
    /// # Errors
    /// A mistake with its line and column, or a number that no machine has.
    pub fn parse(text: &str) -> Result<Self> {
        let Settings {
            axis,
            load,
            torque,
            mode_x,
            mode_y,
        } = parse_settings(text)?;
        for (name, value) in [
            ("max_speed_mm_s", axis.max_speed_mm_s),
            ("max_acceleration_mm_s2", axis.max_acceleration_mm_s2),
            ("start_stop_mm_s", axis.start_stop_mm_s),
        ] {
            ensure!(
                value.is_finite() && value > 0.0,
                "[axis] {name} = {value} is not above zero"
            );
        }
        let load = match (load, torque) {
            (Some(load), Some(torque)) => Some(load.check(&torque, axis.max_speed_mm_s)?),
            (None, None) => None,
            (Some(_), None) => bail!("[load] without [torque]: neither or both are needed"),
            (None, Some(_)) => bail!("[torque] without [load]: neither or both are needed"),
        };
        let modes = match (mode_x, mode_y) {
            (Some(x), Some(y)) => Some([x.check("mode_x")?, y.check("mode_y")?]),
            (None, None) => None,
            (Some(_), None) => bail!("[mode_x] without [mode_y]: neither or both are needed"),
            (None, Some(_)) => bail!("[mode_y] without [mode_x]: neither or both are needed"),
        };
        Ok(Self {
            max_speed_mm_s: axis.max_speed_mm_s,
            max_acceleration_mm_s2: axis.max_acceleration_mm_s2,
            start_stop_mm_s: axis.start_stop_mm_s,
            load,
            modes,
        })
    }

    /// Of each axis, in mm and s.
    pub(crate) const fn axis_limits(&self) -> [AxisLimits; 2] {
        [AxisLimits {
            speed: self.max_speed_mm_s,
            acceleration: self.max_acceleration_mm_s2,
            jerk: None,
        }; 2]
    }

    /// Those of both axes, where one of them shapes.
    pub(crate) fn shapers(&self) -> Option<[Shaper; 2]> {
        let shapers = self.modes?.map(|mode| mode.shaper);
        let shapes = |shaper: &Shaper| shaper.duration_s() > 0.0;
        shapers.iter().any(shapes).then_some(shapers)
    }

    /// Whether it is planned as a whole: load or modes are known.
    pub(crate) const fn is_known(&self) -> bool {
        self.load.is_some() || self.modes.is_some()
    }

    /// The same machine and tables, not shaped; none where no modes are known.
    pub(crate) fn unshaped(&self) -> Option<Self> {
        Some(Self {
            modes: Some(self.modes?.map(Elastic::unshaped)),
            ..*self
        })
    }
}
