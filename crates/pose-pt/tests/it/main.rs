//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod accuracy;
mod conventions;
mod extremes;
mod mistakes;
mod platform;
mod properties;
mod pt;
mod pvt;
mod pvt_distance_error;
mod pvt_limits;
mod random_plans;
mod reference;
mod run;
#[cfg(feature = "serde")]
mod serialised;
mod support;
mod units;
