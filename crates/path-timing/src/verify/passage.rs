//! How a row passes its place on the path.

use super::{ROUNDING, SMOOTH, Violation};
use crate::{Axes, Path, Row};

/// A row on its path.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage<A> {
    /// The speed of the parameter.
    pub(super) speed: f64,
    /// The slopes of all axes.
    pub(super) slope: A,
}

impl<A: Axes> Passage<A> {
    /// If the row has the positions and velocities of the path at the place.
    pub(super) fn of_row<P: Path<Axes = A>>(
        path: &P,
        s: f64,
        row: &Row<A>,
    ) -> Result<Self, Violation<P::Error>> {
        let (leg, time_s) = (row.leg, row.time_s);
        let point = path
            .point(s)
            .map_err(|reason| Violation::Path { leg, s, reason })?;
        let off = |axis, name, by| Violation::OffPath {
            axis,
            name,
            time_s,
            by,
        };
        let positions = row
            .position
            .as_slice()
            .iter()
            .zip(point.position.as_slice());
        for (axis, (is, wanted)) in positions.enumerate() {
            // Written so that NaN is off.
            let is_there = (is - wanted).abs() <= ROUNDING * (1.0 + wanted.abs());
            if !is_there {
                return Err(off(axis, "position", is - wanted));
            }
        }
        let slope = point.slope;
        let passage = |speed| Self { speed, slope };
        let velocities = || row.velocity.as_slice().iter().zip(point.slope.as_slice());
        let steepest = velocities().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let Some((velocity, slope)) = steepest.filter(|(_, slope)| **slope != 0.0) else {
            return Ok(passage(0.0));
        };
        let speed = velocity / slope;
        for (axis, (is, slope)) in velocities().enumerate() {
            let by = is - slope * speed;
            // A smooth corner has the slope of the path after it: nine digits.
            if by.abs() > SMOOTH * velocity.abs() {
                return Err(off(axis, "velocity", by));
            }
        }
        Ok(passage(speed))
    }
}
