//! The shape of a ramp in subdivided ticks, once per move.
//!
//! Ranges: F = fn/fd with fn < 2^32 and fd <= 2^20; rates V, V0 in mHz and a below 2^32; n < 2^31;
//! 2^shift subticks a tick, shift <= 16. Every product below stays in 128 bits with these.

use super::axis::{AxisRamp, Cruise, Slope};
use super::fixed::{FRACTION, nearest, ratio, whole};
use super::{RampError, RampLimits};
use crate::{Rate, Timer};

/// Most subticks per tick, log2: an edge is then within 0.51 ticks of its ideal.
const MAX_SHIFT: u32 = 16;
/// Subticks from rest to the highest rate, log2 of the limit: squares stay below 2^62.
const RAMP_BITS: u32 = 31;
/// Subticks of the whole move, log2 of the limit.
const END_BITS: u32 = 61;

/// What all axes of a move have in common.
pub(super) struct Plan {
    most: u32,
    shift: u32,
    limits: RampLimits,
    tick_rate: Rate,
    triangular: bool,
    /// F v0 / a, in whole subticks.
    start: u64,
    /// Time lost by one ramp, F (v - v0)² / (2 v a), in subticks, fixed point.
    lag: u128,
    /// The whole move, in subticks, fixed point.
    end: u128,
}

impl Plan {
    pub(super) fn new(most: u32, limits: &RampLimits, tick_rate: Rate) -> Result<Self, RampError> {
        check(limits, tick_rate)?;
        (0..=MAX_SHIFT)
            .rev()
            .find_map(|shift| Self::with_shift(most, limits, tick_rate, shift))
            .ok_or(RampError::TooLong {
                steps: most,
                bits: END_BITS,
            })
    }

    /// `None` when the times do not fit their ranges at this subdivision.
    #[expect(
        clippy::arithmetic_side_effects,
        reason = "ranges in the head of the file"
    )]
    fn with_shift(most: u32, limits: &RampLimits, tick_rate: Rate, shift: u32) -> Option<Self> {
        let (f_num, f_den) = parts(tick_rate);
        let f_sub = f_num << shift;
        let v0 = u128::from(limits.start_millihertz);
        let v = u128::from(limits.max_millihertz);
        let a = u128::from(limits.accel_steps_per_s2);
        let n = u128::from(most);

        // F v / a.
        if f_sub * v > (f_den * 1000 * a) << RAMP_BITS {
            return None;
        }
        let start = ratio(f_sub * v0, f_den * 1000 * a)?;
        let mut plan = Self {
            most,
            shift,
            limits: *limits,
            tick_rate,
            triangular: v * v - v0 * v0 >= n * 1_000_000 * a,
            start: nearest(start),
            lag: ratio(f_sub * (v - v0) * (v - v0), 2000 * v * a * f_den)?,
            end: 0,
        };
        plan.end = if most == 0 {
            0
        } else if plan.triangular {
            // The peak rate is at most v, so c² + g n <= (F v / a + 1)² < 2^63. The root of 64
            // fraction bits has 32, and so has the c that is squared.
            let half = FRACTION >> 1;
            let square = (start >> half) * (start >> half) + plan.growth(most)? * n;
            ((square.isqrt() - (start >> half)) * 2) << half
        } else {
            let cruising = plan.period(most)?.checked_mul(2 * n)?;
            cruising.checked_add(plan.lag * 2)?
        };
        (plan.end >> (FRACTION + END_BITS) == 0).then_some(plan)
    }

    /// The tick of the last edge of every moving axis.
    pub(super) const fn end_ticks(&self) -> u64 {
        AxisRamp::to_ticks(self.end_subticks(), self.shift)
    }

    /// The end such that it is rounded once on its way to ticks: here where subticks are ticks, else
    /// from subticks to ticks, where the fraction of a subtick does not count.
    const fn end_subticks(&self) -> u64 {
        if self.shift == 0 {
            nearest(self.end)
        } else {
            whole(self.end)
        }
    }

    /// The edges of an axis with `pulses` pulses, at most those of the leading axis.
    pub(super) fn axis(&self, pulses: u32) -> AxisRamp {
        self.moving_axis(pulses).unwrap_or_else(AxisRamp::at_rest)
    }

    /// `None` for no pulses.
    #[expect(
        clippy::arithmetic_side_effects,
        reason = "accel < pulses < 2^31; ranges in the head of the file"
    )]
    fn moving_axis(&self, pulses: u32) -> Option<AxisRamp> {
        let last = pulses.checked_sub(1)?;
        let accel = if self.triangular {
            last
        } else {
            self.accel_edges(pulses).min(last)
        };
        let growth = if accel > 0 { self.growth(pulses)? } else { 0 };
        let period = self.period(pulses)?;
        let first = if self.triangular {
            self.end >> 1
        } else {
            self.lag + period * u128::from(accel + 1)
        };
        let slope = Slope {
            start: self.start,
            growth,
            edges: accel,
        };
        let cruise = Cruise {
            next: first,
            period,
            edges_left: pulses * 2 - accel * 2 - 1,
        };
        Some(AxisRamp::new(
            self.end_subticks(),
            self.shift,
            &slope,
            cruise,
        ))
    }

    /// Edges made while speeding up: floor(2 `s_a` m / n).
    #[expect(
        clippy::arithmetic_side_effects,
        reason = "ranges in the head of the file"
    )]
    fn accel_edges(&self, pulses: u32) -> u32 {
        let v0 = u128::from(self.limits.start_millihertz);
        let v = u128::from(self.limits.max_millihertz);
        let a = u128::from(self.limits.accel_steps_per_s2);
        ((v * v - v0 * v0) * u128::from(pulses))
            .checked_div(1_000_000 * a * u128::from(self.most))
            .and_then(|edges| u32::try_from(edges).ok())
            .unwrap_or(0)
    }

    /// Growth of (t + F v0/a)² per edge: F² n / (a m) in square subticks, fixed point.
    #[expect(
        clippy::arithmetic_side_effects,
        reason = "ranges in the head of the file"
    )]
    fn growth(&self, pulses: u32) -> Option<u128> {
        let (f_num, f_den) = parts(self.tick_rate);
        let a = u128::from(self.limits.accel_steps_per_s2);
        ratio(
            (f_num * f_num * u128::from(self.most)) << (2 * self.shift),
            f_den * f_den * a * u128::from(pulses),
        )
    }

    /// Interval at the highest rate: F n / (2 v m) in subticks, fixed point.
    #[expect(
        clippy::arithmetic_side_effects,
        reason = "ranges in the head of the file"
    )]
    fn period(&self, pulses: u32) -> Option<u128> {
        let (f_num, f_den) = parts(self.tick_rate);
        let v = u128::from(self.limits.max_millihertz);
        ratio(
            (f_num * 500 * u128::from(self.most)) << self.shift,
            f_den * v * u128::from(pulses),
        )
    }
}

fn parts(rate: Rate) -> (u128, u128) {
    (u128::from(rate.numerator()), u128::from(rate.denominator()))
}

#[expect(
    clippy::arithmetic_side_effects,
    reason = "ranges in the head of the file"
)]
fn check(limits: &RampLimits, tick_rate: Rate) -> Result<(), RampError> {
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
    let (f_num, f_den) = parts(tick_rate);
    let v = u128::from(max_millihertz);
    if v * f_den > f_num * 250 {
        return Err(RampError::RateTooHigh {
            max_millihertz,
            limit_millihertz: (f_num * 250)
                .checked_div(f_den)
                .and_then(|limit| u64::try_from(limit).ok())
                .unwrap_or(u64::MAX),
        });
    }
    // F v / 2^31.
    let least = (f_num * v).div_ceil((f_den * 1000) << RAMP_BITS);
    match u64::try_from(least) {
        Ok(limit) if u64::from(accel_steps_per_s2) < limit => Err(RampError::AccelerationTooLow {
            accel_steps_per_s2,
            limit_steps_per_s2: limit,
            max_millihertz,
        }),
        _ => Ok(()),
    }
}
