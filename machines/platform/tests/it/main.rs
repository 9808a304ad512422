//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod desk;
mod panel;
mod screen;
mod via;
