//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod common;
mod dance;
mod extremes;
mod headers;
mod motions;
mod properties;
mod records;
#[cfg(feature = "serde")]
mod serde;
