//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod certified;
mod mistakes;
mod model;
mod rank;
