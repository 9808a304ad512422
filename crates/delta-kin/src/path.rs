//! Curves of the platform as paths of the three arms, to be timed by `path-timing`.

mod bound;
mod error;
mod passage;
mod pick;
mod wrists;

use nalgebra::{Point3, Vector3};
use path_timing::{Corner, Curve, PathPoint, Span, ToolLimits};

pub use error::DeltaPathError;

use crate::arm::zip;
use crate::{Arm, Delta};

/// A curve of the platform's centre as a path of the three arms, in radians, by the curve's arc
/// length: what [`path_timing::Table`] plans.
///
/// It is made by [`Delta::path`], which has looked at all of it. The next one goes on from it
/// without a stop where the directions of their curves agree, as those of a line and a blend do,
/// unless the curve's own corner is a stop; by how much an arm may jump
/// [`with_corner`](Self::with_corner) says.
///
/// ```
/// use delta_kin::{Delta, DeltaPath, Dimensions};
/// use path_timing::{Accuracy, AxisLimits, Curve, Knot, Table};
///
/// let delta = Delta::new(Dimensions { base: 42.0, platform: 18.0, upper: 120.0, lower: 243.0 })?; // mm
/// let line = Curve::line([50.0, 50.0, -300.0], [-50.0, 50.0, -300.0])?;
/// let path = delta.path(line)?;
/// let arm = AxisLimits { speed: 6.0, acceleration: 100.0, jerk: None }; // rad, s
/// let accuracy = Accuracy { min_segments: 8, max_departure: 0.01, max_time_ratio: f64::INFINITY };
/// let mut knots = [Knot::default(); 100];
/// let table = Table::plan_within([path], [arm; 3], accuracy, DeltaPath::departure, &mut knots)?;
/// for row in table.rows() {
///     println!("{:?} rad after {} s", row.position, row.duration_s);
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeltaPath {
    delta: Delta,
    curve: Curve<3>,
    corner: Corner<[f64; 3]>,
}

/// Nearest to the edge of the workspace, as a fraction of the span, that a path may come.
const EDGE: f64 = 1e-6;

/// Longest curve that stays within the workspace, in spans: an arc of 100 rad. A Bézier curve of
/// degree 5 in a ball of radius 1 is at most 87 long, by Markov's inequality. Beyond, the machine
/// may be too small for the digits of the curve, and would be walked on without end.
const LONGEST: f64 = 100.0;

/// Shortest step along the curve, as a fraction of it.
const MIN_STEP: f64 = 1e-12;

/// What is known of a place.
struct Look {
    angles: Vector3<f64>,
    clearance: f64,
}

impl Delta {
    /// The path of the arms that brings the platform's centre along `curve`, in the machine's
    /// modes.
    ///
    /// All of the curve is looked at before anything is handed out: from each place it goes on by
    /// no more than the [`clearance`](Self::clearance) there, so that nothing between is out of
    /// reach, beyond a joint range or a ball joint, or singular.
    ///
    /// # Errors
    /// [`DeltaPathError`]; the place named is the first along the curve.
    pub fn path(&self, curve: Curve<3>) -> Result<DeltaPath, DeltaPathError> {
        let (length, max) = (curve.length(), self.span() * LONGEST);
        if length > max {
            return Err(DeltaPathError::TooLong { length, max });
        }
        let path = DeltaPath {
            delta: *self,
            curve,
            corner: path_timing::Path::corner(&curve).of_other_axes(),
        };
        let (mut s, mut there) = (0.0, path.look(0.0)?);
        while s < curve.length() {
            (s, there) = path.advance(s, &there)?;
        }
        Ok(path)
    }
}

impl DeltaPath {
    /// The curve of the platform's centre.
    #[must_use]
    pub const fn curve(&self) -> &Curve<3> {
        &self.curve
    }

    /// The path with another corner at its end, such as the start-stop speeds of its motors in
    /// rad/s. At first it is smooth, or a stop where that of the curve is one.
    #[must_use]
    pub const fn with_corner(mut self, corner: Corner<[f64; 3]>) -> Self {
        self.corner = corner;
        self
    }

    fn centre(&self, s: f64) -> Point3<f64> {
        self.curve.at(s).point.into()
    }

    /// A place that is not on the edge of the workspace.
    fn look(&self, s: f64) -> Result<Look, DeltaPathError> {
        let point = self.centre(s);
        let angles = self.delta.inverse(point);
        let angles = angles.map_err(|reason| DeltaPathError::Unreachable { s, point, reason })?;
        let clearance = self.delta.clearance(point);
        if clearance > self.delta.span() * EDGE {
            Ok(Look { angles, clearance })
        } else {
            Err(DeltaPathError::Edge {
                s,
                point,
                clearance,
            })
        }
    }

    /// The next place of the survey. Shorter steps lead up to the first place that is refused.
    fn advance(&self, s: f64, here: &Look) -> Result<(f64, Look), DeltaPathError> {
        let mut step = here.clearance / (1.0 + self.curve.speed_error());
        loop {
            let next = (s + step).min(self.curve.length());
            let refused = match self.look(next) {
                Ok(there) => match jumping(there.angles - here.angles) {
                    None => return Ok((next, there)),
                    Some(arm) => DeltaPathError::Turn {
                        s: next,
                        point: self.centre(next),
                        arm,
                    },
                },
                Err(error) => error,
            };
            if step <= self.curve.length() * MIN_STEP {
                return Err(refused);
            }
            step *= 0.5;
        }
    }
}

/// The arm whose angle jumps by a whole turn.
fn jumping(change: Vector3<f64>) -> Option<Arm> {
    let arms = zip(Arm::ALL, change.into());
    arms.into_iter()
        .find(|(_, change)| change.abs() > core::f64::consts::PI)
        .map(|(arm, _)| arm)
}

impl path_timing::Path for DeltaPath {
    type Axes = [f64; 3];
    type Error = DeltaPathError;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 3]>, DeltaPathError> {
        let at = self.curve.at(s);
        let point = at.point.into();
        let found = self.delta.inverse_with_slopes(point, at.tangent.into());
        let (angles, slopes) =
            found.map_err(|reason| DeltaPathError::Unreachable { s, point, reason })?;
        let slopes = slopes.map_err(|reason| DeltaPathError::Singular { s, reason })?;
        Ok(PathPoint {
            position: angles.into(),
            slope: slopes.into(),
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.curve.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; 3]> {
        self.corner
    }

    fn check(&self, span: &Span<[f64; 3]>) -> Result<(), DeltaPathError> {
        self.check_span(span)
    }
}
