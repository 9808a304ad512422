//! The fastest speeds at the knots of a path without a limit of jerk.
//!
//! Goal: at each knot the speed of the parameter, so that every cubic between two knots keeps all
//! limits and the whole takes little time. Method: from the end to the start the highest speed from
//! which the rest can be run, with a speed after it that goes with it; then from the start as fast as
//! each segment and what is left allow. Where a pair of speeds keeps the limits, each slower pair of
//! the same ratio does, so the forward pass always finds one.

use crate::number::{LARGEST, Real};
use crate::reciprocals::Reciprocals;
use crate::segment::Segment;
use crate::{Axes, Knot};

/// Gives the knots the speeds of the fastest motion with which no knot passes its cap: from rest to
/// rest where the first and the last have a cap of 0.
pub(crate) fn fastest<A: Axes, R: Real>(limits: &Reciprocals<A, R>, knots: &mut [Knot<A>]) {
    backward(limits, knots);
    forward(limits, knots);
}

/// From the last knot: the highest speed at each from which the rest can be run.
fn backward<A: Axes, R: Real>(limits: &Reciprocals<A, R>, knots: &mut [Knot<A>]) {
    let mut earlier = knots.iter_mut().rev();
    let Some(mut to) = earlier.next() else {
        return;
    };
    to.speed = to.cap.min(LARGEST);
    for from in earlier {
        if to.ds > 0.0 {
            let segment = Segment::new(limits, from, to, 1.0);
            let (w0, w1) = segment.begin(R::of(to.speed), R::of(from.cap));
            let ratio = if w0 > R::ZERO { w1 / w0 } else { R::ZERO };
            (from.speed, from.ratio) = (w0.into(), ratio.into());
        } else {
            (from.speed, from.ratio) = (to.speed.min(from.cap), 1.0);
        }
        to = from;
    }
}

/// From the first knot: as fast as each segment and what is left allow.
fn forward<A: Axes, R: Real>(limits: &Reciprocals<A, R>, knots: &mut [Knot<A>]) {
    let mut rest = knots.iter_mut();
    let Some(mut from) = rest.next() else {
        return;
    };
    for to in rest {
        to.speed = if to.ds > 0.0 {
            let segment = Segment::new(limits, from, to, 1.0);
            let [w0, ceiling, ratio] = [from.speed, to.speed, from.ratio].map(R::of);
            segment.end(w0, ceiling, ratio).into()
        } else {
            from.speed
        };
        from = to;
    }
}

/// The time of the segment between two knots: its speed is linear in time.
pub(crate) fn segment_s<A: Axes>(from: &Knot<A>, to: &Knot<A>) -> f64 {
    time_of(to.ds, [from.speed, to.speed])
}

/// The time of a length between two speeds; none where only velocities jump.
pub(crate) fn time_of(ds: f64, [w0, w1]: [f64; 2]) -> f64 {
    if ds > 0.0 { 2.0 * ds / (w0 + w1) } else { 0.0 }
}
