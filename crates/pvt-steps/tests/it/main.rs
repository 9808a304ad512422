//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

extern crate alloc;

mod common;
mod cubic;
mod cubic_exact;
#[cfg(feature = "path-timing")]
mod drive;
mod driver_limits;
mod quantiser;
mod ramp;
mod ramp_errors;
mod ramp_properties;
mod rows_as_bytes;
mod segments;
#[cfg(feature = "serde")]
mod serde;
