//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod accuracy;
mod calibration;
mod common;
mod dynamics;
mod each;
mod extremes;
mod follow;
mod geometry;
mod mistakes;
#[cfg(feature = "path-timing")]
mod paths;
mod properties;
mod reference;
#[cfg(feature = "serde")]
mod serialised;
mod turns;
mod units;
