//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod driver;
mod over_3964r;
mod properties;
mod readme;
#[cfg(feature = "serde")]
mod serde;
mod telegrams;
#[cfg(feature = "tokio")]
mod tokio;
