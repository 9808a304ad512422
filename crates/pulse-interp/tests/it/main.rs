//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod axes;
mod closed_loop;
mod common;
mod definition;
mod feed;
mod length;
mod pictures;
mod properties;
mod reference;
mod refusals;
#[cfg(feature = "serde")]
mod serialised;
