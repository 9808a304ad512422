//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

extern crate alloc;

#[cfg(feature = "blocking")]
mod blocking;
mod client;
mod endpoint;
mod frames;
mod line;
mod over_3964r;
mod properties;
mod readme;
mod server;
mod telegrams;
#[cfg(feature = "tokio")]
mod tokio;
