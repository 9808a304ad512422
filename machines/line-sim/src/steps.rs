//! The steps in which the wires are simulated.

use core::time::Duration;

/// 16 for a bit at 9600 bit/s.
pub(crate) const STEPS_PER_SECOND: u64 = 153_600;

/// Nanoseconds and the steps that take them: `10^9 / 153600`, reduced.
const NS_PER_STEP: (u64, u64) = (78_125, 12);

/// Time of a step since the begin, rounded down to a nanosecond.
pub(crate) const fn time(step: u64) -> Duration {
    Duration::from_nanos(step.saturating_mul(NS_PER_STEP.0) / NS_PER_STEP.1)
}

/// The first step at this time or later.
pub(crate) fn step_at(time: Duration) -> u64 {
    let (ns, steps) = NS_PER_STEP;
    let step = (time.as_nanos() * u128::from(steps)).div_ceil(ns.into());
    u64::try_from(step).unwrap_or(u64::MAX)
}
