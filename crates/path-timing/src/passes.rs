//! The fastest speeds at the knots of a path without a limit of jerk.
//!
//! Goal: at each knot the speed of the parameter, so that every cubic between two knots keeps all
//! limits and the whole takes little time. Method: from the end to the start the highest speed from
//! which the rest can be run, with a speed after it that goes with it; then from the start as fast
//! as each segment and what is left allow. Where a pair of speeds keeps the limits, each slower
//! pair of the same ratio does, so the forward pass always finds one.

use crate::knot::{SegmentTool, ToolTimes};
use crate::number::{LARGEST, Real, cube_root, sqrt};
use crate::reciprocals::{Reciprocals, margin};
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
            let segment = Segment::new(limits, from, to, ToolTimes::ONE);
            let (w0, w1) = segment.begin(R::of(to.speed), R::at_most(from.cap));
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
            let segment = Segment::new(limits, from, to, ToolTimes::ONE);
            let [w0, ceiling, ratio] = [from.speed, to.speed, from.ratio].map(R::of);
            // A speed times a ratio is rounded, in single precision by more than a motor may jump.
            segment.end(w0, ceiling, ratio).min(ceiling).into()
        } else {
            from.speed
        };
        from = to;
    }
}

/// The highest speed with which a segment is passed evenly: with no more than the acceleration that
/// its bend asks of the axes.
///
/// ```text
/// w² |Δp| / Δs ≤ a
/// ```
pub(crate) fn evenly<A: Axes, R: Real>(
    limits: &Reciprocals<A, R>,
    [from, to]: [&Knot<A>; 2],
) -> f64 {
    let slopes = (from.point.slope.as_slice().iter()).zip(to.point.slope.as_slice());
    let bends = (limits.axes().iter().zip(slopes)).map(|(limit, (p0, p1))| {
        let acceleration: f64 = limit.acceleration.into();
        (p1 - p0).abs() * acceleration
    });
    sqrt(to.ds / bends.fold(0.0, f64::max))
}

/// The time of the segment between two knots: its speed is linear in time.
pub(crate) fn segment_s<A: Axes>(from: &Knot<A>, to: &Knot<A>) -> f64 {
    time_of(to.ds, [from.speed, to.speed])
}

/// The time of a length between two speeds; none where only velocities jump.
pub(crate) fn time_of(ds: f64, [w0, w1]: [f64; 2]) -> f64 {
    if ds > 0.0 { 2.0 * ds / (w0 + w1) } else { 0.0 }
}

/// The shortest time of a segment that starts and ends at rest.
///
/// ```text
/// speed 3Δq / 2T   acceleration 6Δq / T²   jerk 12Δq / T³
/// ```
pub(crate) fn rest_to_rest_s<A: Axes>(
    limits: &Reciprocals<A>,
    [from, to]: [&Knot<A>; 2],
    tool: &SegmentTool,
) -> f64 {
    let [starts, ends] = [from, to].map(|knot| knot.point.position.as_slice());
    let distances = starts.iter().zip(ends).map(|(q0, q1)| (q1 - q0).abs());
    let of_axes = (limits.axes().iter().zip(distances)).map(|(limits, distance)| {
        [limits.speed, limits.acceleration, limits.jerk].map(|limit| distance * limit)
    });
    let ds = margin::<f64>() * to.ds;
    let of_tool = [ds / tool.feed, ds / tool.acceleration, 0.0];
    of_axes
        .chain([of_tool])
        .fold(0.0, |time_s: f64, [speed, acceleration, jerk]| {
            time_s
                .max(1.5 * speed)
                .max(sqrt(6.0 * acceleration))
                .max(cube_root(12.0 * jerk))
        })
}

/// The time of the way between two knots, with their speeds, if the speed could change on it at
/// will: as fast as the mean slopes of the axes, the path's bend and the tool allow.
///
/// ```text
/// w² = a Δs + (w₀² + w₁²) / 2    T = (2w - w₀ - w₁) / a + what is left at the highest speed
/// ```
pub(crate) fn up_and_down_s<A: Axes>(limits: &Reciprocals<A>, [from, to]: [&Knot<A>; 2]) -> f64 {
    let (ds, [w0, w1]) = (to.ds, [from.speed, to.speed]);
    let positions = (from.point.position.as_slice().iter()).zip(to.point.position.as_slice());
    let axes = limits.axes().iter().zip(positions);
    let uses = axes.map(|(limits, (q0, q1))| {
        let slope = (q1 - q0).abs() / ds;
        [slope * limits.speed, slope * limits.acceleration]
    });
    let of_tool = [1.0 / to.tool.feed, 1.0 / to.tool.acceleration];
    let [slowness, inertia] = (uses.chain([of_tool])).fold([0.0; 2], |[v, a]: [f64; 2], own| {
        [v.max(own[0]), a.max(own[1])]
    });
    let even = evenly(limits, [from, to]).min(1.0 / slowness);
    let highest = even.max(w0).max(w1);
    let top = sqrt(ds / inertia + 0.5 * (w0 * w0 + w1 * w1)).min(highest);
    let [up, down] = [w0, w1].map(|w| top - w);
    let changing = 0.5 * inertia * (up * (top + w0) + down * (top + w1));
    inertia * (up + down) + (ds - changing).max(0.0) / top
}
