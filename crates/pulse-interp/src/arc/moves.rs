//! Arcs of moves to any neighbour.

use super::Arc;
use super::circle::Circle;
use super::geometry::{Place, Quadrant, Sweep};
use crate::feed::length_q16;
use crate::line::size_of_rest;
use crate::{Factor, Move, Turn};
use core::iter::FusedIterator;

/// The midpoint arc: an iterator of [`Move`]s to any of eight neighbours.
///
/// Two comparisons and three additions a move. In each octant one axis is in every move; the other
/// joins where the midpoint between the two places to go to is on the wrong side of the circle:
/// ```text
/// b leads (a > b):  a - 1 joins where F(a - 1/2, b + 1) >= 0
/// a leads (a <= b): b + 1 joins where F(a - 1, b + 1/2) <  0
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct ArcMoves {
    octant: Octant,
    phase: Phase,
    ahead: Ahead,
}

/// The moves within one octant: small enough for registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Octant {
    // The diagonal move is taken from 0 on; at most 2^33 either way.
    decision: i64,
    // What the next move adds to the decision, and a diagonal one besides.
    straight_by: i64,
    extra_by: i64,
    // straight_by after the last move.
    straight_end: i64,
    // What each move adds to the first, and a diagonal one to the second: 2 or -2.
    bend: i64,
    straight: Move,
    diagonal: Move,
}

impl Octant {
    #[inline]
    const fn take_diagonal(&mut self) -> Move {
        self.decision = self.decision.wrapping_add(self.extra_by);
        self.extra_by = self.extra_by.wrapping_add(self.bend);
        self.take_straight();
        self.diagonal
    }

    #[inline]
    const fn take_straight(&mut self) -> Move {
        self.decision = self.decision.wrapping_add(self.straight_by);
        self.straight_by = self.straight_by.wrapping_add(self.bend);
        self.straight
    }

    const fn is_at_end(&self) -> bool {
        self.straight_by == self.straight_end
    }

    #[inline]
    const fn next(&mut self) -> Option<Move> {
        if self.is_at_end() {
            None
        } else if self.decision >= 0 {
            Some(self.take_diagonal())
        } else {
            Some(self.take_straight())
        }
    }

    /// Moves still to come.
    const fn left(&self) -> u64 {
        self.straight_end.abs_diff(self.straight_by) >> 1
    }
}

/// What the moves in hand are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// a > b at its start: each is b + 1.
    Low,
    /// a <= b: each is a - 1.
    High,
    /// Off the rule, to an end near the circle.
    Closing(Place),
}

/// What comes after the octant in hand.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Ahead {
    quadrant: Quadrant,
    turn: Turn,
    crossings: u8,
    /// Where the octants meet.
    middle: Place,
    end: Place,
    /// Moves after this octant.
    moves: u64,
    radius_q16: u64,
}

impl ArcMoves {
    pub(super) fn new(arc: &Arc, sweep: &Sweep) -> Self {
        let circle = Circle::new(arc.radius_squared);
        let mut moves = Self {
            octant: Octant {
                decision: 0,
                straight_by: 0,
                extra_by: 0,
                straight_end: 0,
                bend: 2,
                straight: Move::Right,
                diagonal: Move::Right,
            },
            phase: Phase::Closing(sweep.start),
            ahead: Ahead {
                quadrant: sweep.quadrant,
                turn: arc.turn,
                crossings: sweep.crossings,
                middle: circle.middle,
                end: sweep.end,
                moves: circle.moves(sweep),
                radius_q16: length_q16(arc.radius_squared),
            },
        };
        let Place { a, b } = sweep.start;
        let phase = if b < a && b < circle.middle.b {
            Phase::Low
        } else {
            Phase::High
        };
        moves.enter(phase, sweep.start, 0);
        moves
    }

    /// Sets the moves of an octant from `from`, where F is `off`.
    fn enter(&mut self, phase: Phase, from: Place, off: i64) {
        let Quadrant { inward, outward } = self.ahead.quadrant;
        let Place { a, b } = from;
        self.octant.diagonal = self.ahead.quadrant.of_signs(-1, 1).unwrap_or(inward);
        // Coordinates of at most 2^30 + 1 and F of at most 2^31: nothing leaves 34 bits.
        let twice = |steps: i64| steps.wrapping_mul(2);
        let last = self.ahead.stop();
        self.phase = phase;
        if phase == Phase::Low {
            self.octant.bend = 2;
            self.octant.decision = off.wrapping_add(twice(b)).wrapping_add(1).wrapping_sub(a);
            self.octant.straight_by = twice(b).wrapping_add(3);
            self.octant.extra_by = 2_i64.wrapping_sub(twice(a));
            self.octant.straight = outward;
            self.set_left(self.ahead.middle.b.min(last.b).wrapping_sub(b));
        } else {
            self.octant.bend = -2;
            // Negated, so that the diagonal is taken from 0 on here too.
            self.octant.decision = twice(a).wrapping_sub(2).wrapping_sub(b).wrapping_sub(off);
            self.octant.straight_by = twice(a).wrapping_sub(3);
            self.octant.extra_by = (-2_i64).wrapping_sub(twice(b));
            self.octant.straight = inward;
            self.set_left(a.wrapping_sub(last.a));
        }
    }

    /// Sets how many moves come before the next look at what is ahead; none if negative.
    fn set_left(&mut self, moves: i64) {
        let moves = moves.max(0);
        self.octant.straight_end = self
            .octant
            .straight_by
            .wrapping_add(self.octant.bend.wrapping_mul(moves));
        self.ahead.moves = self.ahead.moves.wrapping_sub(moves.unsigned_abs());
    }

    /// Where the path stands, in its quadrant, and F there.
    fn place(&self) -> (Place, i64) {
        let Octant {
            decision,
            straight_by,
            extra_by,
            ..
        } = self.octant;
        // `enter` solved for a, b and F.
        match self.phase {
            Phase::Low => {
                let b = straight_by.wrapping_sub(3) >> 1;
                let a = 2_i64.wrapping_sub(extra_by) >> 1;
                let off = decision.wrapping_sub(1).wrapping_sub(b.wrapping_mul(2));
                (Place { a, b }, off.wrapping_add(a))
            }
            Phase::High => {
                let a = straight_by.wrapping_add(3) >> 1;
                let b = (-2_i64).wrapping_sub(extra_by) >> 1;
                let off = a.wrapping_mul(2).wrapping_sub(2).wrapping_sub(decision);
                (Place { a, b }, off.wrapping_sub(b))
            }
            Phase::Closing(place) => (place, 0),
        }
    }

    /// Goes on where an octant is at its end; false at the end of the arc.
    #[cold]
    fn advance(&mut self) -> bool {
        let (place, off) = self.place();
        let ahead = &mut self.ahead;
        match self.phase {
            Phase::Low if !ahead.stops_low() => self.enter(Phase::High, place, off),
            Phase::High if ahead.crossings > 0 => {
                ahead.quadrant = ahead.quadrant.next(ahead.turn);
                ahead.crossings = ahead.crossings.wrapping_sub(1);
                self.enter(Phase::Low, Place { a: place.b, b: 0 }, off);
            }
            _ => return self.close(place),
        }
        true
    }

    /// The next moves from `place` straight to the end; false when it is there.
    fn close(&mut self, place: Place) -> bool {
        let Place { a, b } = self.ahead.end;
        let (da, db) = (a.wrapping_sub(place.a), b.wrapping_sub(place.b));
        let diagonals = da.abs().min(db.abs());
        let Some(step) = self.ahead.quadrant.of_signs(da, db) else {
            return false;
        };
        // First what both axes have in common, then the rest of one.
        let (len, to) = if diagonals > 0 {
            let by = |d: i64| d.signum().wrapping_mul(diagonals);
            let to = Place {
                a: place.a.wrapping_add(by(da)),
                b: place.b.wrapping_add(by(db)),
            };
            (diagonals, to)
        } else {
            (da.abs().max(db.abs()), self.ahead.end)
        };
        self.phase = Phase::Closing(to);
        (self.octant.straight, self.octant.diagonal) = (step, step);
        self.octant.bend = 2;
        self.set_left(len);
        true
    }

    /// The next move, where the octant alone does not determine it.
    #[cold]
    #[inline(never)]
    fn beyond(mut self) -> (Self, Option<Move>) {
        loop {
            let step = self.octant.next();
            if step.is_some() || !self.advance() {
                return (self, step);
            }
        }
    }

    /// Moves still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.octant.left().wrapping_add(self.ahead.moves)
    }

    /// What the interval before the next move is multiplied with so that the path is as fast as a
    /// straight axis: from 1 to 1.4142 along a diagonal.
    ///
    /// ```text
    /// R / max(|x|, |y|)
    /// ```
    #[must_use]
    #[inline]
    pub fn factor(&self) -> Factor {
        let (place, _) = self.place();
        Factor::of_q16(self.ahead.radius_q16, place.a.max(place.b).unsigned_abs())
    }
}

impl Ahead {
    /// Whether the end is here, and before the middle.
    const fn stops_low(&self) -> bool {
        self.crossings == 0 && self.end.b < self.end.a
    }

    /// Where the rule stops in this quadrant.
    const fn stop(&self) -> Place {
        const NEVER: i64 = i64::MAX;
        if self.crossings > 0 {
            Place { a: 0, b: NEVER }
        } else if self.stops_low() {
            Place {
                a: NEVER,
                b: self.end.b,
            }
        } else {
            Place {
                a: self.end.a,
                b: NEVER,
            }
        }
    }
}

impl Iterator for ArcMoves {
    type Item = Move;

    #[inline]
    fn next(&mut self) -> Option<Move> {
        let step = self.octant.next();
        if step.is_some() {
            return step;
        }
        // By value: with its address given away, the state would not stay in registers.
        let (rest, step) = self.clone().beyond();
        *self = rest;
        step
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for ArcMoves {}
