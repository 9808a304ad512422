#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]
// Ticks and steps are integers: each sum that could overflow, each division that could meet a
// zero, says why it does not.
#![warn(
    clippy::arithmetic_side_effects,
    clippy::integer_division_remainder_used
)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod axis_train;
mod edges;
mod polarity;
mod position;
mod rate;
mod single_reload;
#[cfg(feature = "embedded-hal")]
mod step_dir;
mod step_dir_timing;
mod timer;
mod trains;

pub use axis_train::AxisTrain;
pub use edges::{Edge, Edges, Level};
pub use polarity::Polarity;
pub use position::{Position, PositionError, ScaleError, StepCarry, StepScale};
pub use rate::{Rate, RateError};
pub use single_reload::{Rounding, SingleReload};
#[cfg(feature = "embedded-hal")]
#[cfg_attr(docsrs, doc(cfg(feature = "embedded-hal")))]
pub use step_dir::{StepDir, StepDirError};
pub use step_dir_timing::{MinIntervals, StepDirTiming};
pub use timer::{CounterWidth, ExactInterval, Periods, Reload, Reloads, Timer, TimerError};
pub use trains::{Direction, TrainError, Trains};
