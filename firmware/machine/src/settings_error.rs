//! Why settings are refused.

use pulse_interp::LoopError;
use pvt_steps::{KnotError, RateError, ScaleError};
use thiserror::Error;

/// Why settings are refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum SettingsError {
    /// Links or ranges of an arm.
    #[error(transparent)]
    Arm(#[from] scara_kin::GeometryError),
    /// Lengths, ranges or ball joints of a Delta.
    #[error(transparent)]
    Delta(#[from] delta_kin::GeometryError),
    /// A range whose ends are not two numbers, the smaller one first.
    #[error("{axis}: a range of {min} to {max}")]
    Range {
        /// The axis.
        axis: &'static str,
        /// The lower end given.
        min: f64,
        /// The upper end given.
        max: f64,
    },
    /// A range that does not have the home position in it.
    #[error("{axis}: home at {home} {unit} is out of its range")]
    Home {
        /// The axis.
        axis: &'static str,
        /// The position given, in degrees or mm.
        home: f64,
        /// Which of them.
        unit: &'static str,
    },
    /// A home at which the machine cannot be.
    #[error("at home the tool is nowhere, or the axes may not be there")]
    NoHome,
    /// An axis that would step faster than its driver takes steps, at the largest speed.
    #[error("{axis}: {steps_s:.0} steps a second at the largest speed, {max_s:.0} are possible")]
    TooFast {
        /// The axis.
        axis: &'static str,
        /// Steps a second.
        steps_s: f64,
        /// The most that driver and ticks allow.
        max_s: f64,
    },
    /// A closed loop on the scale of an axis.
    #[error("{axis}: {error}")]
    Loop {
        /// The axis.
        axis: &'static str,
        /// Why it is none.
        error: LoopError,
    },
    /// A tolerance that nothing can be within.
    #[error("a tolerance of {tolerance_mm} mm")]
    Tolerance {
        /// The tolerance given.
        tolerance_mm: f64,
    },
    /// Homing that steps not at all or faster than the driver takes steps.
    #[error("homing at {hz} steps a second")]
    Homing {
        /// Steps a second.
        hz: u32,
    },
    /// Steps of a turn or mm.
    #[error(transparent)]
    Scale(#[from] ScaleError),
    /// Ticks a second.
    #[error(transparent)]
    Rate(#[from] RateError),
    /// Home.
    #[error(transparent)]
    Knot(#[from] KnotError),
}
