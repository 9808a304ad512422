//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod accuracy;
mod conventions;
mod extremes;
mod mistakes;
mod platform;
mod properties;
mod pt;
#[cfg(feature = "path-timing")]
mod pvt;
#[cfg(feature = "path-timing")]
mod pvt_distance_error;
#[cfg(feature = "path-timing")]
mod pvt_limits;
#[cfg(feature = "path-timing")]
mod random_plans;
mod reference;
#[cfg(feature = "path-timing")]
mod run;
#[cfg(feature = "serde")]
mod serialised;
mod support;
#[cfg(feature = "path-timing")]
mod units;
