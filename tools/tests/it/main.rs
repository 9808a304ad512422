//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

extern crate alloc;

#[cfg(all(unix, feature = "gateway"))]
mod gateway;
#[cfg(all(unix, feature = "cli"))]
mod line3964r;
#[cfg(all(unix, feature = "ports"))]
mod ports;
