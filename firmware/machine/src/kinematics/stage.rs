//! A stage of two axes.

use core::convert::Infallible;
use core::fmt::{self, Formatter};

use path_timing::{AxisLimits, Cubic, Curve, Path, PathPoint, Span, ToolLimits};

use trig_kernels::sqrt;

use super::reason::{Reasoned, out_of_range};
use super::{Kinematics, Slide, Unit};
use crate::settings_error::SettingsError;

/// Segments of a short line: the axes go straight whatever their number; these give it its speeds.
const LEAST_SEGMENTS: f64 = 12.0;
/// Time of a segment of a longer one: a hold and a ramp begin at a row, and rows are one apart.
const SEGMENT_S: f64 = 0.1;
/// More of them for what an arc turns.
const SEGMENTS_PER_RAD: f64 = 6.0;
/// As many as there is memory for at the most, with a second attempt at an arc.
const MAX_SEGMENTS: f64 = 70.0;
/// By how much an axis may pass an end of its range, in mm: rounding.
const RANGE_SLACK_MM: f64 = 1e-9;

/// What a person sets for a stage as a whole: nothing.
#[derive(Clone, Copy, Debug)]
pub struct StageGeometry;

/// A stage of two axes, x and y.
#[derive(Clone, Debug)]
pub struct XyStage {
    ranges: [[f64; 2]; 2],
}

/// A curve of the tool, within the ranges of the axes.
#[derive(Clone, Copy, Debug)]
pub struct StagePath {
    curve: Curve<2>,
    /// 0 of a line.
    curvature: f64,
    ranges: [[f64; 2]; 2],
}

/// An axis would leave its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("after {s} mm {axis} is at {at} mm, not within {} to {} mm", .range[0], .range[1])]
pub struct StagePathError {
    /// Arc length up to there, in mm.
    pub s: f64,
    /// `x` or `y`.
    pub axis: &'static str,
    /// Where it would be, in mm.
    pub at: f64,
    /// Its range, in mm.
    pub range: [f64; 2],
}

impl Reasoned for StagePathError {
    fn fmt_reason(&self, f: &mut Formatter<'_>) -> fmt::Result {
        out_of_range(f, self.s, self.axis, self.at, self.range, Unit::Mm)
    }
}

impl StagePath {
    /// Whether both axes are within their ranges from the least to the largest that they take.
    fn check_extents(&self, s: f64, extents: [[f64; 2]; 2]) -> Result<(), StagePathError> {
        let axes = XyStage::AXES.into_iter().zip(self.ranges).zip(extents);
        for ((axis, range), [low, high]) in axes {
            // Written so that NaN is beyond.
            let is_within = low >= range[0] - RANGE_SLACK_MM && high <= range[1] + RANGE_SLACK_MM;
            if !is_within {
                let is_lower = range[0] - low > high - range[1];
                let at = if is_lower { low } else { high };
                return Err(StagePathError { s, axis, at, range });
            }
        }
        Ok(())
    }
}

impl Path for StagePath {
    type Axes = [f64; 2];
    type Error = StagePathError;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, StagePathError> {
        let at = self.curve.at(s);
        self.check_extents(s, at.point.map(|place| [place; 2]))?;
        Ok(PathPoint {
            position: at.point,
            slope: at.tangent,
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.curve.tool_rate(s)
    }

    fn check(&self, span: &Span<[f64; 2]>) -> Result<(), StagePathError> {
        let [from, to] = &span.rows;
        let mut extents = [[0.0; 2]; 2];
        for (extent, cubic) in extents.iter_mut().zip(Cubic::between(from, to)) {
            *extent = cubic.extent();
        }
        self.check_extents(span.s[0], extents)
    }
}

/// The most by which both axes' cubics leave a circle, in mm: rows are on it, with velocities along
/// it.
///
/// With P from the centre, f = |P|² - r² and f' vanish at both ends, so that by the fraction t of
/// the segment
///
/// ```text
/// |f| ≤ max |f⁗| / 384    f⁗ = 8 P' · P‴ + 6 P" · P"
/// d = |f| / (|P| + r) ≤ |f| / (2 r - d),  d ≤ |f| / r
/// ```
///
/// P" is a + b t, P‴ is b, so that f⁗ is a parabola.
fn off_circle(span: &Span<[f64; 2]>, curvature: f64) -> f64 {
    if curvature == 0.0 {
        return 0.0;
    }
    let ([from, to], [mut va, mut aa, mut ab, mut bb]) = (&span.rows, [0.0; 4]);
    for axis in 0..2 {
        let change = to.position[axis] - from.position[axis];
        let [v0, v1] = [from, to].map(|row| row.velocity[axis] * to.duration_s);
        let a = 6.0 * change - 4.0 * v0 - 2.0 * v1;
        let b = 6.0 * (v0 + v1) - 12.0 * change;
        va += v0 * b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
    }
    let fourth = |t: f64| (8.0 * va + 6.0 * aa + t * (20.0 * ab + t * 10.0 * bb)).abs();
    let vertex = if bb > 0.0 {
        (-ab / bb).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let f = [0.0, vertex, 1.0]
        .map(fourth)
        .into_iter()
        .fold(0.0, f64::max)
        / 384.0;
    let nearly = f * curvature;
    // Half of it, and a little more.
    f / (2.0 / curvature - nearly).max(1.0 / curvature) * (1.0 + 1e-9)
}

impl Kinematics<2> for XyStage {
    const NAME: &'static str = "stage";
    const AXES: [&'static str; 2] = ["x", "y"];
    const ONE_AXIS: &'static str = "`x` or `y`";
    const HAS_ARCS: bool = true;
    const IS_CARTESIAN: bool = true;

    type Geometry = StageGeometry;
    type Axis = Slide;
    type Path = StagePath;
    type NoPath = Infallible;
    type NoPlace = Infallible;

    fn new(_: &StageGeometry, ranges: [[f64; 2]; 2]) -> Result<Self, SettingsError> {
        Ok(Self { ranges })
    }

    fn tool_mm(&self, axes: [f64; 2]) -> Result<[f64; 2], Infallible> {
        Ok(axes)
    }

    fn path(
        &self,
        curve: Curve<2>,
        _: [f64; 2],
        [x_limits, y_limits]: &[AxisLimits; 2],
    ) -> Result<(StagePath, f64), Infallible> {
        // |curvature| is the turn of the tangent by the length.
        let [x, y] = curve.at(0.0).curvature;
        let curvature = sqrt(x * x + y * y);
        let turn = curvature * curve.length();
        let path = StagePath {
            curve,
            curvature,
            ranges: self.ranges,
        };
        let speed = x_limits.speed.min(y_limits.speed);
        let feed = curve.tool().map_or(speed, |tool| tool.feed.min(speed));
        let for_time = curve.length() / feed / SEGMENT_S;
        let for_shape = LEAST_SEGMENTS + SEGMENTS_PER_RAD * turn;
        Ok((path, for_shape.max(for_time).min(MAX_SEGMENTS)))
    }

    fn departure(path: &StagePath, span: &Span<[f64; 2]>) -> f64 {
        off_circle(span, path.curvature)
    }

    fn fmt_reach(&self, _: &mut Formatter<'_>) -> fmt::Result {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use path_timing::Row;

    use super::*;

    /// From rest to speed, as fast, and braking: on a circle of 40 mm.
    #[test]
    fn no_cubic_leaves_the_circle_by_more() {
        let mut closest = f64::INFINITY;
        for angle in [0.05, 0.2, 0.5, 1.0] {
            for [before, after] in [[0.0, 1.6], [1.0, 1.0], [1.3, 0.4], [1.5, 1.5]] {
                let row = |at: f64, ratio: f64| {
                    let (sin, cos) = trig_kernels::sin_cos(at);
                    let speed = 40.0 * angle * ratio / 0.5;
                    Row {
                        duration_s: 0.5,
                        position: [40.0 * cos, 40.0 * sin],
                        velocity: [-speed * sin, speed * cos],
                        ..Row::default()
                    }
                };
                let rows = [row(0.3, before), row(0.3 + angle, after)];
                let span = Span {
                    s: [0.0, 40.0 * angle],
                    rows,
                };
                let bound = off_circle(&span, 1.0 / 40.0);
                let off = (0..=100).map(|part| {
                    let place = Cubic::between(&span.rows[0], &span.rows[1])
                        .map(|cubic| cubic.position(f64::from(part) / 100.0));
                    let square: f64 = place.map(|at| at * at).sum();
                    (sqrt(square) - 40.0).abs()
                });
                let off = off.fold(0.0, f64::max);
                assert!(off <= bound, "{angle}, {before} to {after}: {off}, {bound}");
                closest = closest.min(bound / off);
            }
        }
        assert!(closest < 1.2, "a bound of {closest} times that at best");
    }
}
