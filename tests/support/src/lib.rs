//! What the tests of several crates share.
#![expect(
    clippy::missing_panics_doc,
    clippy::unwrap_used,
    reason = "tests fail by panics"
)]

pub mod instructions;
mod random;
mod sizes;

pub use random::{Random, setting};
pub use sizes::{any_i32, any_u16, any_u32, any_u64};
