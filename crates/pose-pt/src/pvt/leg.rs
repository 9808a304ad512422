//! Speeds along one leg, from rest to rest.

use core::cell::Cell;

use super::segment::{Reciprocals, Segment};
use super::track::Track;
use super::{Knot, knots_of};
use crate::Locator;
use crate::course::Place;
use crate::number::largest;

/// Fills the first knots, one more than parts, with the fastest motion.
pub(super) fn fastest<const N: usize>(
    locators: &[Locator; N],
    track: &Track<'_, N>,
    knots: &mut [Knot],
    parts: u32,
) {
    let knots = knots.get_mut(..knots_of(parts)).unwrap_or_default();
    spread(knots, parts);
    let knots = Cell::from_mut(knots).as_slice_of_cells();
    let limits = Reciprocals::new(locators);
    backward(&limits, track, knots);
    forward(&limits, track, knots);
}

/// Spreads the knots as u² (3 - 2u), dense where the leg starts and stops: there the speed
/// changes most from knot to knot, and with it the strain.
fn spread(knots: &mut [Knot], parts: u32) {
    for (index, knot) in (0..=parts).zip(knots) {
        *knot = Knot {
            s: place(index, parts),
            speed: 0.0,
            segment_s: 0.0,
            parts,
        };
    }
}

/// The parameter of a knot.
fn place(index: u32, parts: u32) -> f64 {
    let share = f64::from(index) / f64::from(parts);
    share * share * (3.0 - 2.0 * share)
}

/// From the end: the highest speed at each knot from which the rest can be run, in `speed`, and
/// the speed after it as a share, in `segment_s`.
fn backward<const N: usize>(limits: &Reciprocals<N>, track: &Track<'_, N>, knots: &[Cell<Knot>]) {
    let mut to: Option<Place<N, f64>> = None;
    for pair in knots.windows(2).rev() {
        let [from_knot, to_knot] = pair else { continue };
        let (mut knot, next) = (from_knot.get(), to_knot.get());
        let from = track.place(knot.s);
        let end = to.unwrap_or_else(|| track.place(next.s));
        let segment = Segment::new(limits, &from, &end, next.s - knot.s);
        let (speed, after) = segment.begin(next.speed, largest());
        knot.speed = speed;
        knot.segment_s = after / speed;
        from_knot.set(knot);
        to = Some(from);
    }
}

/// From the start at rest: as fast as each segment and what is left allow.
fn forward<const N: usize>(limits: &Reciprocals<N>, track: &Track<'_, N>, knots: &[Cell<Knot>]) {
    let mut speed = 0.0;
    let mut from: Option<Place<N, f64>> = None;
    for pair in knots.windows(2) {
        let [from_knot, to_knot] = pair else { continue };
        let (mut knot, mut next) = (from_knot.get(), to_knot.get());
        let start = from.unwrap_or_else(|| track.place(knot.s));
        let to = track.place(next.s);
        let way = next.s - knot.s;
        let segment = Segment::new(limits, &start, &to, way);
        let after = segment.end(speed, next.speed, speed * knot.segment_s);
        knot.speed = speed;
        knot.segment_s = 2.0 * way / (speed + after);
        from_knot.set(knot);
        next.speed = after;
        to_knot.set(next);
        speed = after;
        from = Some(to);
    }
}

#[cfg(test)]
mod tests {
    use super::place;
    use crate::pvt::planner::MAX_PARTS;

    #[test]
    fn knots_of_the_finest_leg_are_apart() {
        for parts in [MAX_PARTS, MAX_PARTS - 1, MAX_PARTS - 12_345, 1000] {
            let mut ends = (0..500).chain(parts - 500..parts);
            assert!(ends.all(|index| place(index, parts) < place(index + 1, parts)));
            assert!((place(parts, parts) - 1.0).abs() < f64::MIN_POSITIVE);
        }
    }
}
