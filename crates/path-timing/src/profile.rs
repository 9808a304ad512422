//! The fastest speeds along legs, from stop to stop.

use core::{iter, mem};

use crate::chain::Chain;
use crate::leg::Leg;
use crate::number::LARGEST;
use crate::planner::segments_of;
use crate::reciprocals::Reciprocals;
use crate::segment::Segment;
use crate::{Knot, Legs, Path, PlanError};

/// Fills the knots of a leg, one more than segments, with the fastest motion from rest to rest.
pub(crate) fn fastest<P: Path>(
    limits: &Reciprocals<P::Axes>,
    leg: &Leg<P>,
    knots: &mut [Knot],
) -> Result<(), PlanError<P::Error>> {
    spread(knots, leg.length(), [true; 2]);
    backward(limits, leg, knots, 0.0, uncapped)?;
    forward(limits, leg, knots, 0.0)?;
    times(knots);
    Ok(())
}

/// Gives the knots of all legs, spread already, the speeds and times of the fastest motion.
pub(crate) fn fastest_of_all<L: Legs>(
    limits: &Reciprocals<L::Axes>,
    legs: &Chain<L>,
    knots: &mut [Knot],
) -> Result<(), PlanError<L::Error>> {
    fastest_speeds(limits, legs, knots, uncapped)?;
    times(knots);
    Ok(())
}

/// The speeds of the fastest motion that is at no knot faster than its cap.
pub(crate) fn fastest_speeds<L: Legs>(
    limits: &Reciprocals<L::Axes>,
    legs: &Chain<L>,
    knots: &mut [Knot],
    cap: impl Fn(&Knot) -> f64,
) -> Result<(), PlanError<L::Error>> {
    let (mut earlier, mut speed) = (&mut *knots, 0.0);
    for leg in legs.backward(limits) {
        let leg = leg?;
        let (rest, own) = split(earlier, last_leg(earlier));
        speed = backward(limits, &leg, own, leg.joint().speed().min(speed), &cap)?;
        earlier = rest;
    }
    let mut speed = 0.0;
    for (leg, own) in legs.forward(limits).zip(by_leg(knots)) {
        speed = forward(limits, &leg?, own, speed)?;
    }
    Ok(())
}

/// Gives each knot the time of its segment from the speeds at its ends.
fn times(knots: &mut [Knot]) {
    let mut rest = knots.iter_mut();
    let Some(mut from) = rest.next() else {
        return;
    };
    for to in rest {
        if to.s > 0.0 {
            from.duration_s = segment_s(from, to);
        }
        from = to;
    }
}

/// The time of a segment on which the speed changes evenly.
pub(crate) fn segment_s(from: &Knot, to: &Knot) -> f64 {
    2.0 * (to.s - from.s) / (from.speed + to.speed)
}

/// No highest speed at a knot but what the limits ask for.
pub(crate) const fn uncapped(_: &Knot) -> f64 {
    LARGEST
}

/// Both parts of the knots; the second has none where there are fewer.
pub(crate) fn split(knots: &mut [Knot], at: usize) -> (&mut [Knot], &mut [Knot]) {
    let at = at.min(knots.len());
    knots.split_at_mut(at)
}

/// Where the knots of the last leg begin.
pub(crate) fn last_leg(knots: &[Knot]) -> usize {
    let first = knots.iter().rposition(|knot| knot.s <= 0.0);
    first.unwrap_or(0)
}

/// Where the knots of the first leg end.
pub(crate) fn first_leg(knots: &[Knot]) -> usize {
    let mut starts = knots.iter().enumerate().skip(1);
    let next = starts.find(|(_, knot)| knot.s <= 0.0);
    next.map_or(knots.len(), |(index, _)| index)
}

/// The knots of each leg, in their order.
pub(crate) fn by_leg(mut knots: &mut [Knot]) -> impl Iterator<Item = &mut [Knot]> {
    iter::from_fn(move || {
        let at = first_leg(knots);
        let (own, later) = split(mem::take(&mut knots), at);
        knots = later;
        (!own.is_empty()).then_some(own)
    })
}

/// Spreads the knots over a length, dense at an end where the machine rests: there the speed
/// changes most from knot to knot, and with it the cubic's departure from the path.
pub(crate) fn spread(knots: &mut [Knot], length: f64, rests: [bool; 2]) {
    let segments = f64::from(segments_of(knots));
    for (index, knot) in (0_u32..).zip(knots) {
        *knot = Knot {
            s: length * fraction(f64::from(index) / segments, rests),
            ..Knot::default()
        };
    }
}

/// Where a knot stands, as a fraction of the leg.
pub(crate) fn fraction(u: f64, rests: [bool; 2]) -> f64 {
    let from_rest = |u: f64| u * u * (3.0 - u) * 0.5;
    match rests {
        [true, true] => u * u * (3.0 - 2.0 * u),
        [true, false] => from_rest(u),
        [false, true] => 1.0 - from_rest(1.0 - u),
        [false, false] => u,
    }
}

/// From the last knot, passed at `speed`: the highest speed at each, up to its cap, from which the
/// rest can be run, and the speed after it that goes with it. The speed at the first knot.
fn backward<P: Path>(
    limits: &Reciprocals<P::Axes>,
    leg: &Leg<P>,
    knots: &mut [Knot],
    speed: f64,
    cap: impl Fn(&Knot) -> f64,
) -> Result<f64, PlanError<P::Error>> {
    let mut before = knots.iter_mut().rev();
    let Some(mut to) = before.next() else {
        return Ok(speed);
    };
    to.speed = speed;
    let mut end = leg.checked_point(to.s)?;
    for from in before {
        let start = leg.checked_point(from.s)?;
        let ds = to.s - from.s;
        let segment = Segment::new(limits, &start, &end, ds).with_tool(leg.tool(), ds);
        (from.speed, from.after) = segment.begin(to.speed, cap(from));
        (to, end) = (from, start);
    }
    Ok(to.speed)
}

/// From the first knot, passed at `speed`: as fast as each segment and what is left allow.
/// The speed at the last knot.
fn forward<P: Path>(
    limits: &Reciprocals<P::Axes>,
    leg: &Leg<P>,
    knots: &mut [Knot],
    speed: f64,
) -> Result<f64, PlanError<P::Error>> {
    let mut rest = knots.iter_mut();
    let Some(mut from) = rest.next() else {
        return Ok(speed);
    };
    let mut start = leg.checked_point(from.s)?;
    let mut ratio = from.after / from.speed;
    from.speed = speed;
    for to in rest {
        let end = leg.checked_point(to.s)?;
        let ds = to.s - from.s;
        let segment = Segment::new(limits, &start, &end, ds).with_tool(leg.tool(), ds);
        let next_ratio = to.after / to.speed;
        // What holds for the highest speed here holds slower at the same ratio.
        to.speed = segment.end(from.speed, to.speed, from.speed * ratio);
        (from, start, ratio) = (to, end, next_ratio);
    }
    Ok(from.speed)
}

#[cfg(test)]
mod tests {
    use super::fraction;
    use crate::planner::MAX_SEGMENTS;

    #[test]
    fn knots_of_the_finest_leg_are_apart() {
        let ends = [[true, true], [true, false], [false, true], [false, false]];
        for (segments, rests) in [MAX_SEGMENTS, MAX_SEGMENTS - 1, MAX_SEGMENTS - 12_345, 1000]
            .into_iter()
            .flat_map(|segments| ends.map(|rests| (segments, rests)))
        {
            let at = |index| fraction(f64::from(index) / f64::from(segments), rests);
            let mut ends = (0..500).chain(segments - 500..segments);
            assert!(ends.all(|index| at(index) < at(index + 1)), "{rests:?}");
            assert!(at(0).to_bits() == 0 && (at(segments) - 1.0).abs() < f64::MIN_POSITIVE);
        }
    }
}
