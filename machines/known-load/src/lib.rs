//! What a machine carries, what its motors have for it, and how its tool swings.
//!
//! Goal: motions within the torque of the motors, and shaped for a mode of the tool, said and shown
//! the same way by every machine. [`MotorSettings`] and [`ModeSettings`] are parts of a machine
//! file, [`Load`] and [`Elastic`] what is checked of them; [`within_share`] plans, [`shape`]
//! shapes; [`PoseLoad`] and [`Tool`] are what the simulation has; [`TorqueUsed`] and [`Vibration`]
//! are what comes of it, for [`TorqueReport`], [`VibrationReport`] and charts.
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod chart;
mod load;
mod mode;
mod motor;
mod report;
mod room;
mod shaping;
mod torque;
mod vibration;

pub use self::chart::{torque_chart, vibration_chart};
pub use self::load::{Load, PoseLoad};
pub use self::mode::{Elastic, ModeSettings};
pub use self::motor::{AxisMotor, MotorSettings, Transmission};
pub use self::report::{TorqueReport, VibrationReport};
pub use self::room::with_room;
pub use self::shaping::{ShapedRows, off, shape};
pub use self::torque::{TorqueUsed, spans, within_share};
pub use self::vibration::{Tool, Vibration};
