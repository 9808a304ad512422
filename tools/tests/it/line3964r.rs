//! `line3964r` from outside, as its users run it.

mod exchange;
#[cfg(feature = "gateway")]
mod gateway;
mod monitor;
mod probe;
mod program;
mod simulate;
mod station;
mod wireshark;
