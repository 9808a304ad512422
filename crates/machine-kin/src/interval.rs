//! Intervals whose ends are rounded outwards.
//!
//! Sums, products, quotients and roots of `f64` are off by at most half a unit of the last place, so the
//! exact one is between the neighbours of the computed one. Those are enclosed by
//!
//! ```text
//! x ± (|x| ε + m)      ε = 2⁻⁵², m = 2⁻³⁰⁰
//! ```
//!
//! for |x| ε is at least a unit of the last place of x, and rounding keeps the order of numbers; m is
//! above what is lost where a result underflows, and keeps numbers away from those that processors are
//! slow with. Sines, cosines and arc tangents of `trig-kernels` are
//! off by less than a unit of their last place, which is that of the exact number: two units of the
//! computed one.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use trig_kernels::{atan2, sin_cos, sqrt};

use crate::number::{Number, Refusal, operators};

/// The numbers between two ends. Where nothing is known of a number any more, after a division by what
/// may be 0, both ends are not numbers, and so are those of all that is computed from it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interval {
    low: f64,
    high: f64,
}

/// 2⁻³⁰⁰
const LEAST: f64 = f64::from_bits((1023 - 300) << 52);

/// The next number below, or one of the next few.
#[inline]
fn down(x: f64) -> f64 {
    x - (x.abs() * f64::EPSILON + LEAST)
}

/// The next number above, or one of the next few.
#[inline]
fn up(x: f64) -> f64 {
    x + (x.abs() * f64::EPSILON + LEAST)
}

/// The smaller; the second where one is not a number.
#[inline]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger; the second where one is not a number.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl Interval {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self {
        low: f64::NAN,
        high: f64::NAN,
    };

    /// From the lower to the upper end; [`UNKNOWN`](Self::UNKNOWN) where these are not in their order
    /// or not finite.
    #[must_use]
    #[inline]
    pub fn new(low: f64, high: f64) -> Self {
        // Infinite ends would make NaN of products with 0, which comparisons lose.
        let is_known = low <= high && high - low < f64::INFINITY;
        if is_known {
            Self { low, high }
        } else {
            Self::UNKNOWN
        }
    }

    /// Around a number, by so much to both sides, rounded outwards.
    #[must_use]
    #[inline]
    pub fn around(middle: f64, by: f64) -> Self {
        Self::rounded(middle - by, middle + by)
    }

    /// Lower end.
    #[must_use]
    #[inline]
    pub const fn low(&self) -> f64 {
        self.low
    }

    /// Upper end.
    #[must_use]
    #[inline]
    pub const fn high(&self) -> f64 {
        self.high
    }

    /// The largest distance from 0.
    #[must_use]
    #[inline]
    pub fn magnitude(&self) -> f64 {
        larger(-self.low, self.high)
    }

    /// From the lower to the upper end, rounded up.
    #[must_use]
    #[inline]
    pub fn width(&self) -> f64 {
        up(self.high - self.low)
    }

    /// What is in both of two intervals that hold the same number; of one that is not known, the other.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        if self.low.is_nan() {
            return other;
        }
        // An end that is not a number is beyond none.
        let low = larger(other.low, self.low);
        Self::new(low, smaller(other.high, self.high))
    }

    #[inline]
    fn rounded(low: f64, high: f64) -> Self {
        Self::new(down(low), up(high))
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self::rounded(self.low + other.low, self.high + other.high)
    }

    #[inline]
    fn minus(self, other: Self) -> Self {
        Self::rounded(self.low - other.high, self.high - other.low)
    }

    #[inline]
    fn shifted(self, by: f64) -> Self {
        Self::rounded(self.low + by, self.high + by)
    }

    #[inline]
    fn negated(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }

    #[inline]
    fn hull([a, b, c, d]: [f64; 4]) -> Self {
        let low = smaller(smaller(a, b), smaller(c, d));
        let high = larger(larger(a, b), larger(c, d));
        Self::rounded(low, high)
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        Self::hull([
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ])
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        let (a, b) = (self.low * by, self.high * by);
        Self::rounded(smaller(a, b), larger(a, b))
    }

    #[inline]
    fn divided(self, by: f64) -> Self {
        if by == 0.0 {
            return Self::UNKNOWN;
        }
        let (a, b) = (self.low / by, self.high / by);
        Self::rounded(smaller(a, b), larger(a, b))
    }

    #[inline]
    fn over(self, other: Self) -> Self {
        // Written so that NaN is unknown too.
        let is_apart = other.low > 0.0 || other.high < 0.0;
        if !is_apart {
            return Self::UNKNOWN;
        }
        Self::hull([
            self.low / other.low,
            self.low / other.high,
            self.high / other.low,
            self.high / other.high,
        ])
    }

    /// The interval of a function that trig-kernels is off by less than a unit of the last place.
    fn of_kernel(low: f64, high: f64) -> Self {
        Self::new(down(down(low)), up(up(high)))
    }
}

impl From<f64> for Interval {
    #[inline]
    fn from(value: f64) -> Self {
        Self::new(value, value)
    }
}

operators!([] Interval);

/// Whether a whole multiple of 2π past `phase` may lie in the interval.
fn may_meet(interval: &Interval, phase: f64) -> bool {
    // Far more than what rounding is off by.
    const SLACK: f64 = 1e-9;
    let turns = |x: f64| (x - phase) / TAU;
    let (from, to) = (turns(interval.low), turns(interval.high));
    let slack = SLACK + larger(from.abs(), to.abs()) * SLACK;
    let is_between = libm::floor(to + slack) > libm::floor(from - slack);
    is_between || slack > 0.25
}

/// The angles of a box right of the axis of y.
fn angles_right(y: Interval, x: Interval) -> Interval {
    // The angle falls with x above the axis and rises with it below.
    let low = atan2(y.low, if y.low >= 0.0 { x.high } else { x.low });
    let high = atan2(y.high, if y.high >= 0.0 { x.low } else { x.high });
    Interval::of_kernel(low, high)
}

impl Number for Interval {
    #[inline]
    fn squared(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        let least = if self.low > 0.0 || self.high < 0.0 {
            smaller(a, b)
        } else {
            0.0
        };
        let square = Self::rounded(least, larger(a, b));
        // A square is not below 0, unless it is unknown.
        Self::new(larger(0.0, square.low), square.high)
    }

    fn root(self, reason: &'static str) -> Result<Self, Refusal> {
        if self.low >= 0.0 {
            let root = Self::rounded(sqrt(self.low), sqrt(self.high));
            return Ok(Self::new(larger(0.0, root.low), root.high));
        }
        if self.high < 0.0 {
            return Err(Refusal::proven(reason, -self.high));
        }
        Err(Refusal::undecided(reason))
    }

    fn sin_cos(self) -> (Self, Self) {
        // Written so that NaN is any angle.
        let is_short = self.high - self.low < TAU;
        if !is_short {
            let any = Self::new(-1.0, 1.0);
            return (any, any);
        }
        let (from, to) = (sin_cos(self.low), sin_cos(self.high));
        let hull = |a: f64, b: f64, top: f64| {
            let between = Self::of_kernel(smaller(a, b), larger(a, b));
            let low = if may_meet(&self, top + PI) {
                -1.0
            } else {
                larger(-1.0, between.low)
            };
            let high = if may_meet(&self, top) {
                1.0
            } else {
                smaller(1.0, between.high)
            };
            Self::new(low, high)
        };
        (hull(from.0, to.0, FRAC_PI_2), hull(from.1, to.1, 0.0))
    }

    fn atan2(y: Self, x: Self, reason: &'static str) -> Result<Self, Refusal> {
        if x.low > 0.0 {
            Ok(angles_right(y, x))
        } else if y.low > 0.0 {
            Ok(angles_right(-x, y) + Self::around(FRAC_PI_2, f64::EPSILON))
        } else if y.high < 0.0 {
            Ok(angles_right(x, -y) - Self::around(FRAC_PI_2, f64::EPSILON))
        } else if x.high < 0.0 {
            Ok(angles_right(-y, -x) + Self::around(PI, f64::EPSILON))
        } else {
            Err(Refusal::undecided(reason))
        }
    }

    fn is_positive(self, reason: &'static str) -> Result<bool, Refusal> {
        if self.low > 0.0 {
            Ok(true)
        } else if self.high <= 0.0 {
            Ok(false)
        } else {
            Err(Refusal::undecided(reason))
        }
    }

    fn middle(self) -> f64 {
        self.low * 0.5 + self.high * 0.5
    }
}
