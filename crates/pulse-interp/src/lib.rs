#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]
// Steps are integers: each sum that could overflow, each division that could meet a zero, says why
// it does not.
#![warn(
    clippy::arithmetic_side_effects,
    clippy::integer_division_remainder_used
)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod arc;
mod axes;
mod closed_loop;
mod feed;
mod homing;
mod line;
mod moves;
mod switches;

pub use arc::{Arc, ArcError, ArcMoves, ArcSteps};
pub use axes::{AxesError, AxesLine, AxesSteps, AxisStep, Dda, DdaTicks};
pub use closed_loop::{AxisLoop, LoopError, LoopSettings, LostSteps, ScaleRatio};
pub use feed::{Factor, StepIntervals};
pub use homing::{Homing, HomingError, HomingOrder, HomingSettings, HomingSpeed};
pub use line::{Line, LineError, LineMoves, LineSteps};
pub use moves::{Direction, Move, Rule, Turn};
pub use switches::{SwitchError, Switches, TravelEnd};
