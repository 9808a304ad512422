//! Speeds with limits of jerk that are planned piece by piece.
//!
//! Goal: the knots of a window in the least time, where those handed out stay as they are and the
//! machine can rest at the last. Method: what is planned ends at rest, and so does what is new; the
//! rest between is raised until nothing but the limits holds it, and both are one interior point to
//! go on from. Only what changes is planned: from well before the old rest on. How it comes to rest
//! at the end of the window will change too, so that this part stays where the limits are far: the
//! next raise begins there.

use super::{Most, approach, centre, for_each_run, go_inside, newton, next_rest, visit_all};
use crate::passes::segment_s;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot, passes};

/// What of a window is to be planned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extension {
    /// Speeds up to this knot stay.
    pub(crate) from: usize,
    /// The knot at which the machine was to rest.
    pub(crate) old: usize,
    /// The last knot that may be handed out before the window is planned again; all of them where
    /// nothing follows for now.
    pub(crate) handed: Option<usize>,
}

/// Plans the knots behind the old rest, and those before it that change, to a rest at the last.
pub(crate) fn extend<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    Extension { from, old, handed }: Extension,
) {
    // Where it rests behind a jump, it rests before it.
    let is_jump = knots.get(old).is_some_and(|knot| knot.ds <= 0.0);
    let old = old.saturating_sub(usize::from(is_jump && old > from));
    let last = knots.len().saturating_sub(1);
    if let Some(new) = knots.get_mut(old..) {
        rest_to_rest(limits, new);
    }
    let (mut begin, mut fixed) = (old, 0);
    if old > from {
        (begin, fixed) = changed(knots, from, old);
        let is_stop = knots.get(old).is_none_or(|knot| knot.cap <= 0.0);
        if let Some(run) = knots.get_mut(begin..)
            && old < last
            && !is_stop
        {
            raise(limits, run, fixed, old.saturating_sub(begin));
        }
    }
    while begin < last {
        let Some(rest) = knots.get_mut(begin..) else {
            break;
        };
        let end = next_rest(rest);
        if let Some(run) = rest.get_mut(..=end).filter(|_| end > 1) {
            let is_last = begin.saturating_add(end) >= last;
            let is_open = is_last && run.last().is_some_and(|knot| knot.cap > 0.0);
            let handed = handed.filter(|_| is_open);
            let handed = handed.map(|handed| handed.saturating_sub(begin));
            plan(limits, run, fixed, handed);
        }
        (begin, fixed) = (begin.saturating_add(end.max(1)), 0);
    }
}

/// Plans the knots to a rest at the last. Behind the one that may be handed out, how it comes to
/// that rest stays where the limits are far.
fn plan<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    fixed: usize,
    handed: Option<usize>,
) {
    let weight = centre(limits, knots, fixed);
    let all = knots.len();
    let before = |times| before_braking(knots, fixed, all.saturating_sub(1), times);
    let (braking, well_before) = (before(1.0), before(APART));
    // In a short window what is handed out is about the braking.
    let is_apart = handed.is_some_and(|handed| handed < well_before);
    let end = if is_apart {
        braking.saturating_add(OVERLAP).min(all)
    } else {
        all
    };
    let last = if end < all {
        end.saturating_sub(OVERLAP)
    } else {
        end
    };
    if let Some(own) = knots.get_mut(..end) {
        approach(limits, own, fixed..last, weight, STREAM_GAP);
    }
}

/// The knots that a step of the acceleration has beside it on both sides of a segment: so many stay
/// as they are where a plan meets another.
const OVERLAP: usize = 2;

/// The part of the time that a limit at each knot may cost.
const STREAM_GAP: f64 = 1e-3;

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

/// The first knot of what changes when the machine does not rest at the knot of the number `old`,
/// and how many stay as they are.
fn changed<A: Axes>(knots: &[Knot<A>], from: usize, old: usize) -> (usize, usize) {
    let from = before_braking(knots, from, old, CHANGED);
    let before = knots.get(from..old).unwrap_or_default();
    let rest = before.iter().rposition(|knot| knot.speed <= 0.0);
    // Without a rest, a segment and both its speeds are given.
    rest.map_or((from.saturating_sub(1), OVERLAP), |rest| {
        (from.saturating_add(rest), 0)
    })
}

/// The knot from which on a motion is another because it comes to rest at the knot of the number
/// `old`: so many times as long before it as the braking takes.
fn before_braking<A: Axes>(knots: &[Knot<A>], from: usize, old: usize, times: f64) -> usize {
    let (mut time_s, mut braking_s, mut fastest) = (0.0, 0.0, 0.0);
    let Some(before) = knots.get(from..=old) else {
        return from;
    };
    for (index, pair) in before.windows(2).enumerate().rev() {
        let [here, next] = pair else { continue };
        time_s += segment_s(here, next);
        if here.speed > fastest * FASTER {
            (fastest, braking_s) = (here.speed, time_s);
        } else if time_s > braking_s * times {
            return from.saturating_add(index);
        }
    }
    from
}

/// How long before a rest a motion is the same without it, by the time of the braking.
const CHANGED: f64 = 1.5;

/// How long before a rest the last row is handed out where the braking may wait, by the time of the
/// braking.
const APART: f64 = 2.0;

/// By what a speed is above the one to which a motion brakes from it.
const FASTER: f64 = 1.001;

/// Raises the speed of a rest, or of both knots of a jump, and those beside it. There is a way: the
/// accelerations before and after a rest are within what jerk makes of zero in half a segment each,
/// so their step is within what it makes in both halves.
///
/// The squares of the speeds go as far as the limits allow towards a smooth step between the
/// fastest places on both sides; between rests, towards the mean speed from one to the next.
fn raise<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>], fixed: usize, old: usize) {
    // The knot of a jump rests with the one before it.
    let jump = old.saturating_add(1);
    let has_jump = knots.get(jump).is_some_and(|knot| knot.ds <= 0.0);
    let behind = old.saturating_add(usize::from(has_jump));
    let end = behind.saturating_add(knots.get(behind..).map_or(0, next_rest));
    let Some(run) = knots.get_mut(..=end) else {
        return;
    };
    let before = run.get(..old).unwrap_or_default();
    let after = run.get(behind..).unwrap_or_default();
    let left = fastest_of(before.iter().enumerate()).max(fixed.saturating_sub(1));
    let right = behind.saturating_add(fastest_of(after.iter().enumerate()));
    let square = |index: usize| {
        let speed = run.get(index).map_or(0.0, |knot| knot.speed);
        speed * speed
    };
    let (mut low, mut high) = (square(left), square(right));
    if low.max(high) <= 0.0 {
        let mean = slowest_mean(limits, run.get(left..=right).unwrap_or_default());
        (low, high) = (mean * mean, mean * mean);
    }
    let inside = left.saturating_add(1)..right;
    let length_of = |knots: &[Knot<A>]| knots.iter().map(|knot| knot.ds).sum::<f64>();
    let whole = run
        .get(left.saturating_add(1)..=right)
        .map_or(1.0, length_of);
    let mut length = 0.0;
    for (index, knot) in run.iter_mut().enumerate() {
        knot.equation.right = 0.0;
        if inside.contains(&index) {
            length += knot.ds;
            let u = length / whole;
            let wanted = low + (high - low) * u * u * (3.0 - 2.0 * u);
            knot.equation.right = wanted - knot.speed * knot.speed;
        }
    }
    let mut part = 1.0;
    for _ in 0..HALVINGS {
        let mut most = Most::default();
        visit_all(limits, run, newton::speed_after(part), |segment| {
            segment.visit(&mut most);
            most.stretch < 1.0
        });
        if most.stretch < 1.0 {
            newton::go(run, &inside, part);
            return;
        }
        part *= 0.5;
    }
}

/// The lowest mean speed of the segments between rests.
fn slowest_mean<A: Axes>(limits: &Reciprocals<A>, rests: &[Knot<A>]) -> f64 {
    let pairs = rests.iter().zip(rests.iter().skip(1));
    let means = pairs.filter(|(_, to)| to.ds > 0.0).map(|(from, to)| {
        let time_s = passes::rest_to_rest_s(limits, [from, to], &to.tool);
        to.ds / time_s
    });
    means.fold(f64::INFINITY, f64::min)
}

/// The number of the fastest knot.
fn fastest_of<'k, A: Axes + 'k>(knots: impl Iterator<Item = (usize, &'k Knot<A>)>) -> usize {
    let fastest = knots.max_by(|(_, one), (_, other)| one.speed.total_cmp(&other.speed));
    fastest.map_or(0, |(index, _)| index)
}

/// Halvings of a way that a rest is raised by.
const HALVINGS: u32 = 60;
