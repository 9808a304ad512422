//! Rows sampled at a fixed cycle: set-points of servo drives.
//!
//! Goal: what a drive takes each cycle over a fieldbus, positions with velocities and accelerations
//! for its feed-forward, and these in the integers of CiA 402. Method: the cubic between two rows
//! at the cycle's times; nothing is interpolated twice.

mod cia402;

use crate::{Axes, Cubic, Row, TryRow};
pub use cia402::{Cia402Scale, Cia402Target, TargetError};

/// All axes at a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "what a drive is told")]
pub struct SetPoint<A> {
    /// Seconds since the first row: a multiple of the cycle.
    pub time_s: f64,
    /// Position of each axis.
    pub position: A,
    /// Velocity of each axis, per second.
    pub velocity: A,
    /// Acceleration of each axis, per second²: for a torque by the machine's
    /// [`Dynamics`](crate::Dynamics).
    pub acceleration: A,
}

/// The set-points of rows, one for each cycle, the first row's included: each exactly on its cubic.
///
/// The last row is met by the first cycle at or after it, at rest. Where the rows end for now, as
/// those of a [`LookAhead`](crate::LookAhead) that is held, the set-points do; they go on with the
/// rows, at the next cycle.
///
/// ```
/// use path_timing::{AxisLimits, Cia402Scale, Curve, Knot, SetPoints, Table};
///
/// let line = Curve::line([0.0, 0.0], [80.0, 60.0])?;
/// let axis = AxisLimits { speed: 300.0, acceleration: 5000.0, jerk: None }; // mm, s
/// let mut knots = [Knot::default(); 41];
/// let table = Table::plan([line], [axis; 2], |_| 40, &mut knots)?;
///
/// // 131072 counts a turn of 10 mm; a rated torque of 1.27 Nm.
/// let scale = Cia402Scale { counts_per_unit: 13_107.2, rated_torque: 1.27 };
/// for point in SetPoints::new(table.rows(), 0.001) {
///     let point = point?;
///     let x = scale.target(point.position[0], point.velocity[0], 0.2)?; // 0.2 Nm by the machine's dynamics
///     assert_eq!(x.torque_offset, 157); // thousandths of the rated torque
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct SetPoints<I, A> {
    rows: I,
    cycle_s: f64,
    /// The last two rows.
    segment: Option<[Row<A>; 2]>,
    /// From the first of them to the next cycle.
    since_s: f64,
    time_s: f64,
}

impl<I: Iterator<Item: TryRow<Axes = A>>, A: Axes> SetPoints<I, A> {
    /// The set-points at each multiple of a cycle in seconds: 0.001 on most fieldbuses. A cycle
    /// that is not above 0 has none.
    #[must_use]
    pub const fn new(rows: I, cycle_s: f64) -> Self {
        Self {
            rows,
            cycle_s,
            segment: None,
            since_s: 0.0,
            time_s: 0.0,
        }
    }

    /// The rows that are sampled: to set the feed of a [`LookAhead`](crate::LookAhead) or a
    /// [`Playback`](crate::Playback), or to stop it.
    pub const fn rows_mut(&mut self) -> &mut I {
        &mut self.rows
    }

    /// The next row, and whether there was one.
    fn go_on(&mut self) -> Result<bool, <I::Item as TryRow>::Error> {
        let Some(row) = self.rows.next() else {
            return Ok(false);
        };
        let row = row.try_row()?;
        self.segment = Some(match self.segment {
            Some([_, from]) => {
                self.since_s -= from.duration_s;
                [from, row]
            }
            // The segment that leads to the first row takes no time.
            None => {
                let first = Row {
                    duration_s: 0.0,
                    ..row
                };
                [first, first]
            }
        });
        Ok(true)
    }

    fn point(&self, [from, to]: &[Row<A>; 2], is_over: bool) -> SetPoint<A> {
        let mut point = SetPoint {
            time_s: self.time_s,
            position: to.position,
            velocity: to.velocity,
            acceleration: A::zeros(),
        };
        if is_over || to.duration_s <= 0.0 {
            return point;
        }
        let fraction = self.since_s / to.duration_s;
        let numbers = (point.position.as_mut_slice().iter_mut())
            .zip(point.velocity.as_mut_slice())
            .zip(point.acceleration.as_mut_slice());
        for (((position, velocity), acceleration), cubic) in numbers.zip(Cubic::between(from, to)) {
            let [a0, a1] = cubic.accelerations();
            *position = cubic.position(fraction);
            *velocity = cubic.velocity(fraction);
            *acceleration = a0 + (a1 - a0) * fraction;
        }
        point
    }
}

impl<I: Iterator<Item: TryRow<Axes = A>>, A: Axes> Iterator for SetPoints<I, A> {
    type Item = Result<SetPoint<A>, <I::Item as TryRow>::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        // Written so that NaN has none.
        let has_cycle = self.cycle_s > 0.0;
        if !has_cycle {
            return None;
        }
        let mut is_over = false;
        // The segment in which the cycle falls, the one after a row at its very time.
        while self
            .segment
            .is_none_or(|[_, to]| self.since_s >= to.duration_s)
        {
            match self.go_on() {
                Ok(true) => {}
                Ok(false) => {
                    is_over = true;
                    break;
                }
                Err(error) => return Some(Err(error)),
            }
        }
        let segment = self.segment?;
        if is_over {
            let [_, to] = &segment;
            // The rest at the end is told once, and a motion that is not at rest has to go on.
            let is_told = self.since_s >= to.duration_s + self.cycle_s;
            if is_told || !to.is_at_rest() {
                return None;
            }
        }
        let point = self.point(&segment, is_over);
        self.since_s += self.cycle_s;
        self.time_s += self.cycle_s;
        Some(Ok(point))
    }
}
