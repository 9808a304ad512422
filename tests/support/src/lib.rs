//! What the tests of several crates share.
#![expect(
    clippy::indexing_slicing,
    clippy::missing_panics_doc,
    clippy::panic,
    clippy::unwrap_used,
    reason = "tests fail by panics"
)]

extern crate alloc;

mod board;
mod config;
pub mod instructions;
pub mod loaded;
mod pulses;
mod random;
mod sizes;
mod stored;

pub use board::{Board, Pin};
/// The programs of a README whose crate cannot depend on what they need.
#[cfg(doctest)]
#[doc = include_str!("../../../crates/path-timing/README.md")]
mod path_timing_readme {}

pub use config::at_least;
pub use pulses::Pulses;
pub use random::{Random, setting};
pub use sizes::{any_i32, any_u16, any_u32, any_u64};
pub use stored::{not_read, stored};
