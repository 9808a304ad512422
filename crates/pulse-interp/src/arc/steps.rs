//! Arcs of single steps.

use super::Arc;
use super::geometry::{Place, Quadrant, Sweep, rounded_root, signed};
use crate::feed::length_q16;
use crate::line::size_of_rest;
use crate::{Factor, Move, Rule, Turn};
use core::iter::FusedIterator;

/// The single steps of an [`Arc`]: an iterator of [`Move`]s of one axis.
///
/// Within a quadrant two comparisons and two additions a step:
/// ```text
/// F >= 0: inward,  F -= 2 a - 1, a -= 1
/// F <  0: outward, F += 2 b + 1, b += 1
/// ```
/// The nearest rule runs the same on F - a + b with 2 a - 2 and 2 b + 2.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct ArcSteps {
    passage: Passage,
    ahead: Ahead,
}

/// The steps within one quadrant: small enough for registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Passage {
    // -inward <= decision < outward, so at most 2^32 either way.
    decision: i64,
    // What the next step inward takes from the decision, and what it will be after the last.
    inward: i64,
    inward_end: i64,
    // What the next step outward adds, and what it will be after the last.
    outward: i64,
    outward_end: i64,
    quadrant: Quadrant,
}

impl Passage {
    /// Whether the axis that is due by the rule has steps left.
    #[inline]
    const fn follows_rule(&self) -> bool {
        if self.decision >= 0 {
            self.inward != self.inward_end
        } else {
            self.outward != self.outward_end
        }
    }

    #[inline]
    const fn rule_inward(&mut self) -> Move {
        self.decision = self.decision.wrapping_sub(self.inward);
        self.inward = self.inward.wrapping_sub(2);
        self.quadrant.inward
    }

    #[inline]
    const fn rule_outward(&mut self) -> Move {
        self.decision = self.decision.wrapping_add(self.outward);
        self.outward = self.outward.wrapping_add(2);
        self.quadrant.outward
    }

    /// The step by the rule.
    #[inline]
    const fn rule_step(&mut self) -> Move {
        if self.decision >= 0 {
            self.rule_inward()
        } else {
            self.rule_outward()
        }
    }

    /// The step by the rule while its axis has steps left, else that of the other.
    fn next(&mut self) -> Option<Move> {
        if self.follows_rule() {
            Some(self.rule_step())
        } else {
            self.other_axis()
        }
    }

    /// The step of the axis that alone has steps left.
    fn other_axis(&mut self) -> Option<Move> {
        if self.inward != self.inward_end {
            self.inward = self.inward.wrapping_sub(2);
            Some(self.quadrant.inward)
        } else if self.outward != self.outward_end {
            self.outward = self.outward.wrapping_add(2);
            Some(self.quadrant.outward)
        } else {
            None
        }
    }

    /// Steps still to come.
    fn left(&self) -> u64 {
        let inward = self.inward.wrapping_sub(self.inward_end);
        let outward = self.outward_end.wrapping_sub(self.outward);
        inward.wrapping_add(outward).unsigned_abs() >> 1
    }
}

/// What comes after the passage in hand.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Ahead {
    crossings: u8,
    turn: Turn,
    rule: Rule,
    /// Whether the steps left lead back to an end that the rule has passed.
    is_back: bool,
    /// Where the path crosses the axes.
    crossing: i64,
    /// In the quadrant of the end.
    end: Place,
    /// Steps of the passages ahead, those back to the end included.
    steps: u64,
    radius_q16: u64,
}

impl ArcSteps {
    pub(super) fn new(arc: &Arc, sweep: &Sweep, rule: Rule) -> Self {
        let square = arc.radius_squared;
        let crossing = match rule {
            // F >= 0 at a = 1. At R = 1 the path goes through the centre, and from there out by 1.
            Rule::Published => {
                let under = square.wrapping_sub(1);
                let root = under.isqrt();
                let up = root.wrapping_mul(root) < under;
                signed(root.wrapping_add(u64::from(up))).max(1)
            }
            // F - a + b >= 0 at a = 1.
            Rule::Nearest => rounded_root(square),
        };
        let mut steps = Self {
            passage: Passage {
                decision: match rule {
                    Rule::Published => 0,
                    Rule::Nearest => sweep.start.b.wrapping_sub(sweep.start.a),
                },
                inward: 0,
                inward_end: 0,
                outward: 0,
                outward_end: 0,
                quadrant: sweep.quadrant,
            },
            ahead: Ahead {
                crossings: sweep.crossings,
                turn: arc.turn,
                rule,
                is_back: false,
                crossing,
                end: sweep.end,
                steps: 0,
                radius_q16: length_q16(square),
            },
        };
        steps.ahead.steps = steps.ahead.count(sweep.start);
        steps.enter(sweep.start);
        steps
    }

    /// Sets the passage of a quadrant from `from`.
    fn enter(&mut self, from: Place) {
        let ahead = &self.ahead;
        let to = ahead.target();
        let (inward, outward) = match ahead.rule {
            Rule::Published => (-1, 1),
            Rule::Nearest => (-2, 2),
        };
        // Twice what is at most 2^31.
        let twice = |steps: i64| steps.wrapping_mul(2);
        self.passage.inward = twice(from.a).wrapping_add(inward);
        self.passage.inward_end = twice(to.a.min(from.a)).wrapping_add(inward);
        self.passage.outward = twice(from.b).wrapping_add(outward);
        self.passage.outward_end = twice(to.b.max(from.b)).wrapping_add(outward);
    }

    /// Where the path stands, in its quadrant.
    fn place(&self) -> Place {
        let offset = match self.ahead.rule {
            Rule::Published => 1,
            Rule::Nearest => 2,
        };
        Place {
            a: self.passage.inward.wrapping_add(offset) >> 1,
            b: self.passage.outward.wrapping_sub(offset) >> 1,
        }
    }

    /// Goes on where a passage is at its end; false at the end of the arc.
    #[cold]
    fn advance(&mut self) -> bool {
        let place = self.place();
        if self.ahead.crossings > 0 {
            self.passage.quadrant = self.passage.quadrant.next(self.ahead.turn);
            self.ahead.crossings = self.ahead.crossings.wrapping_sub(1);
            let from = Place { a: place.b, b: 0 };
            if self.ahead.rule == Rule::Nearest {
                // F - a + b, at (0, b) before and at (b, 0) now.
                self.passage.decision = self.passage.decision.wrapping_sub(place.b.wrapping_mul(2));
            }
            self.enter(from);
            self.ahead.steps = self.ahead.steps.wrapping_sub(self.passage.left());
            return true;
        }
        let end = self.ahead.end;
        if self.ahead.is_back || place == end {
            return false;
        }
        // The rule never comes back: what is missing lies against both of its moves.
        let back = Place {
            a: end.a.wrapping_sub(place.a),
            b: place.b.wrapping_sub(end.b),
        };
        self.passage.quadrant = Quadrant {
            inward: self.passage.quadrant.inward.reversed(),
            outward: self.passage.quadrant.outward.reversed(),
        };
        self.ahead.is_back = true;
        self.ahead.steps = 0;
        self.passage.inward = back.a.wrapping_mul(2);
        self.passage.inward_end = 0;
        self.passage.outward = back.b.wrapping_mul(-2);
        self.passage.outward_end = 0;
        true
    }

    /// The next step, where the passage alone does not determine it.
    #[cold]
    #[inline(never)]
    fn beyond(mut self) -> (Self, Option<Move>) {
        loop {
            let step = self.passage.next();
            if step.is_some() || !self.advance() {
                return (self, step);
            }
        }
    }

    /// Steps still to come.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.passage.left().wrapping_add(self.ahead.steps)
    }

    /// What the interval before the next step is multiplied with so that the path is as fast as a
    /// straight axis: from 0.7071 along a diagonal to 1.
    ///
    /// ```text
    /// R / (|x| + |y|)
    /// ```
    /// One division: the only one, and outside [`next`](Iterator::next).
    #[must_use]
    #[inline]
    pub fn factor(&self) -> Factor {
        let at_last = self.ahead.crossings == 0 && self.passage.left() == 0;
        if at_last || self.ahead.is_back {
            return Factor::ONE;
        }
        // inward + outward = 2 (a + b) under both rules.
        let sum = self
            .passage
            .inward
            .wrapping_add(self.passage.outward)
            .unsigned_abs()
            >> 1;
        Factor::of_q16(self.ahead.radius_q16, sum)
    }
}

impl Ahead {
    /// Where the passage in hand ends.
    const fn target(&self) -> Place {
        if self.crossings == 0 {
            return self.end;
        }
        Place {
            a: 0,
            b: self.crossing,
        }
    }

    /// Steps after the passage from `from`.
    fn count(&self, from: Place) -> u64 {
        // A whole quadrant is at most 2^31 steps.
        let quadrant = self.crossing.unsigned_abs().wrapping_mul(2);
        let whole = |crossings: u8| u64::from(crossings).wrapping_mul(quadrant);
        match self.crossings.checked_sub(1) {
            // Out, and in or back to the end.
            Some(between) => whole(between)
                .wrapping_add(self.crossing.abs_diff(self.end.a))
                .wrapping_add(self.end.b.unsigned_abs()),
            None => {
                let back_a = self.end.a.saturating_sub(from.a).max(0);
                let back_b = from.b.saturating_sub(self.end.b).max(0);
                back_a.wrapping_add(back_b).unsigned_abs()
            }
        }
    }
}

impl Iterator for ArcSteps {
    type Item = Move;

    #[inline]
    fn next(&mut self) -> Option<Move> {
        if !self.passage.follows_rule() {
            // By value: with its address given away, the state would not stay in registers.
            let (rest, step) = self.clone().beyond();
            *self = rest;
            return step;
        }
        Some(self.passage.rule_step())
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for ArcSteps {}
