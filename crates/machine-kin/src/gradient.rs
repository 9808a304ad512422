//! Derivatives by the tool's coordinates.

use crate::number::{Number, Refusal, operators};

/// A number with its derivatives by `N` variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradient<T, const N: usize> {
    value: T,
    slopes: [T; N],
}

impl<T: Number, const N: usize> Gradient<T, N> {
    /// A value and its derivatives.
    #[must_use]
    pub const fn new(value: T, slopes: [T; N]) -> Self {
        Self { value, slopes }
    }

    /// The variables themselves: the derivative of each is 1 by itself and 0 by the others.
    #[must_use]
    #[inline]
    pub fn variables(values: [T; N]) -> [Self; N] {
        let mut number = 0_usize;
        values.map(|value| {
            let mut slopes = [T::from(0.0); N];
            if let Some(own) = slopes.get_mut(number) {
                *own = T::from(1.0);
            }
            number = number.saturating_add(1);
            Self { value, slopes }
        })
    }

    /// The value.
    #[must_use]
    pub const fn value(&self) -> T {
        self.value
    }

    /// The derivatives.
    #[must_use]
    pub const fn slopes(&self) -> &[T; N] {
        &self.slopes
    }

    /// What a function of one number makes of it: its value there and its derivative.
    #[inline]
    fn through(self, value: T, derivative: T) -> Self {
        Self {
            value,
            slopes: self.slopes.map(|slope| slope * derivative),
        }
    }

    #[inline]
    fn combined(self, other: Self, value: T, of: impl Fn(T, T) -> T) -> Self {
        let mut slopes = self.slopes;
        for (a, b) in slopes.iter_mut().zip(other.slopes) {
            *a = of(*a, b);
        }
        Self { value, slopes }
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self.combined(other, self.value + other.value, |a, b| a + b)
    }

    #[inline]
    fn minus(self, other: Self) -> Self {
        self.combined(other, self.value - other.value, |a, b| a - b)
    }

    #[inline]
    fn negated(self) -> Self {
        Self {
            value: -self.value,
            slopes: self.slopes.map(|slope| -slope),
        }
    }

    #[inline]
    fn shifted(self, by: f64) -> Self {
        Self {
            value: self.value + by,
            ..self
        }
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        Self {
            value: self.value * by,
            slopes: self.slopes.map(|slope| slope * by),
        }
    }

    #[inline]
    fn divided(self, by: f64) -> Self {
        Self {
            value: self.value / by,
            slopes: self.slopes.map(|slope| slope / by),
        }
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let (u, v) = (self.value, other.value);
        self.combined(other, u * v, |a, b| a * v + b * u)
    }

    #[inline]
    fn over(self, other: Self) -> Self {
        let inverse = T::from(1.0) / other.value;
        let quotient = self.value * inverse;
        self.combined(other, quotient, |a, b| (a - b * quotient) * inverse)
    }

    /// A refusal whose amount is a distance: divided by the length of the gradient.
    fn as_distance(&self, refusal: Refusal) -> Refusal {
        let square = self.slopes.map(|slope| slope.middle() * slope.middle());
        let length = trig_kernels::sqrt(square.into_iter().sum::<f64>());
        Refusal {
            by: refusal.by / length,
            ..refusal
        }
    }
}

impl<T: Number, const N: usize> From<f64> for Gradient<T, N> {
    #[inline]
    fn from(value: f64) -> Self {
        Self {
            value: T::from(value),
            slopes: [T::from(0.0); N],
        }
    }
}

operators!([T: Number, const N: usize] Gradient<T, N>);

impl<T: Number, const N: usize> Number for Gradient<T, N> {
    #[inline]
    fn squared(self) -> Self {
        self.through(self.value.squared(), self.value * 2.0)
    }

    fn root(self, reason: &'static str) -> Result<Self, Refusal> {
        let root = self.value.root(reason);
        let root = root.map_err(|refusal| self.as_distance(refusal))?;
        Ok(self.through(root, T::from(0.5) / root))
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.through(sin, cos), self.through(cos, -sin))
    }

    fn atan2(y: Self, x: Self, reason: &'static str) -> Result<Self, Refusal> {
        let angle = T::atan2(y.value, x.value, reason)?;
        let inverse = T::from(1.0) / (x.value.squared() + y.value.squared());
        let (u, v) = (y.value * inverse, x.value * inverse);
        Ok(y.combined(x, angle, |by_y, by_x| by_y * v - by_x * u))
    }

    fn is_positive(self, reason: &'static str) -> Result<bool, Refusal> {
        self.value.is_positive(reason)
    }

    fn middle(self) -> f64 {
        self.value.middle()
    }

    fn require_positive(self, reason: &'static str) -> Result<(), Refusal> {
        let required = self.value.require_positive(reason);
        required.map_err(|refusal| self.as_distance(refusal))
    }
}
