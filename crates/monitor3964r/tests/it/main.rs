//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod captures;
mod readme;
#[cfg(feature = "serde")]
mod serde;
mod verdicts;
