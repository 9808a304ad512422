//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod attack;
mod common;
mod hand_made;
mod machines;
mod numbers;
mod own;
mod paths;
