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

mod accumulators;
mod cubic;
#[cfg(feature = "path-timing")]
mod drive;
mod edges;
#[cfg(feature = "embedded-hal")]
#[cfg_attr(docsrs, doc(cfg(feature = "embedded-hal")))]
pub mod embedded_hal;
mod fixed;
mod latches;
mod phases;
mod position;
mod ramp;
mod rate;
mod single_reload;
mod step_dir_timing;
mod timer;
mod trains;

pub use accumulators::{Accumulation, AccumulatorError, Accumulators, SpeedLaw};
pub use cubic::{
    AxisSegments, JoinedSegments, KnotError, MinIntervals, PvtKnot, PvtQuantiser, PvtRow, PvtSteps,
    RowBits, RowBytesError, RowCodec, RowError, Segment, SegmentError, SegmentPlayer, Step,
};
#[cfg(feature = "path-timing")]
pub use drive::{Drive, DriveError};
pub use edges::{Edge, Edges, Level};
pub use latches::{BusError, BusWrite, LatchWrites, Latches};
pub use phases::{Phase, Phases, Placement, Polarity, Stepping, Wiring, WiringError};
pub use position::{Position, PositionError, ScaleError, StepCarry, StepScale};
pub use ramp::{AxisRamp, Ramp, RampEnds, RampError, RampLimits, RampRows};
pub use rate::{Rate, RateError};
pub use single_reload::{Rounding, SingleReload};
pub use step_dir_timing::StepDirTiming;
pub use timer::{CounterWidth, ExactInterval, Periods, Reload, Reloads, Timer, TimerError};
pub use trains::{AxisTrain, Direction, TrainError, Trains};
