//! The highest velocity that leaves a driver its time, and rows above it.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_wrap,
    reason = "velocities of at most half a step a tick, bits below 64"
)]

use crate::fixed::{Inverse, quotient};
use crate::row::PvtKnot;

/// Where a row is too fast.
pub(crate) struct TooFast {
    pub(crate) tick: u32,
    /// Ticks of a step there, rounded down.
    pub(crate) interval_ticks: u64,
}

impl TooFast {
    pub(crate) fn at_knot(tick: u32, knot: PvtKnot) -> Self {
        Self::new(tick, knot.velocity, 1, PvtKnot::VELOCITY_BITS)
    }

    /// At `velocity` in 2^-bits steps per `ticks` ticks.
    pub(crate) fn new(tick: u32, velocity: i64, ticks: u32, bits: u32) -> Self {
        let inverse = Inverse::of(velocity.unsigned_abs());
        let interval_ticks = inverse.map_or(0, |inverse| {
            inverse.quotient(u64::from(ticks) << 31, bits as i32 - 31)
        });
        Self {
            tick,
            interval_ticks,
        }
    }
}

/// The greatest velocity: one step in `step_ticks` + 2 ticks, in 2^-56 steps a tick.
///
/// Two steps that far apart, each off by less than 0.9995 ticks, are `step_ticks` apart.
pub(crate) const fn max_velocity(step_ticks: u64) -> i64 {
    // At most a half.
    let velocity = quotient(1 << PvtKnot::VELOCITY_BITS, step_ticks.saturating_add(2));
    // Rounded up where that costs less than 2^-11 ticks a step: exactly that velocity is allowed.
    let more = step_ticks < 1 << 22;
    velocity as i64 + more as i64
}
