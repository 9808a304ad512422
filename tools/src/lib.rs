//! What the program `line3964r` is made of, for other programs.
//!
//! [`capture`] reads captures of a line and tells the conversation and the verdict: no file, no
//! clock, no port. [`probe`] finds what a partner is set to. [`Address`] names a port, and opens it
//! with feature `ports`. Feature `cli`, on by default, is the program itself.

extern crate alloc;

pub mod capture;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "gateway")]
mod gateway;
mod port;
mod preset;
pub mod probe;
#[cfg(feature = "cli")]
mod runtime;
#[cfg(feature = "cli")]
mod settings;
pub mod text;

#[cfg(feature = "ports")]
pub use port::Port;
pub use port::{Address, AddressError, Frame, Parity, Target, Wire};
pub use preset::Preset;
