//! Polynomial curves up to the fifth degree, and their arc length.

use super::vector::{along, dot, norm, scaled};
use super::{CurveError, Jet};
use crate::number::{larger_or_nan, sqrt};

/// Most intervals of the parameter in which the arc length is tabulated.
const INTERVALS: usize = 32;

/// The difference of |dP/ds| from 1 at which no more intervals are tried.
const GOOD_SPEED: f64 = 1e-6;

/// The difference beyond which the curve counts as having a cusp.
const MAX_SPEED_ERROR: f64 = 0.01;

/// Places of an interval at which the speed is looked at.
const LOOKS: u32 = 8;

/// Abscissas and weights of the Gauss-Legendre rule of 8 points, one half of each.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

/// k!
const FACTORIALS: [f64; 6] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0];

/// A polynomial curve over t = 0..=1. Between equal steps of t the parameter is a quintic of the
/// arc length with the right derivatives at both ends: t(s) is smooth to the second derivative, and
/// dP/ds is the derivative of what is computed, whatever its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polynomial<const D: usize> {
    /// Of 1, t, t², ...
    coefficients: [[f64; D]; 6],
    /// Arc lengths at equal steps of t; those beyond `intervals` are the whole length.
    lengths: [f64; INTERVALS],
    intervals: u8,
    speed_error: f64,
}

impl<const D: usize> Polynomial<D> {
    /// The Bézier curve of the control points, at most six.
    pub(super) fn new<const N: usize>(mut points: [[f64; D]; N]) -> Result<Self, CurveError> {
        let mut coefficients = [[0.0; D]; 6];
        let (mut binomial, mut remaining, mut taken) = (1.0, 0.0, 0.0);
        for _ in 1..N {
            remaining += 1.0;
        }
        // Forward differences of the control points times the binomials.
        for coefficient in coefficients.iter_mut().take(N) {
            let [first, ..] = &points[..] else { break };
            *coefficient = scaled(first, binomial);
            taken += 1.0;
            binomial *= remaining / taken;
            remaining -= 1.0;
            let mut rest = points.iter_mut().peekable();
            while let Some(point) = rest.next() {
                if let Some(next) = rest.peek() {
                    *point = along(next, -1.0, point);
                }
            }
        }
        let mut curve = Self {
            coefficients,
            lengths: [0.0; INTERVALS],
            intervals: 0,
            speed_error: f64::INFINITY,
        };
        for intervals in [2, 4, 8, 16, 32] {
            curve.tabulate(intervals);
            curve.speed_error = curve.largest_speed_error();
            if curve.speed_error <= GOOD_SPEED {
                break;
            }
        }
        if curve.length() <= 0.0 {
            return Err(CurveError::NoLength {
                length: curve.length(),
            });
        }
        // Written so that NaN is refused too.
        if curve.speed_error <= MAX_SPEED_ERROR {
            Ok(curve)
        } else if curve.length().is_finite() {
            Err(CurveError::Cusp {
                parameter: curve.slowest(),
            })
        } else {
            Err(CurveError::NotFinite)
        }
    }

    pub(super) fn length(&self) -> f64 {
        let [.., last] = self.lengths;
        last
    }

    pub(super) const fn speed_error(&self) -> f64 {
        self.speed_error
    }

    fn step(&self) -> f64 {
        1.0 / f64::from(self.intervals)
    }

    /// Fills the table of arc lengths by quadrature.
    fn tabulate(&mut self, intervals: u8) {
        self.intervals = intervals;
        let (half, mut sum) = (self.step() * 0.5, 0.0);
        let mut lengths = [0.0; INTERVALS];
        for (index, length) in (0..intervals).zip(&mut lengths) {
            let middle = (2.0 * f64::from(index) + 1.0) * half;
            for [at, weight] in GAUSS {
                let speeds = [middle - at * half, middle + at * half].map(|t| {
                    let [_, first, ..] = self.jet(t);
                    norm(&first)
                });
                sum += weight * half * (speeds[0] + speeds[1]);
            }
            *length = sum;
        }
        for length in lengths.iter_mut().skip(intervals.into()) {
            *length = sum;
        }
        self.lengths = lengths;
    }

    /// Twice the largest difference of |dP/ds| from 1 that is found.
    fn largest_speed_error(&self) -> f64 {
        let (mut worst, mut from) = (0.0, 0.0);
        for to in self.lengths.iter().take(self.intervals.into()) {
            for look in 0..LOOKS {
                let s = from + (to - from) * (f64::from(look) + 0.5) / f64::from(LOOKS);
                let [t, by_s, _] = self.parameter(s);
                let [_, first, ..] = self.jet(t);
                worst = larger_or_nan(worst, (norm(&first) * by_s - 1.0).abs());
            }
            from = *to;
        }
        2.0 * worst
    }

    /// Where |dP/dt| is least, to the interval.
    fn slowest(&self) -> f64 {
        let parameters = (0..=self.intervals).map(|end| f64::from(end) * self.step());
        let speeds = parameters.map(|t| {
            let [_, first, ..] = self.jet(t);
            (norm(&first), t)
        });
        let first = (f64::INFINITY, 0.0);
        let (_, slowest) = speeds.fold(first, |a, b| if b.0 < a.0 { b } else { a });
        slowest
    }

    /// Derivatives 0 to 5 at t, by Taylor's shift of the polynomial.
    pub(super) fn jet(&self, t: f64) -> Jet<D> {
        let mut jet = self.coefficients;
        for first in 0..jet.len() {
            let mut above = [0.0; D];
            for coefficient in jet.iter_mut().skip(first).rev() {
                *coefficient = along(coefficient, t, &above);
                above = *coefficient;
            }
        }
        for (derivative, factorial) in jet.iter_mut().zip(FACTORIALS) {
            *derivative = scaled(derivative, factorial);
        }
        jet
    }

    /// t at the arc length s, and its first two derivatives.
    pub(super) fn parameter(&self, s: f64) -> [f64; 3] {
        let (mut from, mut index) = (0.0, 0_u8);
        let mut ends = self.lengths.iter().take(self.intervals.into()).peekable();
        let mut to = self.length();
        while let Some(end) = ends.next() {
            to = *end;
            if s <= to || ends.peek().is_none() {
                break;
            }
            (from, index) = (to, index.saturating_add(1));
        }
        let start = f64::from(index) * self.step();
        let width = to - from;
        let [a, b] = [start, start + self.step()].map(|t| self.rates(t));
        let quintic = hermite(
            [start, a[0] * width, a[1] * width * width],
            [start + self.step(), b[0] * width, b[1] * width * width],
            (s - from) / width,
        );
        [quintic[0], quintic[1] / width, quintic[2] / (width * width)]
    }

    /// dt/ds and d²t/ds² at t.
    ///
    /// ```text
    /// t' = 1/|P'|    t" = -(P' · P") / |P'|⁴
    /// ```
    fn rates(&self, t: f64) -> [f64; 2] {
        let [_, first, second, ..] = self.jet(t);
        let square = dot(&first, &first);
        [
            1.0 / sqrt(square),
            -dot(&first, &second) / (square * square),
        ]
    }
}

/// The quintic with given value and two derivatives at 0 and at 1: its own at x.
fn hermite([a0, a1, a2]: [f64; 3], [b0, b1, b2]: [f64; 3], x: f64) -> [f64; 3] {
    let rise = b0 - a0 - a1 - a2 * 0.5;
    let slope = b1 - a1 - a2;
    let bend = b2 - a2;
    let c3 = 10.0 * rise - 4.0 * slope + 0.5 * bend;
    let c4 = -15.0 * rise + 7.0 * slope - bend;
    let c5 = 6.0 * rise - 3.0 * slope + 0.5 * bend;
    [
        a0 + x * (a1 + x * (a2 * 0.5 + x * (c3 + x * (c4 + x * c5)))),
        a1 + x * (a2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5))),
        a2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5)),
    ]
}

/// The longest that derivatives 1 to 4 are within `half` of where the jet was taken: the sum of the
/// lengths of Taylor's terms, of which there are no more.
pub(super) fn longest<const D: usize>(jet: &Jet<D>, half: f64) -> [f64; 4] {
    let mut result = [0.0; 4];
    for (first, longest) in (1..).zip(&mut result) {
        let mut power = 1.0;
        for (derivative, factorial) in jet.iter().skip(first).zip(FACTORIALS) {
            *longest += norm(derivative) * power / factorial;
            power *= half;
        }
    }
    result
}
