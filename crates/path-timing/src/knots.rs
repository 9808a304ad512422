//! Where the knots of a path stand, and what lies between two of them.

use crate::number::{Real, larger, sqrt};
use crate::passes::segment_s;
use crate::reciprocals::Reciprocals;
use crate::stretch::unused;
use crate::{Axes, Knot, Row, Span};

/// The segment between two knots that is passed at these speeds: it takes 2Δs/(w₀ + w₁).
pub(crate) fn span<A: Axes>(
    [from, to]: [&Knot<A>; 2],
    [w0, w1]: [f64; 2],
    duration_s: f64,
) -> Span<A> {
    Span {
        s: [from.next_start(), to.s],
        rows: [
            from.row(w0),
            Row {
                duration_s,
                time_s: duration_s,
                ..to.row(w1)
            },
        ],
    }
}

/// The segment between two knots in a second, at a ratio of both speeds: from rest at 0, evenly at
/// 1, to rest at 2.
pub(crate) fn span_in_a_second<A: Axes>(knots: [&Knot<A>; 2], start: f64) -> Span<A> {
    let [_, to] = knots;
    span(knots, [start * to.ds, (2.0 - start) * to.ds], 1.0)
}

/// Whether the positions and slopes at both ends of a segment agree: the mean slope of each axis,
/// in units of its speed limit, is that of the slopes at its ends but for a part of the steepest
/// one. What happens to the path between two knots that do not cannot be known from them, and a
/// cubic through them may take any time.
pub(crate) fn is_resolved<A: Axes, R: Real>(
    limits: &Reciprocals<A, R>,
    from: &Knot<A>,
    to: &Knot<A>,
    gap: f64,
) -> bool {
    let inverse = R::ONE / R::of(to.s - from.next_start());
    let positions = (from.point.position.as_slice().iter()).zip(to.point.position.as_slice());
    let slopes = (from.point.slope.as_slice().iter()).zip(to.point.slope.as_slice());
    let axes = limits.axes().iter().zip(positions.zip(slopes));
    let (mut apart, mut steepest) = (R::ZERO, [R::ZERO; 3]);
    for (limit, ((q0, q1), (p0, p1))) in axes {
        let mean = R::of(q1 - q0) * inverse;
        let (p0, p1) = (R::of(*p0), R::of(*p1));
        let rounding = (R::of(*q0).abs() + R::of(*q1).abs()) * inverse * R::of(ROUNDING);
        let apart_by = (mean - (p0 + p1) * R::of(0.5)).abs() - rounding;
        let by = apart_by.max(R::ZERO) * limit.speed;
        apart = apart + by * by;
        for (square, slope) in steepest.iter_mut().zip([mean, p0, p1]) {
            *square = *square + (slope * limit.speed) * (slope * limit.speed);
        }
    }
    let steepest = steepest.into_iter().fold(R::ZERO, Real::max);
    apart <= steepest * R::of(gap * gap)
}

/// Whether all segments are resolved, but those after a stop, where a leg begins with slopes that
/// the knot before, which ends another, does not have.
pub(crate) fn are_resolved<A: Axes>(limits: &Reciprocals<A>, knots: &[Knot<A>], gap: f64) -> bool {
    let begins = |from: &Knot<A>| from.ends_leg && from.cap <= 0.0;
    knots.windows(2).all(|pair| match pair {
        [from, to] => to.ds <= 0.0 || begins(from) || is_resolved(limits, from, to, gap),
        _ => true,
    })
}

/// The part of the steepest slope by which slopes may disagree. Of 5000 random paths with 2 to 39
/// segments those that keep it took at most 3 times the time of 400 segments, of the others one in
/// eight more.
pub(crate) const LARGEST_GAP: f64 = 0.2;

/// The same for a path of two segments, of which one begins at rest and the other ends there.
pub(crate) const LARGEST_GAP_AT_RESTS: f64 = 0.1;

/// Relative rounding of positions, with those of paths that are sums and turns.
const ROUNDING: f64 = 1e-11;

/// What decides where the knots of a leg stand, as parts of each segment's share; the rest is the
/// same for all, so that places of high speed, where a limit may be hidden between two knots, keep
/// theirs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shares {
    /// By its time.
    pub(crate) time: f64,
    /// By what it leaves [`unused`] of the limits.
    pub(crate) unused: f64,
    /// By how its speed changes: next to constant speed, cubics that depart as much take a time as
    /// the square root of the acceleration has it, √(a) T.
    pub(crate) bend: f64,
}

impl Shares {
    /// With a part by the change of speed; the others shrink for it.
    pub(crate) const fn bent(self, bend: f64) -> Self {
        let rest = 1.0 - bend;
        Self {
            time: self.time * rest,
            unused: self.unused * rest,
            bend,
        }
    }
}

/// Writes what each segment of the first `planned` knots leaves unused into its second knot, for
/// [`spread`].
pub(crate) fn note_unused<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>], planned: usize) {
    let mut time_s = 0.0;
    each_segment(knots, planned, |from, to| time_s += segment_s(from, to));
    let least_s = time_s / index_as_f64(planned.saturating_sub(1)) * LEAST_TIME;
    each_segment(knots, planned, |from, to| {
        let own_s = segment_s(from, to);
        // The ratio is of the passes alone.
        to.ratio = if own_s > least_s {
            unused(limits, [from, to], own_s)
        } else {
            0.0
        };
    });
}

/// The shortest segment, in units of the mean time of one, that gets more knots for what it leaves
/// unused: where one limit takes over from another that is always one of them, and knots would
/// gather there until only rounding lies between them, which takes the limits for itself.
const LEAST_TIME: f64 = 0.01;

/// Where each knot of a leg has to stand for all segments to have the same share, and the speed
/// there, written into the knots; the speeds of the first `planned` of them, which reach from its
/// start to its end, are, and what they leave unused where that counts. The most that is lost on a
/// segment, what it leaves unused times its time, in units of the mean time of a segment.
pub(crate) fn spread<A: Axes>(parts: Shares, knots: &mut [Knot<A>], planned: usize) -> f64 {
    let count = knots.len().saturating_sub(1);
    let [segments, own] = [count, planned.saturating_sub(1)].map(index_as_f64);
    let (mut time_s, mut all_bends) = (0.0, 0.0);
    let (mut all_unused, mut most_lost_s) = (0.0, 0.0);
    each_segment(knots, planned, |from, to| {
        let own_s = segment_s(from, to);
        time_s += own_s;
        if parts.unused > 0.0 {
            all_unused += to.ratio;
            most_lost_s = larger(most_lost_s, to.ratio * own_s);
        }
        if parts.bend > 0.0 {
            all_bends += bend(from, to, own_s);
        }
    });
    let part_of = |part: f64, sum: f64| {
        if sum > 0.0 {
            part * segments / sum
        } else {
            0.0
        }
    };
    let per_second = part_of(parts.time, time_s);
    let per_unused = part_of(parts.unused, all_unused);
    let per_bend = part_of(parts.bend, all_bends);
    let shared = per_second * time_s + per_unused * all_unused + per_bend * all_bends;
    let even = (segments - shared) / own;
    each_segment(knots, planned, |from, to| {
        let own_s = segment_s(from, to);
        let mut share = own_s * per_second + even;
        if per_unused > 0.0 {
            share += to.ratio * per_unused;
        }
        if per_bend > 0.0 {
            share += bend(from, to, own_s) * per_bend;
        }
        to.ratio = share;
    });
    let mut from = 0_usize;
    // Shares of the segments before `from`.
    let mut before = 0.0;
    for index in 1..count {
        let wanted = index_as_f64(index);
        let mut place = None;
        let ends =
            |from: usize| (from.saturating_add(1) < planned).then(|| from..from.saturating_add(2));
        while let Some(pair) = ends(from).and_then(|range| knots.get(range)) {
            let share = pair.last().map_or(0.0, |to| to.ratio);
            if before + share >= wanted {
                place = Some(within(pair, (wanted - before) / share));
                break;
            }
            (before, from) = (before + share, from.saturating_add(1));
        }
        if let (Some(place), Some(knot)) = (place, knots.get_mut(index)) {
            (knot.moved_s, knot.wanted) = place;
        }
    }
    let end = planned.checked_sub(1).and_then(|last| knots.get(last));
    let end_speed = end.map_or(0.0, |end| end.speed);
    if let [first, .., last] = knots {
        (first.wanted, last.wanted) = (first.speed, end_speed);
    }
    most_lost_s * own / time_s
}

/// Both knots of each segment, of the first `planned` knots.
fn each_segment<A: Axes>(
    knots: &mut [Knot<A>],
    planned: usize,
    mut visit: impl FnMut(&Knot<A>, &mut Knot<A>),
) {
    let mut ends = knots.iter_mut().take(planned);
    let Some(mut from) = ends.next() else { return };
    for to in ends {
        visit(from, to);
        from = to;
    }
}

fn index_as_f64(index: usize) -> f64 {
    u32::try_from(index).map_or(f64::INFINITY, f64::from)
}

/// √(a) T of a segment, by its change of speed a T.
fn bend<A: Axes>(from: &Knot<A>, to: &Knot<A>, time_s: f64) -> f64 {
    sqrt((to.speed - from.speed).abs() * time_s)
}

/// Parameter and speed at a fraction of a segment's time.
fn within<A: Axes>(pair: &[Knot<A>], fraction: f64) -> (f64, f64) {
    let [from, to] = pair else { return (0.0, 0.0) };
    let rise = (to.speed - from.speed) * fraction * 0.5;
    let mean = (from.speed + to.speed) * 0.5;
    let length = to.s - from.next_start();
    let s = to.s - length * (1.0 - fraction * (from.speed + rise) / mean);
    (s, from.speed + rise + rise)
}

/// Where a knot stands on a leg, as a fraction: dense at an end where the machine is slow, for there
/// the speed changes most from knot to knot, and with it the cubic's departure from the path. How
/// evenly they stand at both ends is from 0, where it stops, to 1.
pub(crate) fn fraction(u: f64, [start, end]: [f64; 2]) -> f64 {
    let rest = 1.0 - u;
    let slopes = [start * (1.5 - 0.5 * end), end * (1.5 - 0.5 * start)];
    u * u * (3.0 - 2.0 * u) + u * rest * (slopes[0] * rest - slopes[1] * u)
}

/// Leaves every second knot of each leg and all at which legs meet.
#[derive(Debug, Default)]
pub(crate) struct Halving {
    /// The parameter at which the segment begins that ends at the next knot that stays.
    start: f64,
    is_left_out: bool,
}

impl Halving {
    /// The next knot, if it stays.
    pub(crate) fn keep<A: Axes>(&mut self, knot: &Knot<A>) -> Option<Knot<A>> {
        self.is_left_out = knot.ds > 0.0 && !knot.ends_leg && !self.is_left_out;
        if self.is_left_out {
            return None;
        }
        let mut knot = *knot;
        if knot.ds > 0.0 {
            knot.ds = knot.s - self.start;
        }
        self.start = knot.next_start();
        Some(knot)
    }
}

/// Leaves half of the knots at the beginning of those given. How many they are.
pub(crate) fn halve<A: Axes>(knots: &mut [Knot<A>]) -> usize {
    let (mut halving, mut used) = (Halving::default(), 0_usize);
    for index in 0..knots.len() {
        let kept = knots.get(index).and_then(|knot| halving.keep(knot));
        if let (Some(kept), Some(slot)) = (kept, knots.get_mut(used)) {
            (*slot, used) = (kept, used.saturating_add(1));
        }
    }
    used
}
