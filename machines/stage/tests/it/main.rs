//! The public API, from outside.
#![expect(clippy::unwrap_used, reason = "tests fail by panics")]

mod load;
