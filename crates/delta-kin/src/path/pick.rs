//! Up, over, down: from one place to another, round what stands between.

use path_timing::{Curve, CurveError, Smoothed, ToolLimits, Vertex};

use super::{DeltaPath, DeltaPathError};
use crate::Delta;

/// Largest tolerance of a corner, as a fraction of the shortest line: it then takes four tenths of
/// that line.
const CORNER: f64 = 0.1;

/// Vertices in sight: more than there are.
const VERTICES: usize = 6;

impl Delta {
    /// The paths from one place straight to the height `z`, over, and straight down to another, in
    /// one go: three lines, and two curves at each of the corners, within `tolerance` of these, at
    /// most a tenth of the shortest line.
    ///
    /// ```
    /// use delta_kin::{Delta, DeltaPath, Dimensions};
    /// use path_timing::{Accuracy, AxisLimits, Knot, Table};
    ///
    /// let delta = Delta::new(Dimensions { base: 42.0, platform: 18.0, upper: 120.0, lower: 243.0 })?; // mm
    /// let moves = delta.pick_and_place([80.0, 0.0, -300.0], [-60.0, 40.0, -290.0], -270.0, 3.0, None)?;
    /// let arm = AxisLimits { speed: 6.0, acceleration: 100.0, jerk: None }; // rad, s
    /// let accuracy = Accuracy { min_segments: 4, max_departure: 0.05, max_time_ratio: f64::INFINITY };
    /// let mut knots = [Knot::default(); 300];
    /// let table = Table::plan_within(moves, [arm; 3], accuracy, DeltaPath::departure, &mut knots)?;
    /// assert!(table.duration_s() < 0.5);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`DeltaPathError`]; [`DeltaPathError::Curve`] also where one place is above the other or at
    /// the height itself.
    pub fn pick_and_place(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        z: f64,
        tolerance: f64,
        tool: Option<ToolLimits>,
    ) -> Result<[DeltaPath; 7], DeltaPathError> {
        let [above, above_there] = [from, to].map(|[x, y, _]| [x, y, z]);
        let lengths = [(from, above), (above, above_there), (above_there, to)]
            .map(|(from, to)| Curve::line(from, to).map(|line| line.length()));
        let [up, over, down] = lengths;
        let (up, over, down) = (up?, over?, down?);
        let largest = up.min(over).min(down) * CORNER;
        let points = [from, above, above_there, to];
        let mut memory = [Vertex::default(); VERTICES];
        let mut curves = Smoothed::new(points, tolerance.min(largest), &mut memory)?;
        let mut next = || {
            let curve = curves.next().ok_or(CurveError::NoLength {
                length: up + over + down,
            })??;
            self.path(tool.map_or(curve, |tool| curve.with_tool(tool)))
        };
        let [a, b, c, d] = [next()?, next()?, next()?, next()?];
        Ok([a, b, c, d, next()?, next()?, next()?])
    }
}
