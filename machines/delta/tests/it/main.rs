//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod calibration;
mod load;
