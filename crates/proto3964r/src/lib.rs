#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "serialport", feature = "tokio"))]
extern crate alloc;
#[cfg(any(test, feature = "std"))]
extern crate std;

pub mod ascii;
#[cfg(feature = "std")]
#[cfg_attr(docsrs, doc(cfg(feature = "std")))]
pub mod blocking;
#[cfg(any(
    feature = "embedded-io",
    feature = "embedded-io-async",
    feature = "std"
))]
mod character_buffer;
mod config;
#[cfg(feature = "embedded-io")]
#[cfg_attr(docsrs, doc(cfg(feature = "embedded-io")))]
pub mod embedded_io;
#[cfg(feature = "embedded-io-async")]
#[cfg_attr(docsrs, doc(cfg(feature = "embedded-io-async")))]
pub mod embedded_io_async;
mod event;
pub mod frame;
#[cfg(feature = "serialport")]
#[cfg_attr(docsrs, doc(cfg(feature = "serialport")))]
pub mod serialport;
mod station;
#[cfg(feature = "tokio")]
#[cfg_attr(docsrs, doc(cfg(feature = "tokio")))]
pub mod tokio;

pub use config::{Config, Conflict, IdleNoise, Line, Priority, SilenceInBlock};
pub use event::{Abandoned, Cause, CharacterError, Event, Failure, Hex, JobPhase, Rejection};
pub use frame::{Check, IllegalDle};
pub use station::{Activity, Station, SubmitError, Transmit};
