//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod common;
mod exhaustive;
mod kernels;
mod known_length;
