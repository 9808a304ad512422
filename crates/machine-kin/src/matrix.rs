//! Small square matrices: inverses, and how an interval matrix is enclosed by one.

use crate::Number;

pub(crate) type Matrix<const N: usize> = [[f64; N]; N];

/// The inverse by Gauss and Jordan with the largest pivot of each column; none of a matrix that is
/// singular to rounding.
#[expect(clippy::indexing_slicing, reason = "rows and columns are below N")]
pub(crate) fn inverse<const N: usize>(mut m: Matrix<N>) -> Option<Matrix<N>> {
    let mut inverse = [[0.0; N]; N];
    for (number, row) in inverse.iter_mut().enumerate() {
        row[number] = 1.0;
    }
    for column in 0..N {
        let size = |row: &usize| m[*row][column].abs();
        let pivot = (column..N).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        m.swap(column, pivot);
        inverse.swap(column, pivot);
        let factor = 1.0 / m[column][column];
        if !factor.is_finite() {
            return None;
        }
        for k in 0..N {
            m[column][k] *= factor;
            inverse[column][k] *= factor;
        }
        for row in 0..N {
            if row == column {
                continue;
            }
            let factor = m[row][column];
            for k in 0..N {
                m[row][k] -= factor * m[column][k];
                inverse[row][k] -= factor * inverse[column][k];
            }
        }
    }
    Some(inverse)
}

/// The product of a matrix and a vector.
pub(crate) fn product<const N: usize>(m: &Matrix<N>, v: &[f64; N]) -> [f64; N] {
    m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

/// Euclidean length.
pub(crate) fn norm<const N: usize>(v: &[f64; N]) -> f64 {
    trig_kernels::sqrt(v.iter().map(|x| x * x).sum::<f64>())
}

/// The larger; not a number where one is none.
pub(crate) fn larger_or_nan(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The largest of some numbers; not a number where one is none.
pub(crate) fn largest<const N: usize>(v: &[f64; N]) -> f64 {
    v.iter().fold(0.0, |most, x| larger_or_nan(most, *x))
}

/// A number of which the most that it can be is known.
pub(crate) trait Bounded: Number {
    /// The largest distance from 0.
    fn most(&self) -> f64;
}

/// I - Y J
pub(crate) fn from_one<T: Number, const N: usize>(
    y: &Matrix<N>,
    slopes: &[[T; N]; N],
) -> [[T; N]; N] {
    let mut difference = [[T::from(0.0); N]; N];
    for (number, (row, factors)) in difference.iter_mut().zip(y).enumerate() {
        if let Some(own) = row.get_mut(number) {
            *own = T::from(1.0);
        }
        for (factor, slopes) in factors.iter().zip(slopes) {
            for (value, slope) in row.iter_mut().zip(slopes) {
                *value = *value - *slope * *factor;
            }
        }
    }
    difference
}

/// All matrices that the slopes of the axes by the tool's coordinates can be on a piece of a path.
///
/// With Y the inverse of the matrix in their middle and J any of them, also a mean of some,
///
/// ```text
/// J e = ε     e = Y ε + (I - Y J) e     |eᵢ| ≤ bᵢ + rᵢ max |e|,   b = |Y| |ε|,  rᵢ = Σⱼ |I - Y J|ᵢⱼ
/// ```
///
/// so that max |e| ≤ max b / (1 - max r) where max r < 1: there every such J has an inverse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Enclosure<const N: usize> {
    /// |Y|
    inverse: Matrix<N>,
    /// r
    rest: [f64; N],
}

impl<const N: usize> Enclosure<N> {
    /// None where some of them may be singular.
    pub(crate) fn new<T: Bounded>(slopes: &[[T; N]; N]) -> Option<Self> {
        let y = inverse(slopes.map(|row| row.map(Number::middle)))?;
        Self::by(&y, slopes)
    }

    /// The same by an inverse of one of them, or about one.
    pub(crate) fn by<T: Bounded>(y: &Matrix<N>, slopes: &[[T; N]; N]) -> Option<Self> {
        let rest = from_one(y, slopes).map(|row| row.iter().map(Bounded::most).sum());
        // Written so that NaN is singular.
        let is_regular = largest(&rest) < 1.0;
        is_regular.then_some(Self {
            inverse: y.map(|row| row.map(f64::abs)),
            rest: rest.map(up),
        })
    }

    /// Of no matrix.
    pub(crate) const NONE: Self = Self {
        inverse: [[0.0; N]; N],
        rest: [0.0; N],
    };

    /// |Y|
    pub(crate) const fn inverse(&self) -> &Matrix<N> {
        &self.inverse
    }

    /// How many times these sums the rows of others may differ by for the spread to be `most`.
    pub(crate) fn room(&self, rows: &[f64; N], most: f64) -> f64 {
        (most - self.spread()) / largest(&product(&self.inverse, rows))
    }

    /// With others beside them, the rows of which differ by no more than these sums.
    pub(crate) fn with_others(&self, rows: &[f64; N]) -> Option<Self> {
        let mut rest = self.rest;
        for (rest, apart) in rest.iter_mut().zip(product(&self.inverse, rows)) {
            *rest = up(*rest + apart);
        }
        // Written so that NaN is singular.
        let is_regular = largest(&rest) < 1.0;
        let inverse = self.inverse;
        is_regular.then_some(Self { inverse, rest })
    }

    /// What is true of those of both.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let mut rest = self.rest;
        for (rest, other) in rest.iter_mut().zip(other.rest) {
            *rest = larger_or_nan(*rest, other);
        }
        Self {
            inverse: both(&self.inverse, &other.inverse, 0.0, larger_or_nan),
            rest,
        }
    }

    /// How far the matrices are from that in their middle: below 1.
    pub(crate) fn spread(&self) -> f64 {
        largest(&self.rest)
    }

    /// The most that each coordinate of the tool is off by where each axis is off by as much.
    pub(crate) fn off(&self, axes: &[f64; N]) -> [f64; N] {
        self.bounded(product(&self.inverse, axes))
    }

    /// The most that each coordinate is off by where matrices that are apart by no more than said,
    /// of what is off by `most`, make the axes off.
    pub(crate) fn between(&self, apart: &Matrix<N>, most: f64) -> [f64; N] {
        let axes = apart.map(|row| row.iter().sum::<f64>() * most);
        self.off(&axes)
    }

    /// From b.
    pub(crate) fn bounded(&self, b: [f64; N]) -> [f64; N] {
        let most = largest(&b) / (1.0 - self.spread());
        let mut off = b;
        for (off, rest) in off.iter_mut().zip(self.rest) {
            *off = up(*off + rest * most);
        }
        off
    }
}

/// Above what the rounding of a few sums of what is not negative may lose.
fn up(x: f64) -> f64 {
    x * (1.0 + 64.0 * f64::EPSILON)
}

/// What a function of two numbers makes of both matrices, one by one.
pub(crate) fn both<A: Copy, B: Copy, C: Copy, const N: usize>(
    a: &[[A; N]; N],
    b: &[[B; N]; N],
    zero: C,
    of: impl Fn(A, B) -> C,
) -> [[C; N]; N] {
    let mut result = [[zero; N]; N];
    for (row, (a, b)) in result.iter_mut().zip(a.iter().zip(b)) {
        for (value, (a, b)) in row.iter_mut().zip(a.iter().zip(b)) {
            *value = of(*a, *b);
        }
    }
    result
}
