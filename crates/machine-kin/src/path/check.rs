//! What the cubics of a segment may do: axes within their ranges, the tool where the machine can
//! be.

use path_timing::{CurveMotion, Span};

use super::bound::{cubics, pieces};
use super::stretch::{ROUNDING, Stretch};
use super::{MachinePath, PathError, of};
use crate::matrix::{Matrix, larger_or_nan, product};
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
    /// that has the speeds v of the parameter there, the axes run the Hermite cubics of q(P(σ(τ))),
    /// which are linear in what they interpolate. With an axis as a Taylor model, Σ aₖ tᵏ ± r with
    /// t = 2σ - 1, the linear part is met; the square is 4 a₂ (σ - ½)², which is off by what σ² is;
    /// and what is left is R, of which the cubic is at most |R| + 4/27 |v₀ R'₀ + v₁ R'₁|, with R'
    /// from q' at both ends:
    ///
    /// ```text
    /// |R| ≤ |a₃| + r    R' = q' - 2 a₁ ∓ 4 a₂    |ε| ≤ 4 |a₂| max |(σ²)⁗|/384 + 2 |R| + 4/27 (v₀ + v₁) max |R'|
    /// ```
    ///
    /// For all cubics with the mean speed 1 and v₀ + v₁ = 2, (σ²)⁗ = 6 σ"² ≤ 24. The squares of all
    /// axes are off by the same share: with Y about the inverse of the Jacobian halfway, Y ε is at
    /// most |Y 4 a₂| max |(σ²)⁗|/384 and |Y| times the rest.
    ///
    /// The tool is then within what all Jacobians in the path's corridor say of that, or those in
    /// one of this segment alone, if that is not beyond the corridor, where the inverse is defined
    /// on its branch, and regular: Newton's map takes it into itself, so there is one such place,
    /// and it goes on from that at the start.
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
        let stretch = Stretch::new(&motion, [0.0, 1.0], self.rounding);
        let errors = self.errors(&stretch, &ends).ok_or(coarse)?;
        let is_free = |off: Option<[f64; N]>| {
            let within = |off: [f64; N]| {
                pieces(FINEST, |part, _| {
                    let places = Stretch::new(&motion, part, self.rounding).places();
                    let beyond = self.beyond_area(&places, &off, s);
                    beyond.is_none().then_some(true)
                })
            };
            off.and_then(within).is_some()
        };
        let most = errors.most();
        let beside = self.beside_of(&motion);
        if is_free(beside.and_then(|path| path.corridor.off(&most))) {
            return Ok(());
        }
        // Of a part of the path more is known.
        let (mut corridors, y) = self.corridors(beside, &stretch, &most).ok_or(coarse)?;
        let made = errors.through(&y);
        let stays = corridors.any(|own| is_free(own.off_by(made)));
        stays.then_some(()).ok_or(coarse)
    }

    /// The most that each axis is off by from the path at the same time: see
    /// [`check_span`](Self::check_span).
    fn errors(&self, stretch: &Stretch<N>, ends: &Ends<N>) -> Option<Errors<N>> {
        let axes = self.axes(stretch).ok()?;
        let [before, after] = &ends.slopes;
        let mut errors = Errors {
            squares: [0.0; N],
            rests: [0.0; N],
        };
        let known = axes.iter().zip(before.iter().zip(after));
        let places = errors.squares.iter_mut().zip(&mut errors.rests);
        for ((of_square, rest), (axis, (before, after))) in places.zip(known) {
            let [_, linear, square, cube] = *axis.coefficients();
            let bends = [
                before - 2.0 * linear + 4.0 * square,
                after - 2.0 * linear - 4.0 * square,
            ];
            let [a, b] = bends.map(f64::abs);
            let rounding = (before.abs() + after.abs()) * MEAN;
            *of_square = 4.0 * square * ends.square / 384.0;
            *rest = 2.0 * (cube.abs() + axis.rest())
                + ends.speeds * (4.0 / 27.0) * (larger_or_nan(a, b) + rounding);
        }
        errors
            .most()
            .iter()
            .all(|error| error.is_finite())
            .then_some(errors)
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

/// The most that axes are off by on a segment.
struct Errors<const N: usize> {
    /// 4 a₂ max |(σ²)⁗|/384: all of them times the same number from -1 to 1.
    squares: [f64; N],
    rests: [f64; N],
}

impl<const N: usize> Errors<N> {
    /// Of each axis.
    fn most(&self) -> [f64; N] {
        let mut most = self.rests;
        for (most, square) in most.iter_mut().zip(self.squares) {
            *most += square.abs();
        }
        most
    }

    /// What a matrix makes of them.
    fn through(&self, y: &Matrix<N>) -> [f64; N] {
        let size = y.map(|row| row.map(f64::abs));
        let mut made = product(&size, &self.rests);
        let rounding = product(&size, &self.squares.map(|square| square.abs() * ROUNDING));
        let squares = product(y, &self.squares);
        for (made, (square, rounding)) in made.iter_mut().zip(squares.iter().zip(rounding)) {
            *made += square.abs() + rounding;
        }
        made
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

/// Shortest pieces of a segment that are looked at for the area, as parts of it.
const FINEST: u32 = 16;

/// The largest speed at an end of a segment, in its lengths, with which a cubic does not turn back
/// whatever the other is.
const MOST: f64 = 3.0;

/// What rounding is of speeds.
const MEAN: f64 = 1e-9;
