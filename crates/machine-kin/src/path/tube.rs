//! What the cubics of a segment may do: axes within their ranges, the tool where the machine can be.

use path_timing::{CurveMotion, Path as _, Span};

use super::bound::{FINEST, cubics, pieces};
use super::stretch::Stretch;
use super::{MachinePath, PathError};
use crate::matrix::{Enclosure, inverse, larger_or_nan, product};
use crate::{Interval, Jet, Machine, Number};

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// The first coordinate with which the tool may leave the area.
    pub(super) fn beyond_area(
        &self,
        places: &[Interval; N],
        by: &[f64; N],
        s: [f64; 2],
    ) -> Option<PathError<N>> {
        let ranges = self.machine.area();
        let places = places.iter().zip(by).zip(ranges).enumerate();
        for (coordinate, ((place, by), range)) in places {
            let axis = crate::Axis::linear("", range);
            let position = axis.beyond(place.low() - by, place.high() + by);
            if let Some(position) = position {
                return Some(PathError::Area {
                    s,
                    coordinate,
                    position,
                    min: axis.min,
                    max: axis.max,
                });
            }
        }
        None
    }

    /// Whether the machine may run a segment: all axes within their ranges, which is exact, and the tool
    /// on its branch and within the area, at these speeds and all others with the same mean.
    ///
    /// Proof. At the ends of the segment the axes are on the path. With σ(τ) the cubic that has the
    /// speeds of the parameter there, the axes run the Hermite cubics of q(P(σ(τ))), so that each is
    /// off by ε ≤ max |d⁴q/dτ⁴|/384. That is found from the derivatives of P by σ over the segment, and
    /// those of σ of all cubics in question: with the mean speed 1 and v₀ + v₁ = 2
    ///
    /// ```text
    /// 0 ≤ σ' ≤ 2     |σ"| ≤ 2     σ‴ = 0
    /// ```
    ///
    /// The tool is then within what [`Enclosure`] says, where the inverse is defined on its branch, and
    /// regular, all over that: Newton's map takes this box into itself, so there is one such place, and
    /// it goes on from that at the start.
    pub(super) fn check_span(&self, span: &Span<[f64; N]>) -> Result<(), PathError<N>> {
        let s = span.s;
        for (cubic, axis) in cubics(span).iter().zip(&self.axes) {
            let [low, high] = cubic.extent();
            if let Some(position) = axis.beyond(low, high) {
                return Err(PathError::Limit {
                    s,
                    axis: axis.name,
                    position,
                    min: axis.min,
                    max: axis.max,
                });
            }
        }
        self.check_tool(span)
    }

    fn check_tool(&self, span: &Span<[f64; N]>) -> Result<(), PathError<N>> {
        let s @ [from, to] = span.s;
        let coarse = PathError::TooCoarse { s };
        let ends = s.map(|s| self.curve.at(s).tangent.map(|slope| slope * (to - from)));
        let motion = CurveMotion::new(&self.curve, s, ends.each_ref(), 1.0);
        let sigma = self.parameter(span)?;
        let (_, slopes) = self.slopes_at(motion.at(0.5)).map_err(|_| coarse)?;
        let y = inverse(slopes).ok_or(coarse)?.map(|row| row.map(f64::abs));
        // Shorter pieces are known better.
        for coarsest in [1, 4, 16] {
            let Some(errors) = self.errors(&motion, &sigma, coarsest) else {
                continue;
            };
            // What Newton's first step makes of it, and some more.
            let mut radius = product(&y, &errors).map(|off| off * 1.5 + self.rounding);
            for _ in 0..2 {
                let Some(off) = self.off(&motion, &errors, &radius, s) else {
                    break;
                };
                // Written so that NaN is none.
                if off.iter().zip(&radius).all(|(off, radius)| off <= radius) {
                    return Ok(());
                }
                radius = off.map(|off| off * 1.5 + self.rounding);
            }
        }
        Err(coarse)
    }

    /// The most that each axis is off by from the path at the same time.
    fn errors(
        &self,
        motion: &CurveMotion<'_, N>,
        sigma: &[Interval; 3],
        coarsest: u32,
    ) -> Option<[f64; N]> {
        let mut errors = [0.0; N];
        pieces(coarsest, FINEST, |part, _| {
            let sigma = within(sigma, part);
            let jets = Stretch::new(motion, part, self.rounding).jets();
            let axes = self.machine.inverse(jets, self.branch).ok()?;
            for (error, axis) in errors.iter_mut().zip(axes) {
                let fourth = fourth_composed(&axis, &sigma);
                *error = larger_or_nan(*error, fourth.magnitude() * (24.0 / 384.0));
            }
            errors.iter().all(|error| error.is_finite()).then_some(true)
        })?;
        Some(errors)
    }

    /// The most that the tool is off by in each coordinate, from where the inverse is looked at within
    /// `radius` of the curve. None where it is not known, or may be out of the area.
    fn off(
        &self,
        motion: &CurveMotion<'_, N>,
        errors: &[f64; N],
        radius: &[f64; N],
        s: [f64; 2],
    ) -> Option<[f64; N]> {
        let mut most = [0.0; N];
        pieces(1, FINEST, |part, can_halve| {
            let stretch = Stretch::new(motion, part, self.rounding);
            let around = self.around(&stretch, radius).ok()?;
            let enclosure = Enclosure::new(&around.slopes)?;
            if can_halve && enclosure.spread() > GOOD {
                return Some(false);
            }
            let off = enclosure.off(errors);
            if self.beyond_area(&stretch.places(), &off, s).is_some() {
                return None;
            }
            for (most, off) in most.iter_mut().zip(off) {
                *most = larger_or_nan(*most, off);
            }
            Some(true)
        })?;
        Some(most)
    }

    /// Taylor coefficients of the parameter, in lengths of the segment, at any time, for these speeds
    /// at its ends and all others with their mean.
    fn parameter(&self, span: &Span<[f64; N]>) -> Result<[Interval; 3], PathError<N>> {
        let ([s0, s1], [from, to]) = (span.s, &span.rows);
        let mut speeds = [0.0; 2];
        for (speed, (s, row)) in speeds.iter_mut().zip([(s0, from), (s1, to)]) {
            let slope = self.point(s)?.slope;
            let (mut along, mut square) = (0.0, 0.0);
            for (slope, velocity) in slope.iter().zip(row.velocity) {
                (along, square) = (along + slope * velocity, square + slope * slope);
            }
            *speed = along / square * to.duration_s / (s1 - s0);
        }
        let [a, b] = speeds;
        let (bend, third) = (3.0 - 2.0 * a - b, a + b - 2.0);
        let hull = |low: f64, high: f64, with: [f64; 3]| {
            // Not a number, and so nothing known, where one is none.
            let low = -(with.into_iter()).fold(-low, |low, x| larger_or_nan(low, -x));
            Interval::new(low, with.into_iter().fold(high, larger_or_nan))
        };
        // Hodographs lie between their control points.
        Ok([
            hull(0.0, 2.0, [a, b, 3.0 - a - b]),
            hull(-1.0, 1.0, [bend, bend + 3.0 * third, 0.0]),
            hull(-MEAN, MEAN, [third, 0.0, 0.0]),
        ])
    }
}

/// Pieces whose slopes are known better than this are not halved.
const GOOD: f64 = 0.25;

/// What v₀ + v₁ is off by from 2 where it is 2.
const MEAN: f64 = 1e-9;

/// What the coefficients of the parameter are where it is a part of the segment.
///
/// ```text
/// σ'² = v₀² + 2 σ" σ,  σ" = 2 - 2v₀     of v₀ from 0 to 2 largest at an end: 4σ or 4 (1 - σ)
/// ```
fn within(sigma: &[Interval; 3], [from, to]: [f64; 2]) -> [Interval; 3] {
    let [s1, s2, s3] = *sigma;
    // Only where the mean speed is 1.
    if s3.magnitude() > MEAN * 2.0 {
        return *sigma;
    }
    let fastest = 2.0 * trig_kernels::sqrt(larger_or_nan(to, 1.0 - from)) + MEAN;
    [Interval::new(0.0, fastest).and(s1), s2, s3]
}

/// The fourth Taylor coefficient of q(σ(τ)) from those of q by σ and of σ by τ.
fn fourth_composed(q: &Jet<Interval, 5>, [s1, s2, s3]: &[Interval; 3]) -> Interval {
    let [_, _, q2, q3, q4] = *q.coefficients();
    let square = s1.squared();
    q2 * (s2.squared() + *s1 * *s3 * 2.0) + q3 * (square * *s2 * 3.0) + q4 * square.squared()
}
