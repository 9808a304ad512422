//! The course of a path's parameter over time, as rows of one axis.

use crate::{Axes, Path, Row};

impl<A: Axes> Row<A> {
    /// The parameter of a path and its speed, as a row of one axis.
    ///
    /// Where the tool may not leave its path, its course along the path is shaped in place of the
    /// axes: a [`Shaped`](crate::Shaped) of these rows, each put [`on`](Row::on) the path again. On
    /// a line of a Cartesian machine it is the same. On curves, and for arms, the axes' own motions
    /// are then no sums of delayed ones: what is left of a vibration is small but not zero, and
    /// accelerations may pass the limits by some percent where the slopes change within the delay.
    /// A [`Verifier`](crate::Verifier) tells it before anything runs; a plan with limits lower by
    /// as much keeps them.
    ///
    /// The path is one from rest to rest.
    ///
    /// ```
    /// use path_timing::{AxisLimits, Curve, Knot, Mode, Row, Shaped, Shaper, Table};
    ///
    /// let arc = Curve::arc([40.0, 0.0], [0.0, 0.0], [0.0, 1.0], 3.0)?; // mm
    /// let axis = AxisLimits { speed: 300.0, acceleration: 5000.0, jerk: None };
    /// let mut knots = [Knot::default(); 101];
    /// let table = Table::plan([arc], [axis; 2], |_| 100, &mut knots)?;
    ///
    /// let shaper = Shaper::ei(Mode { hz: 40.0, damping: 0.05 })?;
    /// let mut memory = [Row::default(); 104];
    /// let course = table.rows().map(|row| row.course(&arc));
    /// for row in Shaped::new(course, [shaper], &mut memory) {
    ///     let row = row?.on(&arc)?;
    ///     let [x, y] = row.position;
    ///     assert!((x.hypot(y) - 40.0).abs() < 1e-9);
    /// }
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What the path says of the place.
    pub fn course<P: Path<Axes = A>>(&self, path: &P) -> Result<Row<[f64; 1]>, P::Error> {
        let slope = path.point(self.s)?.slope;
        let (mut along, mut square) = (0.0, 0.0);
        for (velocity, slope) in (self.velocity.as_slice().iter()).zip(slope.as_slice()) {
            along += velocity * slope;
            square += slope * slope;
        }
        let speed = if square > 0.0 { along / square } else { 0.0 };
        Ok(Row {
            time_s: self.time_s,
            duration_s: self.duration_s,
            position: [self.s],
            velocity: [speed],
            leg: self.leg,
            s: self.s,
        })
    }
}

impl Row<[f64; 1]> {
    /// The row of all axes where the parameter of a path has this position and speed.
    ///
    /// # Errors
    /// What the path says of the place.
    pub fn on<P: Path>(&self, path: &P) -> Result<Row<P::Axes>, P::Error> {
        let ([s], [speed]) = (self.position, self.velocity);
        // The sum of delayed parameters ends at the end, but for rounding.
        let s = s.clamp(0.0, path.length().max(0.0));
        let point = path.point(s)?;
        Ok(Row {
            time_s: self.time_s,
            duration_s: self.duration_s,
            position: point.position,
            velocity: point.slope.scaled(speed),
            leg: self.leg,
            s,
        })
    }
}
