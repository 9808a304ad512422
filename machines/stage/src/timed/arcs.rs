//! Arcs as programmed: ends that are not quite as far from their centre as one another.

use core::f64::consts::PI;

use anyhow::Result;
use kurbo::{Point, Vec2};
use path_timing::Curve;
use pulse_interp::Turn;

use crate::motion::{Motion, Shape};

/// The arc of a motion from a point, within rounding of the programmed start: in two where it is
/// more than half a turn, none where it has no length.
///
/// Programs round both ends. Each part is of the circle through its ends whose centre is nearest to
/// the programmed one: the middle of a long arc is half as far out as both ends together.
///
/// # Errors
/// A number that is too large to compute with.
pub(super) fn curves(from: Point, motion: &Motion) -> Result<Vec<Curve<2>>> {
    let Shape::Arc {
        centre,
        turn,
        sweep_rad,
    } = motion.shape
    else {
        return Ok(Vec::new());
    };
    let to = motion.to;
    let mut ends = vec![to];
    if sweep_rad > PI {
        let radius = (from.distance(centre) + to.distance(centre)) / 2.0;
        let sense = match turn {
            Turn::CounterClockwise => 0.5,
            Turn::Clockwise => -0.5,
        };
        let middle = (from - centre).atan2() + sense * sweep_rad;
        ends.insert(0, centre + Vec2::from_angle(middle) * radius);
    }
    let mut start = from;
    let mut curves = Vec::new();
    for end in ends {
        if let Some(curve) = through(start, end, centre, turn)? {
            let [x, y] = curve.end();
            start = Point::new(x, y);
            curves.push(curve);
        }
    }
    Ok(curves)
}

/// The arc of half a turn at most between two points, with its centre on the line that is as far
/// from both.
fn through(from: Point, to: Point, centre: Point, turn: Turn) -> Result<Option<Curve<2>>> {
    /// What rounding leaves of a length, in mm: a ten-thousandth of a step.
    const NOTHING_MM: f64 = 1e-6;
    let chord = to - from;
    let half = chord.hypot() / 2.0;
    if half < NOTHING_MM {
        return Ok(None);
    }
    let along = chord / (2.0 * half);
    // To the side on which the arc is.
    let out = match turn {
        Turn::CounterClockwise => Vec2::new(along.y, -along.x),
        Turn::Clockwise => Vec2::new(-along.y, along.x),
    };
    let middle = from.midpoint(to);
    let depth = (middle - centre).dot(out);
    let centre = middle - out * depth;
    let angle = 2.0 * half.atan2(depth);
    let direction = match turn {
        Turn::CounterClockwise => Vec2::new(centre.y - from.y, from.x - centre.x),
        Turn::Clockwise => Vec2::new(from.y - centre.y, centre.x - from.x),
    };
    let [from, centre] = [from, centre].map(|at| [at.x, at.y]);
    Ok(Some(Curve::arc(
        from,
        centre,
        [direction.x, direction.y],
        angle,
    )?))
}
