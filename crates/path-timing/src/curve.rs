//! Curves of the tool in space: lines, arcs, Bézier curves, by their arc length.

mod error;
mod motion;
mod polynomial;
mod smoothed;
mod vector;

use core::convert::Infallible;
use core::f64::consts::TAU;

pub use error::CurveError;
pub use motion::{CurveMotion, MotionSeries, TurnMotion};
pub use smoothed::{Smoothed, Vertex, Waypoint};

use crate::{Corner, Cubic, Path, PathPoint, Span, ToolLimits};
use polynomial::Polynomial;
use vector::{all_finite, along, difference, dot, norm, scaled};

/// A curve of the tool in `D` dimensions, in any unit of length, by its arc length s.
///
/// As a [`Path`] it is that of a Cartesian machine, whose axes are the coordinates; it goes on to
/// the next without a stop where their directions agree ([`Corner::Smooth`]), unless
/// [`with_corner`](Self::with_corner) says otherwise.
///
/// ```
/// use path_timing::{Accuracy, AxisLimits, Curve, Knot, Table};
///
/// let quarter = Curve::arc([50.0, 0.0], [0.0, 0.0], [0.0, 1.0], core::f64::consts::FRAC_PI_2)?;
/// let axis = AxisLimits { speed: 200.0, acceleration: 2000.0, jerk: None }; // mm, s
/// let mut knots = [Knot::default(); 100];
/// // No cubic between two rows leaves the arc by more than a micrometre.
/// let accuracy = Accuracy { min_segments: 2, max_departure: 1e-3, max_time_ratio: f64::INFINITY };
/// let table = Table::plan_within([quarter], [axis; 2], accuracy, Curve::departure, &mut knots)?;
/// # assert!(table.len() > 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve<const D: usize> {
    shape: Shape<D>,
    length: f64,
    ends: [[f64; D]; 2],
    tool: Option<ToolLimits>,
    between: Option<[usize; 2]>,
    corner: Corner<[f64; D]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap, and a stream of lines holds few at once"
)]
enum Shape<const D: usize> {
    Line {
        direction: [f64; D],
    },
    Arc {
        centre: [f64; D],
        /// From the centre to the start.
        start: [f64; D],
        /// From the centre to what is a quarter turn further.
        ahead: [f64; D],
        radius: f64,
    },
    /// Coefficients of 1, u, u², u³.
    Cubic([[f64; D]; 4]),
    Polynomial(Polynomial<D>),
}

/// A point of a curve with its derivatives by the arc length.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "a point and two derivatives")]
pub struct CurvePoint<const D: usize> {
    /// The point.
    pub point: [f64; D],
    /// First derivative: the unit tangent. Of a Bézier curve its length is 1 within
    /// [`Curve::speed_error`], in a smoothed corner less.
    pub tangent: [f64; D],
    /// Second derivative: the curvature's vector.
    pub curvature: [f64; D],
}

/// Derivatives 0 to 5 by the curve's own parameter.
pub(crate) type Jet<const D: usize> = [[f64; D]; 6];

/// Most that an arc turns by, in radians: some 16 times round.
const MAX_ANGLE: f64 = 100.0;

/// Relative rounding of an angle that is whole turns: the arc ends where it starts.
const WHOLE: f64 = 4.0 * f64::EPSILON;

/// Least length, as a fraction of the coordinates, in which rounding leaves a direction 6 digits.
const LEAST_LENGTH: f64 = 1e-10;

impl<const D: usize> Curve<D> {
    /// The straight line from one point to another.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`], [`CurveError::NoLength`].
    pub fn line(from: [f64; D], to: [f64; D]) -> Result<Self, CurveError> {
        let length = norm(&difference(&to, &from));
        let curve = Self {
            shape: Shape::Line {
                direction: scaled(&difference(&to, &from), 1.0 / length),
            },
            length,
            ends: [from, to],
            tool: None,
            between: None,
            corner: Corner::Smooth,
        };
        curve.checked()
    }

    /// The arc of a circle by `angle` > 0 radians from `start` round `centre`, leaving the start in
    /// `direction`, of which only the part perpendicular to the radius counts. 2π and more go
    /// round, up to 100 rad; whole turns end at the start, to the last bit.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`], [`CurveError::NoLength`], [`CurveError::Angle`],
    /// [`CurveError::NoDirection`] where the direction is along the radius.
    pub fn arc(
        start: [f64; D],
        centre: [f64; D],
        direction: [f64; D],
        angle: f64,
    ) -> Result<Self, CurveError> {
        if !(all_finite(&direction) && angle.is_finite()) {
            return Err(CurveError::NotFinite);
        }
        let out = difference(&start, &centre);
        let radius = norm(&out);
        if !(angle > 0.0 && radius > 0.0) {
            return Err(CurveError::NoLength {
                length: radius * angle,
            });
        }
        if angle > MAX_ANGLE {
            return Err(CurveError::Angle {
                angle,
                max: MAX_ANGLE,
            });
        }
        let across = along(&direction, -dot(&direction, &out) / (radius * radius), &out);
        let width = norm(&across);
        // Written so that NaN is refused too.
        let has_direction = width > LEAST_LENGTH * norm(&direction);
        if !has_direction {
            return Err(CurveError::NoDirection);
        }
        let mut curve = Self {
            shape: Shape::Arc {
                centre,
                start: out,
                ahead: scaled(&across, radius / width),
                radius,
            },
            length: radius * angle,
            ends: [start, start],
            tool: None,
            between: None,
            corner: Corner::Smooth,
        };
        let turns = libm::round(angle / TAU);
        if (angle - turns * TAU).abs() > angle * WHOLE {
            curve.ends = [start, curve.jet(angle)[0]];
        }
        curve.checked()
    }

    /// The cubic Bézier curve of four control points.
    ///
    /// Its parameter is turned into arc length by interpolation: the tool's speed is that of s
    /// within [`speed_error`](Self::speed_error), the points are on the curve to rounding.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`], [`CurveError::NoLength`], [`CurveError::Cusp`].
    pub fn bezier(control_points: [[f64; D]; 4]) -> Result<Self, CurveError> {
        let [start, .., end] = control_points;
        Self::polynomial(Polynomial::new(control_points)?, [start, end])
    }

    /// The cubic between two points with the derivatives there, by a parameter from 0 to `length`.
    pub(crate) fn cubic(
        [from, to]: [[f64; D]; 2],
        [before, after]: [[f64; D]; 2],
        length: f64,
    ) -> Result<Self, CurveError> {
        let mean = scaled(&difference(&to, &from), 1.0 / length);
        let second = along(&along(&scaled(&mean, 3.0), -2.0, &before), -1.0, &after);
        let third = along(&along(&before, 1.0, &after), -2.0, &mean);
        let curve = Self {
            shape: Shape::Cubic([
                from,
                before,
                scaled(&second, 1.0 / length),
                scaled(&third, 1.0 / (length * length)),
            ]),
            length,
            ends: [from, to],
            tool: None,
            between: None,
            corner: Corner::Smooth,
        };
        curve.checked()
    }

    fn polynomial(polynomial: Polynomial<D>, ends: [[f64; D]; 2]) -> Result<Self, CurveError> {
        let curve = Self {
            length: polynomial.length(),
            shape: Shape::Polynomial(polynomial),
            ends,
            tool: None,
            between: None,
            corner: Corner::Smooth,
        };
        curve.checked()
    }

    fn checked(self) -> Result<Self, CurveError> {
        let [from, to] = &self.ends;
        if !(self.length.is_finite() && all_finite(from) && all_finite(to)) {
            return Err(CurveError::NotFinite);
        }
        if self.length > LEAST_LENGTH * norm(from).max(norm(to)) {
            Ok(self)
        } else {
            Err(CurveError::NoLength {
                length: self.length,
            })
        }
    }

    /// The curve with limits of the tool's speed and acceleration along it.
    #[must_use]
    pub const fn with_tool(mut self, tool: ToolLimits) -> Self {
        self.tool = Some(tool);
        self
    }

    /// The curve with another corner at its end, such as the start-stop speeds of a gantry's
    /// motors.
    #[must_use]
    pub const fn with_corner(mut self, corner: Corner<[f64; D]>) -> Self {
        self.corner = corner;
        self
    }

    /// Arc length.
    #[must_use]
    pub const fn length(&self) -> f64 {
        self.length
    }

    /// The first point.
    #[must_use]
    pub const fn start(&self) -> [f64; D] {
        self.ends[0]
    }

    /// The last point.
    #[must_use]
    pub const fn end(&self) -> [f64; D] {
        self.ends[1]
    }

    /// The most by which |dP/ds| is above 1: 0 of lines and arcs; of a Bézier curve, where it may
    /// be as much below, twice the largest that was found at 8 places of each of its intervals. In
    /// a [`Smoothed`] corner |dP/ds| is below 1.
    #[must_use]
    pub fn speed_error(&self) -> f64 {
        match &self.shape {
            Shape::Polynomial(polynomial) => polynomial.speed_error(),
            Shape::Line { .. } | Shape::Arc { .. } => 0.0,
            Shape::Cubic([_, first, second, third]) => {
                // The control points of the derivative, a quadratic, have its largest length.
                let l = self.length;
                let middle = along(first, l, second);
                let end = along(&along(first, 2.0 * l, second), 3.0 * l * l, third);
                let longest = norm(first).max(norm(&middle)).max(norm(&end));
                (longest - 1.0).max(0.0)
            }
        }
    }

    /// The points of the input between which it lies, from 0, where it is part of a [`Smoothed`]
    /// polyline.
    #[must_use]
    pub const fn between(&self) -> Option<[usize; 2]> {
        self.between
    }

    /// Limits of the tool along the curve in terms of s: the tool's speed and that of s differ by
    /// the [`speed_error`](Self::speed_error).
    #[must_use]
    pub fn tool(&self) -> Option<ToolLimits> {
        let slower = 1.0 + self.speed_error();
        self.tool.map(|tool| ToolLimits {
            feed: tool.feed / slower,
            acceleration: tool.acceleration.map(|limit| limit / slower),
        })
    }

    /// |dP/ds| at `s`: below 1 in a [`Smoothed`] corner, of a Bézier curve about 1, else 1.
    #[must_use]
    pub fn tool_rate(&self, s: f64) -> f64 {
        match &self.shape {
            Shape::Line { .. } | Shape::Arc { .. } => 1.0,
            Shape::Cubic(_) | Shape::Polynomial(_) => norm(&self.at(s).tangent),
        }
    }

    /// The point at the arc length `s`, with its derivatives; the ends to the last bit.
    #[must_use]
    pub fn at(&self, s: f64) -> CurvePoint<D> {
        let [u, by_s, twice] = self.parameter(s);
        let [point, first, second, ..] = self.jet(u);
        let [start, end] = self.ends;
        CurvePoint {
            point: if s <= 0.0 {
                start
            } else if s >= self.length {
                end
            } else {
                point
            },
            tangent: scaled(&first, by_s),
            curvature: along(&scaled(&second, by_s * by_s), twice, &first),
        }
    }

    /// The curve's own parameter at an arc length, and its first two derivatives by it.
    fn parameter(&self, s: f64) -> [f64; 3] {
        match &self.shape {
            Shape::Line { .. } | Shape::Cubic(_) => [s, 1.0, 0.0],
            Shape::Arc { radius, .. } => [s / radius, 1.0 / radius, 0.0],
            Shape::Polynomial(polynomial) => polynomial.parameter(s),
        }
    }

    /// Derivatives by the curve's own parameter.
    fn jet(&self, u: f64) -> Jet<D> {
        match &self.shape {
            Shape::Line { direction } => {
                let [from, to] = &self.ends;
                let zero = [0.0; D];
                // From the nearer end, so that both are met.
                let point = if u < self.length * 0.5 {
                    along(from, u, direction)
                } else {
                    along(to, u - self.length, direction)
                };
                [point, *direction, zero, zero, zero, zero]
            }
            Shape::Arc {
                centre,
                start,
                ahead,
                ..
            } => {
                let (sin, cos) = libm::sincos(u);
                let out = along(&scaled(start, cos), sin, ahead);
                let forward = along(&scaled(ahead, cos), -sin, start);
                let (back, inward) = (scaled(&forward, -1.0), scaled(&out, -1.0));
                [
                    along(centre, 1.0, &out),
                    forward,
                    inward,
                    back,
                    out,
                    forward,
                ]
            }
            Shape::Cubic([c0, c1, c2, c3]) => {
                let zero = [0.0; D];
                let third = scaled(c3, 6.0);
                let second = along(&scaled(c2, 2.0), u, &third);
                let first = along(&along(c1, 2.0 * u, c2), 3.0 * u * u, c3);
                let point = along(&along(&along(c0, u, c1), u * u, c2), u * u * u, c3);
                [point, first, second, third, zero, zero]
            }
            Shape::Polynomial(polynomial) => polynomial.jet(u),
        }
    }

    /// The longest that derivatives 1 to 4 are within `half` of where the jet was taken.
    fn longest(&self, jet: &Jet<D>, half: f64) -> [f64; 4] {
        match &self.shape {
            Shape::Line { .. } => [1.0, 0.0, 0.0, 0.0],
            Shape::Arc { radius, .. } => [*radius; 4],
            Shape::Cubic(_) | Shape::Polynomial(_) => polynomial::longest(jet, half),
        }
    }

    /// The longest that the sixth derivative is.
    const fn longest_sixth(&self) -> f64 {
        match &self.shape {
            Shape::Arc { radius, .. } => *radius,
            Shape::Line { .. } | Shape::Cubic(_) | Shape::Polynomial(_) => 0.0,
        }
    }

    /// The longest that the fifth derivative is: polynomials have none beyond.
    fn longest_fifth(&self, jet: &Jet<D>) -> f64 {
        match &self.shape {
            Shape::Arc { radius, .. } => *radius,
            Shape::Line { .. } | Shape::Cubic(_) | Shape::Polynomial(_) => {
                let [.., fifth] = jet;
                norm(fifth)
            }
        }
    }

    /// The most by which a Cartesian machine departs from the curve on a segment of a table: for
    /// [`Table::plan_within`](crate::Table::plan_within). 0 on a line.
    ///
    /// By [`CurveMotion`]; the fourth and the fifth derivative of the axes are zero.
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; D]>) -> f64 {
        let [from, to] = &span.rows;
        let motion = CurveMotion::new(self, span.s, [&from.velocity, &to.velocity], to.duration_s);
        let place = |tau| {
            let mut place = from.position;
            for (place, cubic) in place.iter_mut().zip(Cubic::between(from, to)) {
                *place = cubic.position(tau);
            }
            place
        };
        motion.departure(place, [0.0; 2])
    }
}

impl<const D: usize> Path for Curve<D> {
    type Axes = [f64; D];
    type Error = Infallible;

    fn length(&self) -> f64 {
        self.length
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; D]>, Infallible> {
        let at = self.at(s);
        Ok(PathPoint {
            position: at.point,
            slope: at.tangent,
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        Self::tool_rate(self, s)
    }

    fn corner(&self) -> Corner<[f64; D]> {
        self.corner
    }
}
