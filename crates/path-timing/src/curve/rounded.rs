//! A polyline with rounded corners: lines and blends.

use super::vector::{along, difference, norm, scaled};
use super::{Curve, CurveError};

/// Control points of a blend on the two lines, as fractions of its length on each.
const NEAR: f64 = 0.7;
/// The control point next to the corner.
const NEAREST: f64 = 0.25;

/// The corner's distance from the blend by its length and sin(θ/2), with room for what is left of
/// the line.
const DEPTH: f64 = (1.0 + 5.0 * NEAR + 10.0 * NEAREST) / 16.0 * (1.0 + LEAST_LINE);

/// What is left of a line between two blends, as a fraction of it, that the second begins with.
const LEAST_LINE: f64 = 1e-3;

/// The lines of a polyline and, at each corner, a blend: the curves of a path that can be run
/// without a stop.
///
/// A blend is a quintic Bézier curve that leaves one line and meets the other without a step of
/// direction or curvature. For a turn by θ with control points on both lines at 1, 0.7 and 0.25 of l
/// from the corner, the corner and with it every point of the two lines is within
///
/// ```text
/// l (1 + 5 · 0.7 + 10 · 0.25) / 16 · sin(θ/2)
/// ```
///
/// of it; l is at most what is left of the line before and half of the line after. Where the polyline turns back so sharply, by some
/// 172° and more, that the blend would be a cusp, there is none: the curves meet in the corner, and the machine has to
/// stop there. Repeated points are left out.
///
/// ```
/// use path_timing::Rounded;
///
/// let corners = [[0.0, 0.0], [40.0, 0.0], [40.0, 30.0]];
/// let curves: Result<Vec<_>, _> = Rounded::new(corners, 0.05)?.collect();
/// let curves = curves?;
/// assert_eq!(curves.len(), 3); // line, blend, line
/// assert!(curves[0].end() == curves[1].start() && curves[1].end() == curves[2].start());
/// # Ok::<(), path_timing::CurveError>(())
/// ```
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Rounded<I, const D: usize> {
    points: I,
    tolerance: f64,
    /// The end of the last curve; none before the first point and after an error.
    here: Option<[f64; D]>,
    /// The next corner.
    corner: Option<[f64; D]>,
    /// The blend of that corner, its line having been handed out.
    blend: Option<Curve<D>>,
}

impl<const D: usize, I: Iterator<Item = [f64; D]>> Rounded<I, D> {
    /// The polyline through `points` with corners rounded within `tolerance`.
    ///
    /// # Errors
    /// [`CurveError::Tolerance`].
    pub fn new(
        points: impl IntoIterator<IntoIter = I>,
        tolerance: f64,
    ) -> Result<Self, CurveError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(CurveError::Tolerance { tolerance });
        }
        let mut points = points.into_iter();
        let here = points.next();
        let mut rounded = Self {
            points,
            tolerance,
            here,
            corner: None,
            blend: None,
        };
        rounded.corner = here.and_then(|here| rounded.point_after(&here));
        Ok(rounded)
    }

    /// The next point that is another one.
    fn point_after(&mut self, point: &[f64; D]) -> Option<[f64; D]> {
        self.points
            .find(|next| norm(&difference(next, point)) != 0.0)
    }

    /// The line to the next corner, or to where its blend begins.
    fn line(&mut self, from: [f64; D], corner: [f64; D]) -> Result<Curve<D>, CurveError> {
        self.corner = self.point_after(&corner);
        let Some(next) = self.corner else {
            self.here = None;
            return Curve::line(from, corner);
        };
        match self.blend(from, corner, next) {
            Ok(Some(blend)) => {
                self.here = Some(blend.end());
                let to = blend.start();
                if norm(&difference(&to, &from)) == 0.0 {
                    return Ok(blend);
                }
                self.blend = Some(blend);
                Curve::line(from, to)
            }
            Ok(None) | Err(CurveError::Cusp { .. }) => {
                self.here = Some(corner);
                Curve::line(from, corner)
            }
            Err(error) => Err(error),
        }
    }

    /// The blend of a corner; none on a straight way.
    fn blend(
        &self,
        from: [f64; D],
        corner: [f64; D],
        next: [f64; D],
    ) -> Result<Option<Curve<D>>, CurveError> {
        let (before, after) = (difference(&corner, &from), difference(&next, &corner));
        let (length, next_length) = (norm(&before), norm(&after));
        let (before, after) = (
            scaled(&before, 1.0 / length),
            scaled(&after, 1.0 / next_length),
        );
        // |change of direction| = 2 sin(θ/2)
        let sine = norm(&difference(&after, &before)) * 0.5;
        if sine <= f64::EPSILON {
            return Ok(None);
        }
        // What is left of the line is what the blend before has left of it: at least half.
        let most = length.min(next_length * 0.5);
        let l = most.min(self.tolerance / (DEPTH * sine));
        let (first, start) = if length - l <= length * LEAST_LINE {
            (length, from)
        } else {
            (l, along(&corner, -l, &before))
        };
        let blend = Curve::quintic(
            start,
            &corner,
            [
                scaled(&before, -first),
                scaled(&before, -NEAR * l),
                scaled(&before, -NEAREST * l),
                scaled(&after, NEAREST * l),
                scaled(&after, NEAR * l),
                scaled(&after, l),
            ],
        );
        blend.map(Some)
    }
}

impl<const D: usize, I: Iterator<Item = [f64; D]>> Iterator for Rounded<I, D> {
    type Item = Result<Curve<D>, CurveError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(blend) = self.blend.take() {
            return Some(Ok(blend));
        }
        let curve = self.line(self.here?, self.corner?);
        if curve.is_err() {
            (self.here, self.corner) = (None, None);
        }
        Some(curve)
    }
}
