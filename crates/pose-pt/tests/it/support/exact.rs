//! Sums of products with 32 digits, in which the rounding of a table's numbers is seen.

use core::ops::{Add, Mul, Sub};

/// The sum of two numbers, the second of the size of what the first rounds off.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(crate) struct Exact(f64, f64);

impl Exact {
    pub(crate) const fn value(self) -> f64 {
        self.0
    }

    pub(crate) fn abs(self) -> Self {
        if self.0 < 0.0 {
            Self::from(0.0) - self
        } else {
            self
        }
    }
}

impl From<f64> for Exact {
    fn from(value: f64) -> Self {
        Self(value, 0.0)
    }
}

/// The sum and what it rounds off (Knuth).
fn sum(a: f64, b: f64) -> Exact {
    let whole = a + b;
    let rest = whole - a;
    Exact(whole, (a - (whole - rest)) + (b - rest))
}

impl Add for Exact {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let Self(whole, rest) = sum(self.0, other.0);
        sum(whole, rest + self.1 + other.1)
    }
}

impl Sub for Exact {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self(-other.0, -other.1)
    }
}

impl Mul for Exact {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let rest = self.0.mul_add(other.0, -product);
        sum(product, rest + self.0 * other.1 + self.1 * other.0)
    }
}
