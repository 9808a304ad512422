//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod accumulators;
#[cfg(feature = "embedded-hal")]
mod embedded_hal;
mod extremes;
mod phases;
#[cfg(feature = "serde")]
mod serde;
