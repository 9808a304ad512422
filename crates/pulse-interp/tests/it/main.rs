//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod axes;
mod closed_loop;
mod common;
mod definition;
mod extremes;
mod feed;
mod pictures;
mod properties;
mod reference;
#[cfg(feature = "serde")]
mod serialised;
