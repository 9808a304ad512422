//! The shape of a ramp in whole ticks, once per move.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_wrap,
    reason = "rates below 2^32, denominators at most 2^20; phases sum up to the end"
)]

use super::real::Real;
use super::{RampEnds, RampError, RampLimits};
use crate::fixed::quotient;
use crate::{PvtKnot, Rate};
use stepper_sync::Timer;

/// Ticks from rest to the highest rate, log2 of the limit: a row has 32 bits.
const RAMP_BITS: u32 = 31;
/// Ticks of the whole move, log2 of the limit.
const END_BITS: u32 = 61;

/// The leading axis of a move, in steps and ticks: up to a velocity, on with it, and down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    /// Steps.
    pub(super) max_pulses: u32,
    pub(super) up_ticks: u64,
    pub(super) cruise_ticks: u64,
    pub(super) down_ticks: u64,
    /// In 2^-56 steps a tick.
    pub(super) entry: i64,
    pub(super) peak: i64,
    pub(super) exit: i64,
    /// Ticks of a pulse: half of the shortest period, less what steps may be off their places.
    pub(super) pulse_ticks: u64,
}

impl Plan {
    /// With the formulas of [`Ramp`](super::Ramp). The phases are rounded to whole ticks, and the
    /// velocity between them follows from the distance.
    pub(super) fn new(
        max_pulses: u32,
        limits: &RampLimits,
        ends: RampEnds,
        tick_rate: Rate,
    ) -> Result<Self, RampError> {
        check(limits, ends, tick_rate)?;
        let needed = needed_steps(limits, ends);
        if u64::from(max_pulses) < needed && max_pulses > 0 {
            return Err(RampError::TooShort {
                steps: max_pulses,
                ends,
                needed,
            });
        }
        let rate = |millihertz| Real::whole(millihertz).over(Real::whole(1000));
        let ticks = Real::whole(tick_rate.numerator()).over(Real::whole(tick_rate.denominator()));
        let distance = Real::whole(max_pulses);
        let acceleration = Real::whole(limits.accel_steps_per_s2);
        let [v0, v1] = [ends.entry_millihertz, ends.exit_millihertz].map(rate);
        let highest = rate(limits.max_millihertz);

        let ground = v0.squared().plus(v1.squared()).half();
        let square = acceleration.times(distance).plus(ground);
        let triangular = square < highest.squared();
        let peak = if triangular { square.root() } else { highest };
        let (rise, fall) = (peak.minus(v0), peak.minus(v1));
        // Beside a constant speed a change takes a tick at least: without a row of its own it would
        // be spread over that.
        let least = |change: Real| match change {
            Real::ZERO => Real::ZERO,
            _ if triangular => Real::ZERO,
            _ => Real::whole(1),
        };
        let phase = |change: Real| ticks.times(change.over(acceleration)).max(least(change));
        let (up, down) = (phase(rise), phase(fall));
        let end = if max_pulses == 0 {
            Real::ZERO
        } else if triangular {
            up.plus(down)
        } else {
            let lost = rise.times(up).plus(fall.times(down)).half();
            ticks.times(distance).plus(lost).over(peak)
        };
        let end = end
            .rounded()
            .filter(|end| end >> END_BITS == 0)
            .ok_or(RampError::TooLong {
                steps: max_pulses,
                bits: END_BITS,
            })?;

        let within = |phase: Real, left: u64| phase.rounded().map_or(left, |phase| phase.min(left));
        let up = within(up, end);
        let down = if triangular {
            end - up
        } else {
            within(down, end - up)
        };
        // Steps a tick: the distances of the three phases sum up to the whole one.
        let [v0, v1] = [v0, v1].map(|v| v.over(ticks));
        let [up_ticks, down_ticks] = [up, down].map(|phase| Real::scaled(phase, 0));
        let at_ends = v0.times(up_ticks).plus(v1.times(down_ticks));
        let peak = distance.plus(distance).minus(at_ends);
        let peak = peak.over(Real::scaled(2 * end - up - down, 0));
        let half_period = Real::whole(1).over(v0.max(v1).max(peak)).half();
        let half_period = half_period.floor(0).unwrap_or(u64::MAX);
        let velocity = |real: Real| {
            let velocity = real.floor(PvtKnot::VELOCITY_BITS as i32);
            velocity.and_then(|v| i64::try_from(v).ok()).unwrap_or(0)
        };
        Ok(Self {
            max_pulses,
            up_ticks: up,
            cruise_ticks: end - up - down,
            down_ticks: down,
            entry: velocity(v0),
            peak: velocity(peak),
            exit: velocity(v1),
            pulse_ticks: (half_period - (half_period >> 6)).saturating_sub(1).max(1),
        })
    }

    /// Ticks of the whole move.
    pub(super) const fn end_ticks(&self) -> u64 {
        self.up_ticks + self.cruise_ticks + self.down_ticks
    }
}

/// n / d, rounded up.
const fn quotient_up(n: u64, d: u64) -> u64 {
    let whole = quotient(n, d);
    if whole * d < n { whole + 1 } else { whole }
}

/// Steps that the change of the rate takes, |v1² - v0²| / 2a, rounded up.
fn needed_steps(limits: &RampLimits, ends: RampEnds) -> u64 {
    let [v0, v1] =
        [ends.entry_millihertz, ends.exit_millihertz].map(|v| u64::from(v) * u64::from(v));
    quotient_up(
        v0.abs_diff(v1),
        2_000_000 * u64::from(limits.accel_steps_per_s2),
    )
}

fn check(limits: &RampLimits, ends: RampEnds, tick_rate: Rate) -> Result<(), RampError> {
    let &RampLimits {
        start_millihertz,
        max_millihertz,
        accel_steps_per_s2,
    } = limits;
    let limit = Timer::MAX_CLOCKS_PER_TICK;
    if tick_rate.denominator() > limit {
        return Err(RampError::TickRate {
            rate: tick_rate,
            limit,
        });
    }
    if max_millihertz == 0 {
        return Err(RampError::ZeroMaxRate);
    }
    if accel_steps_per_s2 == 0 {
        return Err(RampError::ZeroAcceleration);
    }
    if start_millihertz > max_millihertz {
        return Err(RampError::StartAboveMax {
            start_millihertz,
            max_millihertz,
        });
    }
    for end_millihertz in [ends.entry_millihertz, ends.exit_millihertz] {
        if end_millihertz > max_millihertz {
            return Err(RampError::EndAboveMax {
                end_millihertz,
                max_millihertz,
            });
        }
    }
    let ticks = u64::from(tick_rate.numerator());
    let seconds = u64::from(tick_rate.denominator());
    if u64::from(max_millihertz) * seconds > ticks * 250 {
        return Err(RampError::RateTooHigh {
            max_millihertz,
            limit_millihertz: quotient(ticks * 250, seconds),
        });
    }
    // F v / 2^31.
    let limit = quotient_up(
        ticks * u64::from(max_millihertz),
        (seconds * 1000) << RAMP_BITS,
    );
    if u64::from(accel_steps_per_s2) < limit {
        return Err(RampError::AccelerationTooLow {
            accel_steps_per_s2,
            limit_steps_per_s2: limit,
            max_millihertz,
        });
    }
    Ok(())
}
