//! What an inverse kinematics computes with.

use core::fmt::{self, Debug, Display, Formatter};
use core::ops::{Add, Div, Mul, Neg, Sub};

use trig_kernels::SixDigits;

/// A number that an inverse kinematics can be computed with: `f64` for the axes themselves, a
/// [`Jet`](crate::Jet) for their derivatives along a path, a [`Gradient`](crate::Gradient) for
/// those by the tool's coordinates, each of numbers or of [`Interval`](crate::Interval)s.
///
/// Sums, differences, products and quotients also take an `f64` on the right; `T::from(2.0) - x`
/// has one on the left. What divides by a number that is or may be 0 is not known from there on,
/// which is refused at the end.
pub trait Number:
    Copy
    + Debug
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// The square.
    #[must_use]
    fn squared(self) -> Self;

    /// The square root.
    ///
    /// # Errors
    /// [`Refusal`] of a number that is below 0, or may be.
    fn root(self, reason: &'static str) -> Result<Self, Refusal>;

    /// Sine and cosine of an angle in radians.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);

    /// The angle of the vector (x, y) against the axis of x, in radians: at any whole turn, so that
    /// it is an axis by itself, or added to others with whole factors.
    ///
    /// # Errors
    /// [`Refusal`] of a vector that is 0, or may be.
    fn atan2(y: Self, x: Self, reason: &'static str) -> Result<Self, Refusal>;

    /// Whether the number is above 0.
    ///
    /// # Errors
    /// [`Refusal`] where that cannot be decided.
    fn is_positive(self, reason: &'static str) -> Result<bool, Refusal>;

    /// A number that it stands for: itself, the middle of an interval, the value of a jet.
    #[must_use]
    fn middle(self) -> f64;

    /// Refuses what is not above 0.
    ///
    /// # Errors
    /// [`Refusal`] of a number that is 0 or below, or may be.
    fn require_positive(self, reason: &'static str) -> Result<(), Refusal> {
        if self.is_positive(reason)? {
            Ok(())
        } else {
            Err(Refusal::proven(reason, -self.middle()))
        }
    }
}

/// Why an inverse kinematics has no answer: what had to be above 0 is not, or may not be.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Refusal {
    /// In the machine's words.
    pub reason: &'static str,
    /// By how much the number was below 0, in its own unit; not a number where it may be above as
    /// well.
    pub by: f64,
}

impl Refusal {
    pub(crate) const fn proven(reason: &'static str, by: f64) -> Self {
        Self { reason, by }
    }

    pub(crate) const fn undecided(reason: &'static str) -> Self {
        let by = f64::NAN;
        Self { reason, by }
    }
}

impl Display for Refusal {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.by.is_nan() {
            write!(f, "{}, or may", self.reason)
        } else {
            write!(f, "{}, by {}", self.reason, SixDigits(self.by))
        }
    }
}

impl core::error::Error for Refusal {}

impl Number for f64 {
    fn squared(self) -> Self {
        self * self
    }

    fn root(self, reason: &'static str) -> Result<Self, Refusal> {
        // Written so that NaN is refused too.
        if self >= 0.0 {
            Ok(trig_kernels::sqrt(self))
        } else {
            Err(Refusal::proven(reason, -self))
        }
    }

    fn sin_cos(self) -> (Self, Self) {
        trig_kernels::sin_cos(self)
    }

    fn atan2(y: Self, x: Self, reason: &'static str) -> Result<Self, Refusal> {
        if y == 0.0 && x == 0.0 {
            return Err(Refusal::proven(reason, 0.0));
        }
        Ok(trig_kernels::atan2(y, x))
    }

    fn is_positive(self, reason: &'static str) -> Result<bool, Refusal> {
        if self.is_nan() {
            return Err(Refusal::undecided(reason));
        }
        Ok(self > 0.0)
    }

    fn middle(self) -> f64 {
        self
    }
}

/// Sums, differences, products and quotients with an `f64` on the right, and those of two numbers
/// by reference to functions of the type.
macro_rules! operators {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> core::ops::Add for $type {
            type Output = Self;
            #[inline]
            fn add(self, other: Self) -> Self {
                self.plus(other)
            }
        }
        impl<$($generics)*> core::ops::Sub for $type {
            type Output = Self;
            #[inline]
            fn sub(self, other: Self) -> Self {
                self.minus(other)
            }
        }
        impl<$($generics)*> core::ops::Mul for $type {
            type Output = Self;
            #[inline]
            fn mul(self, other: Self) -> Self {
                self.times(other)
            }
        }
        impl<$($generics)*> core::ops::Div for $type {
            type Output = Self;
            #[inline]
            fn div(self, other: Self) -> Self {
                self.over(other)
            }
        }
        impl<$($generics)*> core::ops::Neg for $type {
            type Output = Self;
            #[inline]
            fn neg(self) -> Self {
                self.negated()
            }
        }
        impl<$($generics)*> core::ops::Add<f64> for $type {
            type Output = Self;
            #[inline]
            fn add(self, other: f64) -> Self {
                self.shifted(other)
            }
        }
        impl<$($generics)*> core::ops::Sub<f64> for $type {
            type Output = Self;
            #[inline]
            fn sub(self, other: f64) -> Self {
                self.shifted(-other)
            }
        }
        impl<$($generics)*> core::ops::Mul<f64> for $type {
            type Output = Self;
            #[inline]
            fn mul(self, other: f64) -> Self {
                self.scaled(other)
            }
        }
        impl<$($generics)*> core::ops::Div<f64> for $type {
            type Output = Self;
            #[inline]
            fn div(self, other: f64) -> Self {
                self.divided(other)
            }
        }
    };
}
pub(crate) use operators;
