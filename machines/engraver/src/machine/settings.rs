//! The machine file, as written: TOML, lengths in mm, angles in degrees, rates in pulses per
//! second.

use known_load::{ModeSettings, MotorSettings};
use pattern_codec::engraving::{AxisCodes, ByteOrder};
use serde::{Deserialize, Serialize};

use crate::load::LoadSettings;
use crate::placement::Bed;

/// The machine file.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    pub(super) arm: ArmSettings,
    pub(super) shoulder: JointSettings,
    pub(super) elbow: JointSettings,
    pub(super) disc: DiscSettings,
    pub(super) vertical: VerticalSettings,
    pub(super) timer: TimerSettings,
    pub(super) rapid: RapidSettings,
    #[serde(default)]
    pub(super) pattern: PatternSettings,
    pub(super) bed: Bed,
    #[serde(default)]
    pub(super) timed: TimedSettings,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) load: Option<LoadSettings>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) torque: Option<MotorSettings>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mode: Option<ModeSettings>,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArmSettings {
    pub(super) upper_mm: f64,
    pub(super) fore_mm: f64,
    #[serde(default)]
    pub(super) keep_out_mm: f64,
    /// Where the arm's axis is.
    #[serde(default)]
    pub(super) base_x_mm: f64,
    #[serde(default)]
    pub(super) base_y_mm: f64,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointSettings {
    pub(super) step_deg: f64,
    pub(super) gear_ratio: f64,
    pub(super) home_deg: f64,
    pub(super) min_deg: f64,
    pub(super) max_deg: f64,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DiscSettings {
    pub(super) step_deg: f64,
    pub(super) gear_ratio: f64,
    pub(super) home_deg: f64,
    pub(super) corner_deg: f64,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VerticalSettings {
    pub(super) mm_per_pulse: f64,
    pub(super) lift_mm: f64,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TimerSettings {
    pub(super) crystal_hz: u32,
    pub(super) process_hz: f64,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RapidSettings {
    pub(super) start_hz: f64,
    pub(super) max_hz: f64,
    pub(super) accel_hz_per_s: f64,
}

#[derive(Debug, Clone, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct PatternSettings {
    pub(super) axis_codes: AxisCodes,
    pub(super) byte_order: ByteOrder,
}

/// Strokes by `--controller timed`; joints and disc keep the limits of the rapid moves.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct TimedSettings {
    pub(super) feed_mm_s: f64,
    pub(super) accel_mm_s2: f64,
    /// Of joints and disc, in place of that of the rapid moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) joint_accel_hz_per_s: Option<f64>,
}

impl Default for TimedSettings {
    /// The feed of the source's machine, and some 0.1 g.
    fn default() -> Self {
        Self {
            feed_mm_s: 15.0,
            accel_mm_s2: 1000.0,
            joint_accel_hz_per_s: None,
        }
    }
}

impl Settings {
    pub(super) const fn corner_rad(&self) -> f64 {
        self.disc.corner_deg.to_radians()
    }

    pub(crate) const fn mm_per_vertical_pulse(&self) -> f64 {
        self.vertical.mm_per_pulse
    }
}
