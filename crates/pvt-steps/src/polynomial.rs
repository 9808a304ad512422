//! The cubic of one axis in one row.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_wrap,
    reason = "`Cubic::new` leaves room for the sums"
)]

use crate::Direction;
use crate::fixed::{ONE, first, fraction, shifted, signed_high};
use crate::row::PvtKnot;

/// The most fraction bits of a position.
const MAX_BITS: u32 = 50;
/// Bits of a distance or v T, at most, with those after the point: sums of 24 of them stay below
/// 2^62.
const DISTANCE_BITS: u32 = 57;

/// Fraction bits with which every distance fits: half a step a tick for 2^32 ticks.
const WHOLE_BITS: u32 = 31;

/// q(s) = q0 + q1 s + q2 s² + q3 s³ for the fraction s of a row's time, in 2^-bits steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cubic {
    pub(crate) bits: u32,
    pub(crate) q0: i64,
    pub(crate) q1: i64,
    pub(crate) q2: i64,
    pub(crate) q3: i64,
}

/// A cubic at one place, per fraction of the row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Derivatives {
    pub(crate) position: i64,
    pub(crate) velocity: i64,
    pub(crate) half_acceleration: i64,
}

/// Where a cubic turns round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Turns {
    /// Direction at the start.
    pub(crate) direction: Direction,
    /// Fractions at which the direction changes, in order; [`ONE`] where there is none.
    pub(crate) at: [u64; 2],
}

impl Turns {
    /// In one direction.
    pub(crate) const fn none(direction: Direction) -> Self {
        Self {
            direction,
            at: [ONE; 2],
        }
    }
}

impl Cubic {
    /// From one knot to the next in `ticks` >= 1 ticks with velocities of at most half a step a
    /// tick, positions counted from `origin` whole steps next to the first; `None` for a travel of
    /// 2^31 steps and more.
    ///
    /// With B the greatest of the distance, v0 T and v1 T, |q2| and |q3| are at most 6 B, and the
    /// sums below at most 24 B. That leaves 50 bits after the point for 128 steps a row, and one
    /// less with each doubling. The coefficients are rounded to them, so that q is off by less than
    /// 8 units.
    pub(crate) fn new(from: PvtKnot, to: PvtKnot, ticks: u32, origin: i64) -> Option<Self> {
        let travel = to.position.checked_sub(from.position)?;
        let scale = |knot: PvtKnot, bits: u32| distance(knot.velocity, ticks, bits);
        let most = (travel.unsigned_abs() >> (PvtKnot::POSITION_BITS - WHOLE_BITS))
            .max(scale(from, WHOLE_BITS).unsigned_abs())
            .max(scale(to, WHOLE_BITS).unsigned_abs());
        let used = 64 - (most + 1).leading_zeros();
        let bits = (DISTANCE_BITS + WHOLE_BITS - used).min(MAX_BITS);
        let more = bits as i32 - PvtKnot::POSITION_BITS as i32;
        let offset = from.position.wrapping_sub(origin << PvtKnot::POSITION_BITS);
        let travel = shifted(travel, more);
        let (v0, v1) = (scale(from, bits), scale(to, bits));
        Some(Self {
            bits,
            q0: shifted(offset, more),
            q1: v0,
            q2: 3 * travel - 2 * v0 - v1,
            q3: v0 + v1 - 2 * travel,
        })
    }

    /// The same in reverse.
    pub(crate) const fn reversed(&self) -> Self {
        Self {
            bits: self.bits,
            q0: -self.q0,
            q1: -self.q1,
            q2: -self.q2,
            q3: -self.q3,
        }
    }

    /// One step.
    pub(crate) const fn step(&self) -> i64 {
        1 << self.bits
    }

    /// q, q' and q'' / 2 at a fraction of the row.
    pub(crate) const fn at(&self, s: u64) -> Derivatives {
        let a = fraction(self.q3, s);
        let b = fraction(self.q2 + a, s);
        Derivatives {
            position: self.q0 + fraction(self.q1 + b, s),
            velocity: self.q1 + b + fraction(self.q2 + 2 * a, s),
            half_acceleration: self.q2 + 3 * a,
        }
    }

    /// q'' / 2 at the end.
    const fn end_acceleration(&self) -> i64 {
        self.q2 + 3 * self.q3
    }

    /// The greatest |q''| / 2.
    pub(crate) fn max_acceleration(&self) -> i64 {
        self.q2.abs().max(self.end_acceleration().abs())
    }

    /// Between 0, q' at both ends and this lies q' all along: its control value in the middle.
    const fn middle_velocity(&self) -> i64 {
        self.q1 + self.q2
    }

    /// Where |q'| is above that of `velocity` within the row, although it is not at its ends.
    pub(crate) fn peak_above(&self, velocity: i64, ticks: u32) -> Option<u64> {
        // Nothing is above a limit that does not fit these bits.
        let more = self.bits.saturating_sub(WHOLE_BITS);
        if distance(velocity, ticks, self.bits - more) >> (62 - more) > 0 {
            return None;
        }
        let limit = distance(velocity, ticks, self.bits);
        let above = |q: i64| q.abs() > limit;
        if !above(self.middle_velocity()) {
            return None;
        }
        let vertex = self.vertex()?;
        above(self.at(vertex).velocity).then_some(vertex)
    }

    /// Where q'' changes its sign within the row.
    fn vertex(&self) -> Option<u64> {
        let rises = self.q3 > 0;
        if (self.q2 >= 0) == rises || (self.end_acceleration() > 0) != rises {
            return None;
        }
        Some(first(0, ONE, |s| {
            (self.at(s).half_acceleration >= 0) == rises
        }))
    }

    /// Where the axis turns round; `None` when it does not move.
    pub(crate) fn turns(&self) -> Option<Turns> {
        let end = self.end_acceleration();
        let start = sign([self.q1, self.q2, self.q3])?;
        let last = sign([self.q1 + self.q2 + end, -end, self.q3])?;
        let back = start.reversed();
        let moves = |s: u64, direction| sign([self.at(s).velocity]) == Some(direction);
        let mut turns = Turns::none(start);
        if start != last {
            turns.at = [first(0, ONE, |s| moves(s, last)), ONE];
        } else if sign([self.middle_velocity()]) == Some(back)
            && let Some(vertex) = self.vertex()
            && moves(vertex, back)
        {
            turns.at = [
                first(0, vertex, |s| moves(s, back)),
                first(vertex, ONE, |s| moves(s, start)),
            ];
        }
        Some(turns)
    }
}

/// The distance moved at a velocity of up to half a step a tick, in 2^-bits steps, rounded down.
pub(crate) fn distance(velocity: i64, ticks: u32, bits: u32) -> i64 {
    // v T 2^(bits - 56) = (v 2^a) (T 2^b) 2^-64.
    let b = u64::from(ticks).leading_zeros().min(bits + 8);
    signed_high(velocity << (bits + 8 - b), u64::from(ticks) << b)
}

/// The sign of the first number that is not zero.
fn sign<const N: usize>(derivatives: [i64; N]) -> Option<Direction> {
    derivatives
        .into_iter()
        .find(|&derivative| derivative != 0)
        .map(|derivative| {
            if derivative > 0 {
                Direction::Positive
            } else {
                Direction::Negative
            }
        })
}
