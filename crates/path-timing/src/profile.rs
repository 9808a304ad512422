//! The fastest speeds along one leg, from rest to rest.

use crate::leg::Leg;
use crate::number::LARGEST;
use crate::segment::{Reciprocals, Segment};
use crate::{Knot, Path, PlanError};

/// Fills the knots of a leg, one more than segments, with the fastest motion.
pub(crate) fn fastest<P: Path>(
    limits: &Reciprocals<P::Axes>,
    leg: &Leg<P>,
    knots: &mut [Knot],
) -> Result<(), PlanError<P::Error>> {
    spread(knots);
    backward(limits, leg, knots)?;
    forward(limits, leg, knots)
}

/// Spreads the knots as u² (3 - 2u), dense where the leg starts and stops: there the speed
/// changes most from knot to knot, and with it the cubic's departure from the path.
fn spread(knots: &mut [Knot]) {
    let segments = u32::try_from(knots.len().saturating_sub(1)).unwrap_or(u32::MAX);
    for (index, knot) in (0..=segments).zip(knots) {
        *knot = Knot {
            s: share(index, segments),
            ..Knot::default()
        };
    }
}

/// Where a knot stands, as a share of the leg.
fn share(index: u32, segments: u32) -> f64 {
    let u = f64::from(index) / f64::from(segments);
    u * u * (3.0 - 2.0 * u)
}

/// From the end at rest: the highest speed at each knot from which the rest can be run, and the
/// speed after it that goes with it.
fn backward<P: Path>(
    limits: &Reciprocals<P::Axes>,
    leg: &Leg<P>,
    knots: &mut [Knot],
) -> Result<(), PlanError<P::Error>> {
    let mut before = knots.iter_mut().rev();
    let Some(mut to) = before.next() else {
        return Ok(());
    };
    let mut end = leg.checked_place(to.s)?;
    for from in before {
        let start = leg.checked_place(from.s)?;
        let way = to.s - from.s;
        let segment = Segment::new(limits, &start, &end, way).with_tool(leg.tool(), way);
        (from.speed, from.after) = segment.begin(to.speed, LARGEST);
        (to, end) = (from, start);
    }
    Ok(())
}

/// From the start at rest: as fast as each segment and what is left allow.
fn forward<P: Path>(
    limits: &Reciprocals<P::Axes>,
    leg: &Leg<P>,
    knots: &mut [Knot],
) -> Result<(), PlanError<P::Error>> {
    let mut rest = knots.iter_mut();
    let Some(mut from) = rest.next() else {
        return Ok(());
    };
    let mut start = leg.checked_place(from.s)?;
    let mut ratio = from.after / from.speed;
    from.speed = 0.0;
    for to in rest {
        let end = leg.checked_place(to.s)?;
        let way = to.s - from.s;
        let segment = Segment::new(limits, &start, &end, way).with_tool(leg.tool(), way);
        let next_ratio = to.after / to.speed;
        // What holds for the highest speed here holds slower at the same ratio.
        to.speed = segment.end(from.speed, to.speed, from.speed * ratio);
        from.duration_s = 2.0 * way / (from.speed + to.speed);
        (from, start, ratio) = (to, end, next_ratio);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::share;
    use crate::planner::MAX_SEGMENTS;

    #[test]
    fn knots_of_the_finest_leg_are_apart() {
        for segments in [MAX_SEGMENTS, MAX_SEGMENTS - 1, MAX_SEGMENTS - 12_345, 1000] {
            let mut ends = (0..500).chain(segments - 500..segments);
            assert!(ends.all(|index| share(index, segments) < share(index + 1, segments)));
            assert!((share(segments, segments) - 1.0).abs() < f64::MIN_POSITIVE);
        }
    }
}
