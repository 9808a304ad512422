//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

extern crate alloc;

mod accumulators;
mod common;
mod cubic;
mod cubic_exact;
#[cfg(feature = "path-timing")]
mod drive;
mod driver_limits;
#[cfg(feature = "embedded-hal")]
mod embedded_hal;
mod extremes;
mod phases;
mod pictures;
mod position;
mod properties;
mod quantiser;
mod ramp;
mod ramp_errors;
mod ramp_properties;
mod rows_as_bytes;
mod segments;
#[cfg(feature = "serde")]
mod serde;
mod timers;
mod trains;
