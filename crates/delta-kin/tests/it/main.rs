//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod accuracy;
mod calibration;
mod common;
mod dynamics;
mod extremes;
mod follow;
mod machine;
mod mistakes;
mod modes;
#[cfg(feature = "path-timing")]
mod paths;
mod properties;
mod reference;
#[cfg(feature = "serde")]
mod serialised;
mod units;
mod workspace;
