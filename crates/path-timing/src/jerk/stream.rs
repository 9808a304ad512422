//! Speeds with limits of jerk that are planned piece by piece.
//!
//! Goal: the knots of a window in the least time, where those handed out stay as they are and the machine
//! can rest at the last. Method: what is planned ends at rest, and so does what is new; the rest between
//! is raised until nothing but the limits holds it, and both are one interior point to go on from. The
//! speeds stay inside: the next piece begins there.

use super::{Effort, approach, for_each_run, go_inside, next_rest, tightest};
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot, passes};

/// Plans the knots behind the one of the number `old`, at which the machine was to rest, to a rest at
/// the last; those behind `from` get faster, those up to it stay.
pub(crate) fn extend<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    from: usize,
    old: usize,
) {
    // Where it rests behind a jump, it rests before it.
    let is_jump = knots.get(old).is_some_and(|knot| knot.ds <= 0.0);
    let old = old.saturating_sub(usize::from(is_jump && old > from));
    if let Some(new) = knots.get_mut(old..) {
        rest_to_rest(limits, new);
    }
    let is_stop = knots.get(old).is_none_or(|knot| knot.cap <= 0.0);
    let mut begin = old;
    if old > from && !is_stop {
        begin = join(limits, knots, from, old);
    }
    if let Some(rest) = knots.get_mut(begin..) {
        for_each_run(rest, |run| approach(limits, run, 0, &STREAM));
    }
}

/// The fastest motion from rest to rest, slowed until it is inside all limits of each of its parts.
fn rest_to_rest<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>]) {
    let [.., last] = knots else { return };
    let after = core::mem::replace(&mut last.cap, 0.0);
    let [first, ..] = knots else { return };
    let before = core::mem::replace(&mut first.cap, 0.0);
    passes::fastest(limits, knots);
    if let [first, .., last] = knots {
        (first.cap, last.cap) = (before, after);
    }
    for_each_run(knots, |run| go_inside(limits, run));
}

/// Has the machine pass the knot of the number `old`, if it can. Where what is not planned begins.
fn join<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>], from: usize, old: usize) -> usize {
    // The knot of a jump rests with the one before it.
    let jump = old.saturating_add(1);
    let has_jump = knots.get(jump).is_some_and(|knot| knot.ds <= 0.0);
    let behind = old.saturating_add(usize::from(has_jump));
    let end = behind.saturating_add(knots.get(behind..).map_or(0, next_rest));
    let before = knots.get(from..old).unwrap_or_default();
    let rest = before.iter().rposition(|knot| knot.speed <= 0.0);
    // Without a rest, the segment handed out last and both its speeds are given.
    let (begin, fixed) = rest.map_or((from.saturating_sub(1), 2), |rest| {
        (from.saturating_add(rest), 0)
    });
    let joint = [old, behind].map(|index| index.saturating_sub(begin));
    let Some(run) = knots.get_mut(begin..=end) else {
        return old;
    };
    if !raise(limits, run, joint) {
        return old;
    }
    approach(limits, run, fixed, &STREAM);
    end
}

/// Raises the speed of a rest, or of both knots of a jump, to one that all limits allow. There is one: the
/// accelerations before and after a rest are within what jerk makes of zero in half a segment each, so
/// their step is within what it makes in both halves.
fn raise<A: Axes>(limits: &Reciprocals<A>, run: &mut [Knot<A>], [old, behind]: [usize; 2]) -> bool {
    let speed_of = |index: usize| run.get(index).map_or(0.0, |knot| knot.speed);
    let mut speed = speed_of(old.saturating_sub(1)).max(speed_of(behind.saturating_add(1)));
    for _ in 0..HALVINGS {
        speed *= 0.5;
        set(run, [old, behind], speed);
        if speed > 0.0 && tightest(limits, run) < 1.0 {
            return true;
        }
    }
    set(run, [old, behind], 0.0);
    false
}

fn set<A: Axes>(run: &mut [Knot<A>], [old, behind]: [usize; 2], speed: f64) {
    for knot in run.get_mut(old..=behind).unwrap_or_default() {
        knot.speed = speed;
    }
}

/// Halvings of a speed that a rest may be passed at.
const HALVINGS: u32 = 40;

/// Where a rest is raised, most steps are short ones.
const STREAM: Effort = Effort {
    last_gap: 1e-3,
    steps: 50,
    centred: 0.003,
};
