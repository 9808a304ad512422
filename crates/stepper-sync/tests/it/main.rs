//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod common;
#[cfg(feature = "embedded-hal")]
mod embedded_hal;
mod extremes;
mod pictures;
mod position;
mod properties;
#[cfg(feature = "serde")]
mod serde;
mod timers;
mod trains;
