//! The rows of a ramp.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    reason = "at most 2^31 steps, and velocities of a quarter of a step a tick"
)]

use super::plan::Plan;
use crate::fixed::{Inverse, ONE, fraction};
use crate::polynomial::distance;
use crate::{PvtKnot, PvtRow};

/// Ticks of a row at constant speed, when there are more than [`MAX_TICKS`] left.
const CHUNK_TICKS: u32 = 1 << 31;
/// Most ticks of the last row at constant speed.
const MAX_TICKS: u64 = 3 << 30;

/// The rows of one axis of a ramp, as ticks and knots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AxisRows {
    negative: bool,
    /// The knot of the last row.
    last: PvtKnot,
    up_ticks: u64,
    /// What is left of it.
    cruise_ticks: u64,
    /// Of all of it.
    whole_cruise: Option<Inverse>,
    down_ticks: u64,
    peak: i64,
    /// At the end of the acceleration, and of the travel at constant speed, in 2^-32 steps.
    up_end: i64,
    cruise_end: i64,
    end: PvtKnot,
}

impl AxisRows {
    /// An axis with `steps` steps, at most those of the leading axis.
    pub(super) fn new(plan: &Plan, steps: i32) -> Self {
        let part = Inverse::of(u64::from(plan.max_pulses))
            .and_then(|inverse| inverse.fraction(u64::from(steps.unsigned_abs())));
        let part = match part {
            _ if steps.unsigned_abs() == plan.max_pulses => ONE,
            Some(part) => part,
            None => 0,
        };
        let [entry, peak, exit] =
            [plan.entry, plan.peak, plan.exit].map(|velocity| fraction(velocity, part));
        let end = i64::from(steps.unsigned_abs()) << PvtKnot::POSITION_BITS;
        // The mean of two velocities in 2^-32 steps is their sum in 2^-31.
        let phase = |sum: i64, ticks: u64| distance(sum, ticks as u32, PvtKnot::POSITION_BITS - 1);
        Self {
            negative: steps < 0,
            last: PvtKnot {
                position: 0,
                velocity: entry,
            },
            up_ticks: plan.up_ticks,
            cruise_ticks: plan.cruise_ticks,
            whole_cruise: Inverse::of(plan.cruise_ticks),
            down_ticks: plan.down_ticks,
            peak,
            up_end: phase(entry + peak, plan.up_ticks),
            cruise_end: end - phase(peak + exit, plan.down_ticks),
            end: PvtKnot {
                position: end,
                velocity: exit,
            },
        }
    }

    /// The knot of the last row, or the first one of all.
    pub(super) const fn knot(&self) -> PvtKnot {
        let PvtKnot { position, velocity } = self.last;
        if self.negative {
            PvtKnot {
                position: -position,
                velocity: -velocity,
            }
        } else {
            self.last
        }
    }

    /// The next row that is no end, in the direction of the axis.
    fn advance(&mut self) -> Option<u32> {
        let ticks;
        if self.up_ticks > 0 {
            ticks = core::mem::take(&mut self.up_ticks) as u32;
            self.last.position = self.up_end;
        } else if self.cruise_ticks > MAX_TICKS {
            ticks = CHUNK_TICKS;
            self.cruise_ticks -= u64::from(ticks);
            self.last.position = self.cruise_end - self.cruise_left();
        } else if self.cruise_ticks > 0 {
            ticks = core::mem::take(&mut self.cruise_ticks) as u32;
            self.last.position = self.cruise_end;
        } else if self.down_ticks > 0 {
            ticks = core::mem::take(&mut self.down_ticks) as u32;
        } else {
            return None;
        }
        self.last.velocity = self.peak;
        if self.cruise_ticks == 0 && self.down_ticks == 0 {
            self.last = self.end;
        }
        Some(ticks)
    }
}

impl AxisRows {
    /// What is left of the travel at constant speed, in 2^-32 steps.
    fn cruise_left(&self) -> i64 {
        let part = self
            .whole_cruise
            .and_then(|whole| whole.fraction(self.cruise_ticks));
        let travel = self.cruise_end - self.up_end;
        part.map_or(0, |part| fraction(travel >> 1, part) << 1)
    }
}

impl Iterator for AxisRows {
    type Item = (u32, PvtKnot);

    fn next(&mut self) -> Option<(u32, PvtKnot)> {
        let ticks = self.advance()?;
        Some((ticks, self.knot()))
    }
}

/// The rows of a [`Ramp`](crate::Ramp), at most one for speeding up, one for slowing down and one
/// for each 2^31 ticks between them.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct RampRows<const N: usize> {
    axes: [AxisRows; N],
}

impl<const N: usize> RampRows<N> {
    pub(super) const fn new(axes: [AxisRows; N]) -> Self {
        Self { axes }
    }
}

impl<const N: usize> Iterator for RampRows<N> {
    type Item = PvtRow<N>;

    fn next(&mut self) -> Option<PvtRow<N>> {
        // Without axes, no rows.
        self.axes.first()?;
        let mut row = PvtRow {
            ticks: 0,
            knots: [PvtKnot::default(); N],
        };
        for (axis, knot) in self.axes.iter_mut().zip(&mut row.knots) {
            (row.ticks, *knot) = axis.next()?;
        }
        Some(row)
    }
}

impl<const N: usize> core::iter::FusedIterator for RampRows<N> {}
