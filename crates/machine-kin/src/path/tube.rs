//! What the cubics of a segment may do: axes within their ranges, the tool where the machine can
//! be.

use path_timing::{CurveMotion, Span};

use super::bound::{cubics, pieces};
use super::stretch::Stretch;
use super::{MachinePath, PathError, of};
use crate::matrix::{Enclosure, Matrix, inverse, larger_or_nan, product};
use crate::{Interval, Machine};

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

    /// Whether the machine may run a segment: all axes within their ranges, which is exact, and the
    /// tool on its branch and within the area, at these speeds and all others with the same mean.
    ///
    /// Proof. At the ends of the segment the axes are on the path. With σ(τ) the cubic from 0 to 1
    /// that has the speeds of the parameter there, the axes run the Hermite cubics of q(P(σ(τ))),
    /// which are linear in what they interpolate. With q' to q‴ the derivatives by σ, of q‴ the
    /// largest, Taylor's formula from the middle of the segment has a linear part, which is met; a
    /// square, which is off by what σ² is; and a rest R with |R| ≤ q‴/48 and |R'| ≤ q‴/8, of which
    /// the cubic is at most |R| + 4/27 |v₀ R'₀ + v₁ R'₁|:
    ///
    /// ```text
    /// |ε| ≤ |q"(½)|/2 max |(σ²)⁗|/384 + q‴ (1/24 + (v₀ + v₁)/54)
    /// ```
    ///
    /// For all cubics with the mean speed 1 and v₀ + v₁ = 2, (σ²)⁗ = 6 σ"² ≤ 24.
    ///
    /// The tool is then within what [`Enclosure`] says, where the inverse is defined on its branch,
    /// and regular, all over that: Newton's map takes this box into itself, so there is one such
    /// place, and it goes on from that at the start.
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
        let ends = self.ends(span)?;
        let (_, slopes) = self.slopes_at(motion.at(0.5)).map_err(|_| coarse)?;
        let y = inverse(slopes).ok_or(coarse)?.map(|row| row.map(f64::abs));
        // One look is enough for nearly all that a planner asks for. Shorter pieces are known
        // better.
        let stays = |errors: Option<[f64; N]>, finest| {
            errors.is_some_and(|errors| self.stays(&motion, &errors, &y, finest))
        };
        if stays(self.errors_at_once(&motion, &ends), 4) || stays(self.errors(&motion, &ends), 16) {
            return Ok(());
        }
        Err(coarse)
    }

    /// Whether the tool stays near the path, where the axes are off by at most `errors`.
    fn stays(
        &self,
        motion: &CurveMotion<'_, N>,
        errors: &[f64; N],
        inverse: &Matrix<N>,
        finest: u32,
    ) -> bool {
        // What Newton's first step makes of it, and some more.
        let mut radius = product(inverse, errors).map(|off| off * 2.0 + self.rounding);
        for _ in 0..2 {
            let Some(off) = self.off(motion, errors, &radius, finest) else {
                return false;
            };
            // Written so that NaN is none.
            if off.iter().zip(&radius).all(|(off, radius)| off <= radius) {
                return true;
            }
            radius = off.map(|off| off * 1.5 + self.rounding);
        }
        false
    }

    /// The most that each axis is off by from the path at the same time, by one look.
    ///
    /// With an axis as a Taylor model, Σ aₖ tᵏ ± r with t = 2σ - 1, the linear part is met, the
    /// square is 4 a₂ (σ - ½)², and what is left is R, of which |R'| is known at both ends, where
    /// q' is:
    ///
    /// ```text
    /// |R| ≤ |a₃| + r    R' = q' - 2 a₁ ∓ 4 a₂    |ε| ≤ 4 |a₂| max |(σ²)⁗|/384 + 2 |R| + 4/27 (v₀ + v₁) max |R'|
    /// ```
    fn errors_at_once(&self, motion: &CurveMotion<'_, N>, ends: &Ends<N>) -> Option<[f64; N]> {
        let stretch = Stretch::new(motion, [0.0, 1.0], self.rounding);
        let axes = self.axes(&stretch).ok()?;
        let [before, after] = &ends.slopes;
        let mut errors = [0.0; N];
        let known = axes.iter().zip(before.iter().zip(after));
        for (error, (axis, (before, after))) in errors.iter_mut().zip(known) {
            let [_, linear, square, cube] = *axis.coefficients();
            let bends = [
                before - 2.0 * linear + 4.0 * square,
                after - 2.0 * linear - 4.0 * square,
            ];
            let [a, b] = bends.map(f64::abs);
            let rounding = (before.abs() + after.abs()) * MEAN;
            *error = 4.0 * square.abs() * ends.square / 384.0
                + 2.0 * (cube.abs() + axis.rest())
                + ends.speeds * (4.0 / 27.0) * (larger_or_nan(a, b) + rounding);
        }
        errors
            .iter()
            .all(|error| error.is_finite())
            .then_some(errors)
    }

    /// The most that each axis is off by from the path at the same time: see
    /// [`check_span`](Self::check_span).
    fn errors(&self, motion: &CurveMotion<'_, N>, ends: &Ends<N>) -> Option<[f64; N]> {
        let middle = Stretch::new(motion, [0.0, 1.0], self.rounding).middle_jets::<3>();
        let middle = self.machine.inverse(middle, self.branch).ok()?;
        let mut errors = [0.0; N];
        pieces(4, 16, |part, _| {
            let jets = Stretch::new(motion, part, self.rounding).jets::<4>();
            let axes = self.machine.inverse(jets, self.branch).ok()?;
            for (error, axis) in errors.iter_mut().zip(axes) {
                let [.., third] = *axis.coefficients();
                let third = third.magnitude() * 6.0;
                *error = larger_or_nan(*error, third * (1.0 / 24.0 + ends.speeds / 54.0));
            }
            errors.iter().all(|error| error.is_finite()).then_some(true)
        })?;
        for (error, axis) in errors.iter_mut().zip(middle) {
            let [.., second] = *axis.coefficients();
            *error += second.magnitude() * ends.square / 384.0;
        }
        Some(errors)
    }

    /// The most that the tool is off by in each coordinate, from where the inverse is looked at
    /// within `radius` of the curve. None where it is not known, or may be out of the area.
    fn off(
        &self,
        motion: &CurveMotion<'_, N>,
        errors: &[f64; N],
        radius: &[f64; N],
        finest: u32,
    ) -> Option<[f64; N]> {
        let mut most = [0.0; N];
        pieces(1, finest, |part, can_halve| {
            let stretch = Stretch::new(motion, part, self.rounding);
            let around = self.around(&stretch, radius).ok()?;
            let enclosure = Enclosure::new(&around.slopes())?;
            if can_halve && enclosure.spread() > GOOD {
                return Some(false);
            }
            let off = enclosure.off(errors);
            if self
                .beyond_area(&stretch.places(), &off, [0.0; 2])
                .is_some()
            {
                return None;
            }
            for (most, off) in most.iter_mut().zip(off) {
                *most = larger_or_nan(*most, off);
            }
            Some(true)
        })?;
        Some(most)
    }

    /// What is known of both ends of a segment.
    fn ends(&self, span: &Span<[f64; N]>) -> Result<Ends<N>, PathError<N>> {
        let ([s0, s1], [from, to]) = (span.s, &span.rows);
        let (mut speeds, mut slopes) = ([0.0; 2], [[0.0; N]; 2]);
        let known = speeds.iter_mut().zip(&mut slopes);
        for ((speed, slopes), (s, row)) in known.zip([(s0, from), (s1, to)]) {
            let slope = of(&self.jets::<2>(s)?, 1);
            *slopes = slope.map(|slope| slope * (s1 - s0));
            let (mut along, mut square) = (0.0, 0.0);
            for (slope, velocity) in slope.iter().zip(row.velocity) {
                (along, square) = (along + slope * velocity, square + slope * slope);
            }
            *speed = along / square * to.duration_s / (s1 - s0);
        }
        let [a, b] = speeds;
        // Written so that NaN is refused too: others turn back, beyond the segment.
        let is_forward = speeds
            .iter()
            .all(|speed| *speed >= -MEAN && *speed <= MOST + MEAN);
        if !is_forward {
            return Err(PathError::TooCoarse { s: span.s });
        }
        // σ" at both ends, σ‴, and the largest σ', which lies between control points.
        let ends = [6.0 - 4.0 * a - 2.0 * b, 4.0 * b + 2.0 * a - 6.0].map(f64::abs);
        let third = 6.0 * (a + b - 2.0);
        let fastest = [a, b, 3.0 - a - b].map(f64::abs);
        let [second, first] = [
            ends.into_iter().fold(2.0, larger_or_nan),
            fastest.into_iter().fold(2.0, larger_or_nan),
        ];
        let square = 6.0 * second * second + 8.0 * first * third.abs();
        Ok(Ends {
            speeds: larger_or_nan(2.0, a.abs() + b.abs()),
            square: square * (1.0 + MEAN),
            slopes,
        })
    }
}

/// What is known of both ends of a segment.
struct Ends<const N: usize> {
    /// The most that the speeds add up to, in its lengths, for these and all others with the
    /// mean 1.
    speeds: f64,
    /// The most that (σ²)⁗ is for all of these.
    square: f64,
    /// Slopes of the axes by σ.
    slopes: [[f64; N]; 2],
}

/// The largest speed at an end of a segment, in its lengths, with which a cubic does not turn back
/// whatever the other is.
const MOST: f64 = 3.0;

/// Pieces whose slopes are known better than this are not halved.
const GOOD: f64 = 0.5;

/// What rounding is of speeds.
const MEAN: f64 = 1e-9;
