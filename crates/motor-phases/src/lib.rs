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
mod latches;
mod phases;
#[cfg(feature = "embedded-hal")]
mod winding_pins;

pub use accumulators::{Accumulation, AccumulatorError, Accumulators, SpeedLaw};
pub use latches::{BusError, BusWrite, LatchWrites, Latches};
pub use phases::{Phase, Phases, Placement, Stepping, Wiring, WiringError};
#[cfg(feature = "embedded-hal")]
#[cfg_attr(docsrs, doc(cfg(feature = "embedded-hal")))]
pub use winding_pins::WindingPins;

/// What stands in the signatures here and is `stepper-sync`'s own.
#[doc(no_inline)]
pub use stepper_sync::{Polarity, Rate, RateError};
