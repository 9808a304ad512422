//! The drivers of `firmware/mcs51` on a simulated 8051, edge by edge against what the crates
//! predict.
//!
//! Headers come from pattern-codec, programs from `sdcc`, port traces from `s51` of uCsim. Without
//! these tools the tests say so on standard error and pass; with `POSE2PULSE_REQUIRE_MCS51=1` they
//! fail. `cargo test --test it mcs51:: -- --nocapture` prints the measured figures.
#![expect(
    clippy::cast_precision_loss,
    reason = "cycles of a run are far below 2^52"
)]

mod dance;
mod engrave;
mod reloads;
mod simulator;
