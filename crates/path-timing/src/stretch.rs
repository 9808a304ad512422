//! The stretch of a segment: how much longer it lasts than its length and the speeds at its ends
//! say.
//!
//! Goal: an axis that is at its limit of acceleration is there all along its cubic, not at one end
//! alone. Method: the duration is the one with which the cubic of that axis is a parabola. With the
//! speeds w₀, w₁ of the parameter at its ends, r = (w₁ - w₀)/(w₀ + w₁), and m, p₀, p₁ the mean
//! slope of the axis and those at the ends,
//!
//! ```text
//! T = 2κΔs / (w₀ + w₁)    κ = 2m / (p₀ (1 - r) + p₁ (1 + r))
//! ```
//!
//! It is the same as a parameter that runs κ times as far between the two knots. κ is fixed when
//! knots are laid, by the speeds of a plan before: so all forms in the speeds stay what they are.
//! Without it a plan loses what slopes change by within a segment; with it, the square of that.
//!
//! With a limit of jerk it is the same κ for another reason. A parameter that speeds up evenly has
//! its own jerk in the steps between segments, and on a bend the cubics have that of the path inside,
//! q‴ w³, however short they are, even where the parameter's would make up for it. Parabolas have
//! none, and the steps have all of it.

use crate::number::{larger, smaller};
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot, PathPoint};

/// κ is between this and its inverse: with at most 2.5 lengths of way at the speed of an end no
/// parameter turns back, and departures are known.
const LARGEST: f64 = 1.2;

/// The stretch κ of a segment of a length that is passed at about these speeds.
///
/// Where several axes are near their limits it is that of the least squares, each axis weighed by
/// the fourth power of its utilisation, and with a limit of jerk by the square of its part of that.
pub(crate) fn stretch<A: Axes>(
    limits: &Reciprocals<A>,
    [from, to]: [&PathPoint<A>; 2],
    length: f64,
    [w0, w1]: [f64; 2],
) -> f64 {
    let sum = w0 + w1;
    let rate = sum / (length + length);
    let positions = (from.position.as_slice().iter()).zip(to.position.as_slice());
    let slopes = (from.slope.as_slice().iter()).zip(to.slope.as_slice());
    let (mut own, mut square) = (0.0, 0.0);
    for (limit, ((q0, q1), (p0, p1))) in limits.axes().iter().zip(positions.zip(slopes)) {
        let (v0, v1) = (p0 * w0, p1 * w1);
        let weight = if limits.has_jerk() {
            limit.jerk
        } else {
            let acceleration = (v1 - v0).abs() * rate * limit.acceleration;
            let used = acceleration.max(v0.abs().max(v1.abs()) * limit.speed);
            used * used * limit.acceleration
        };
        let mean = weight * (v0 + v1);
        own += weight * (q1 - q0) * mean;
        square += mean * mean;
    }
    let stretch = sum * own / (length * square);
    // Not a number where nothing moves.
    if stretch > 0.0 {
        stretch.clamp(1.0 / LARGEST, LARGEST)
    } else {
        1.0
    }
}

/// The most that a segment of a stream is stretched by.
const LARGEST_EVENLY: f64 = 1.01;

/// The stretch of a segment of a stream with a limit of jerk, whose speeds are not known: as if they
/// were even, and 1 or more. The more it is, the more a segment that begins or ends at rest departs
/// from its path.
pub(crate) fn stretch_evenly<A: Axes>(
    limits: &Reciprocals<A>,
    ends: [&PathPoint<A>; 2],
    length: f64,
) -> f64 {
    stretch(limits, ends, length, [1.0; 2]).clamp(1.0, LARGEST_EVENLY)
}

/// What that is at most, whatever the limits are: a mean of what each axis asks for is not above all
/// of them.
pub(crate) fn most_evenly<A: Axes>([from, to]: [&PathPoint<A>; 2], length: f64) -> f64 {
    let positions = (from.position.as_slice().iter()).zip(to.position.as_slice());
    let slopes = (from.slope.as_slice().iter()).zip(to.slope.as_slice());
    let asked = positions
        .zip(slopes)
        .map(|((q0, q1), (p0, p1))| 2.0 * (q1 - q0) / ((p0 + p1) * length));
    // Not a number where an axis rests, which asks for nothing.
    let most = asked.fold(1.0, |most, asked| larger(asked, most));
    smaller(most, LARGEST_EVENLY)
}

/// The stretch of a segment that is planned without; 1 with limits of a tool, as laid.
pub(crate) fn stretch_between<A: Axes>(limits: &Reciprocals<A>, [from, to]: [&Knot<A>; 2]) -> f64 {
    if !to.tool.is_none() || to.ds <= 0.0 {
        return 1.0;
    }
    let speeds = [from.speed, to.speed];
    stretch(limits, [&from.point, &to.point], to.ds, speeds)
}

/// What a segment with planned speeds leaves unused of the limits: 0 where an axis is at a limit
/// all along.
///
/// The part of every limit that is left at one end, and the most by which an acceleration changes,
/// 2 from one limit to the other. With the mean velocity v of an axis
///
/// ```text
/// a₀ = (6v - 4v₀ - 2v₁) / T    a₁ = (2v₀ + 4v₁ - 6v) / T
/// ```
pub(crate) fn unused<A: Axes>(
    limits: &Reciprocals<A>,
    [from, to]: [&Knot<A>; 2],
    time_s: f64,
) -> f64 {
    let (rate, w0, w1) = (1.0 / time_s, from.speed, to.speed);
    let positions = (from.point.position.as_slice().iter()).zip(to.point.position.as_slice());
    let slopes = (from.point.slope.as_slice().iter()).zip(to.point.slope.as_slice());
    let (mut used, mut swing) = ([0.0; 2], 0.0);
    for (limit, ((q0, q1), (p0, p1))) in limits.axes().iter().zip(positions.zip(slopes)) {
        let (v0, v1) = (p0 * w0, p1 * w1);
        let thrice = 3.0 * (q1 - q0) * rate;
        let scale = (rate + rate) * limit.acceleration;
        let a0 = (thrice - v0 - v0 - v1) * scale;
        let a1 = (v0 + v1 + v1 - thrice) * scale;
        swing = larger(swing, (a1 - a0).abs());
        let [start, end] = used;
        used = [
            larger(larger(start, a0.abs()), v0.abs() * limit.speed),
            larger(larger(end, a1.abs()), v1.abs() * limit.speed),
        ];
    }
    let [start, end] = used;
    1.0 - start.min(end) + swing
}
