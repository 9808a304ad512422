//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod common;
mod duel;
#[cfg(feature = "tokio")]
mod held;
mod mistakes;
mod pair;
mod partners;
#[cfg(all(unix, feature = "serialport"))]
mod peer;
#[cfg(all(
    unix,
    feature = "embedded-io",
    feature = "embedded-io-async",
    feature = "serialport"
))]
mod ports;
mod readme;
mod rules;
#[cfg(feature = "serde")]
mod serde;
#[cfg(all(unix, feature = "tokio", feature = "serialport"))]
mod tokio;
mod vectors;
