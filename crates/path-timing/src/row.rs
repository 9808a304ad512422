//! Rows of a table: what a controller gets.

use crate::Axes;

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
    /// The leg that the row ends or lies on, from 0: which path of all.
    pub leg: usize,
    /// The parameter of that leg.
    pub s: f64,
}

impl<A: Axes> Default for Row<A> {
    fn default() -> Self {
        Self {
            time_s: 0.0,
            duration_s: 0.0,
            position: A::zeros(),
            velocity: A::zeros(),
            leg: 0,
            s: 0.0,
        }
    }
}

impl<A: Axes> Row<A> {
    /// Whether every axis stands still.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.velocity.as_slice().iter().all(|speed| *speed == 0.0)
    }
}
