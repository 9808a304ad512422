//! Rows of a table: what a controller gets.

use crate::{Axes, PathPoint};

/// A row of a position-velocity-time table. From one to the next every axis runs the
/// [`Cubic`](crate::Cubic) with these positions and velocities at its ends.
///
/// Where the velocities jump at a corner ([`Corner::Jump`](crate::Corner::Jump)), two rows have the
/// same time and positions: the first has the velocities before, the second those after.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "the columns of every such table")]
pub struct Row<A> {
    /// Seconds since the start.
    pub time_s: f64,
    /// Seconds since the row before; 0 in the first, and in the second of a corner.
    pub duration_s: f64,
    /// Position of each axis.
    pub position: A,
    /// Velocity of each axis, per second.
    pub velocity: A,
}

impl<A: Axes> Row<A> {
    /// The same time and positions with the velocities after a corner.
    pub(crate) fn with_jump(&self, velocity: A) -> Self {
        Self {
            duration_s: 0.0,
            velocity,
            ..*self
        }
    }

    /// A point that is passed at a speed of the parameter.
    pub(crate) fn new(point: &PathPoint<A>, speed: f64, time_s: f64, duration_s: f64) -> Self {
        Self {
            time_s,
            duration_s,
            position: point.position,
            velocity: point.slope.scaled(speed),
        }
    }
}
