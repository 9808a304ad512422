//! Speeds along one leg, from rest to rest.

use core::cell::Cell;

use nalgebra::RealField;

use super::Knot;
use super::scurve::SCurve;
use super::segment::{Reciprocals, Segment};
use crate::Locator;
use crate::course::{Course, Place};
use crate::number::{cube_root, larger, largest, magnitude, two};
use crate::turn::count;

/// Fills the knots of a leg, one more than parts, with the fastest motion.
pub(super) fn fastest<const N: usize, T: RealField + Copy>(
    locators: &[Locator<T>; N],
    course: &Course<'_, N, T>,
    knots: &mut [Knot<T>],
    parts: u32,
) {
    spread(knots, parts);
    let knots = Cell::from_mut(knots).as_slice_of_cells();
    let limits = Reciprocals::new(locators);
    backward(&limits, course, knots);
    forward(&limits, course, knots);
}

/// Fills the knots of a leg, one more than parts, with an S-curve.
pub(super) fn smooth<const N: usize, T: RealField + Copy>(
    locators: &[Locator<T>; N],
    course: &Course<'_, N, T>,
    knots: &mut [Knot<T>],
    parts: u32,
) {
    let curve = s_curve(locators, course);
    let mut rest = knots.iter_mut();
    curve.knots(parts, |motion, segment_s| {
        if let Some(knot) = rest.next() {
            *knot = Knot {
                s: motion.way,
                speed: motion.speed,
                segment_s,
                parts,
            };
        }
    });
}

/// Spreads the knots as u² (3 - 2u), dense where the leg starts and stops: there the speed
/// changes most from knot to knot, and with it the strain.
fn spread<T: RealField + Copy>(knots: &mut [Knot<T>], parts: u32) {
    let whole = count::<T>(parts);
    for (index, knot) in (0..=parts).zip(knots) {
        let share = count::<T>(index) / whole;
        let s = share * share * (two::<T>() + T::one() - two::<T>() * share);
        *knot = Knot {
            s,
            speed: T::zero(),
            segment_s: T::zero(),
            parts,
        };
    }
}

/// From the end: the highest speed at each knot from which the rest can be run, in `speed`, and
/// the speed after it as a share, in `segment_s`.
fn backward<const N: usize, T: RealField + Copy>(
    limits: &Reciprocals<N, T>,
    course: &Course<'_, N, T>,
    knots: &[Cell<Knot<T>>],
) {
    let mut to: Option<Place<N, T>> = None;
    for pair in knots.windows(2).rev() {
        let [from_knot, to_knot] = pair else { continue };
        let (mut knot, next) = (from_knot.get(), to_knot.get());
        let from = course.place(knot.s);
        let end = to.unwrap_or_else(|| course.place(next.s));
        let segment = Segment::new(limits, &from, &end, next.s - knot.s);
        let (speed, after) = segment.begin(next.speed, largest());
        knot.speed = speed;
        knot.segment_s = after / speed;
        from_knot.set(knot);
        to = Some(from);
    }
}

/// From the start at rest: as fast as each segment and what is left allow.
fn forward<const N: usize, T: RealField + Copy>(
    limits: &Reciprocals<N, T>,
    course: &Course<'_, N, T>,
    knots: &[Cell<Knot<T>>],
) {
    let mut speed = T::zero();
    let mut from: Option<Place<N, T>> = None;
    for pair in knots.windows(2) {
        let [from_knot, to_knot] = pair else { continue };
        let (mut knot, mut next) = (from_knot.get(), to_knot.get());
        let start = from.unwrap_or_else(|| course.place(knot.s));
        let to = course.place(next.s);
        let way = next.s - knot.s;
        let segment = Segment::new(limits, &start, &to, way);
        let after = segment.end(speed, next.speed, speed * knot.segment_s);
        knot.speed = speed;
        knot.segment_s = two::<T>() * way / (speed + after);
        from_knot.set(knot);
        next.speed = after;
        to_knot.set(next);
        speed = after;
        from = Some(to);
    }
}

/// Places at which the slopes of a leg are looked at for its S-curve.
const SAMPLES: u32 = 64;

/// An S-curve whose limits keep those of the axes all along the leg.
///
/// ```text
/// q̇ = q' ṡ   q̈ = q″ ṡ² + q' s̈   q⃛ = q‴ ṡ³ + 3 q″ ṡ s̈ + q' s⃛
/// ```
///
/// The speed is taken so that q″ ṡ² uses at most half of the acceleration and q‴ ṡ³ a third
/// of the jerk, the acceleration so that its product uses at most another third; what is
/// left over is used. On a straight way q″ = q‴ = 0, and this is the shortest motion.
fn s_curve<const N: usize, T: RealField + Copy>(
    locators: &[Locator<T>; N],
    course: &Course<'_, N, T>,
) -> SCurve<T> {
    let constant = |value: f64| nalgebra::convert::<f64, T>(value);
    let derivatives = derivatives(course);
    let all = || {
        let limits = locators.iter().flat_map(|locator| &locator.limits);
        limits.zip(derivatives.iter().flatten())
    };
    let most = largest::<T>();
    let speed = all().fold(most, |speed, (limits, [p1, p2, p3])| {
        let jerk = limits.jerk.unwrap_or(most);
        speed
            .min(limits.speed / *p1)
            .min((limits.acceleration / (two::<T>() * *p2)).sqrt())
            .min(cube_root(jerk / (constant(3.0) * *p3)))
    });
    let acceleration = all().fold(most, |acceleration, (limits, [p1, p2, _])| {
        let jerk = limits.jerk.unwrap_or(most);
        acceleration
            .min((limits.acceleration - *p2 * speed * speed) / *p1)
            .min(jerk / (constant(9.0) * *p2 * speed))
    });
    // Without an axis that limits it: a thousandth of the time that the way takes.
    let jerk = acceleration * acceleration.sqrt() * constant(1e3);
    let jerk = all().fold(jerk, |least, (limits, [p1, p2, p3])| match limits.jerk {
        Some(jerk) => {
            let used = *p3 * speed * speed * speed + constant(3.0) * *p2 * speed * acceleration;
            least.min((jerk - used) / *p1)
        }
        None => least,
    });
    SCurve::new(speed, acceleration, jerk)
}

/// The largest |q'|, |q″| and |q‴| of each axis, the latter two by differences; at least a
/// number that can be divided by.
fn derivatives<const N: usize, T: RealField + Copy>(course: &Course<'_, N, T>) -> [[[T; 3]; 3]; N] {
    let samples = count::<T>(SAMPLES);
    let mut most = [[[T::one() / largest(); 3]; 3]; N];
    for index in 0..SAMPLES - 1 {
        let slope = |next: u32| course.place(count::<T>(index + next) / samples).slope;
        let (first, second, third) = (slope(0), slope(1), slope(2));
        let values = first.iter().zip(second.iter().zip(&third));
        for (most, (first, (second, third))) in most.iter_mut().zip(values) {
            let values = first.iter().zip(second.iter().zip(third.iter()));
            for ([p1, p2, p3], (first, (second, third))) in most.iter_mut().zip(values) {
                let changes = [*second - *first, *third - *second].map(|change| change * samples);
                for slope in [*first, *second, *third] {
                    *p1 = larger(*p1, magnitude(slope));
                }
                for change in changes {
                    *p2 = larger(*p2, magnitude(change));
                }
                let [before, after] = changes;
                *p3 = larger(*p3, magnitude((after - before) * samples));
            }
        }
    }
    most
}
