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

mod axis;
#[cfg(feature = "path-timing")]
mod drive;
mod fixed;
mod joined;
mod leb128;
mod polynomial;
mod quantiser;
mod ramp;
mod row;
mod row_error;
mod row_wire;
mod run;
mod segment;
mod series;
mod steps;
mod too_fast;
mod wire;

pub use axis::AxisSegments;
#[cfg(feature = "path-timing")]
#[cfg_attr(docsrs, doc(cfg(feature = "path-timing")))]
pub use drive::{Drive, DriveError};
pub use joined::JoinedSegments;
pub use quantiser::{KnotError, PvtQuantiser};
pub use ramp::{AxisRamp, Ramp, RampEnds, RampError, RampLimits, RampRows};
pub use row::{PvtKnot, PvtRow};
pub use row_error::RowError;
pub use row_wire::{RowBits, RowBytesError, RowCodec};
pub use segment::{Segment, SegmentPlayer};
pub use steps::{PvtSteps, Step};
pub use wire::SegmentError;

/// What stands in the signatures here and is `stepper-sync`'s own.
#[doc(no_inline)]
pub use stepper_sync::{
    Direction, Edge, Edges, Level, MinIntervals, Rate, RateError, ScaleError, StepDirTiming,
    StepScale,
};
