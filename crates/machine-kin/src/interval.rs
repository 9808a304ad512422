//! Intervals as a middle and a radius, which is rounded up.
//!
//! ```text
//! a ± r     sum      a + b,   r + s
//!           product  a b,     |a| s + r (|b| + s)
//!           quotient a / b,   (r + |a / b| s) / (|b| - s)
//! ```
//!
//! The middle of a result is off by at most half a unit of its last place, that is ε/2 of it with
//! ε = 2⁻⁵², or by less than m = 2⁻³⁰⁰ where it underflows: its radius has ε times the middle and m
//! in it. A radius is computed of numbers that are not negative in less than ten steps, each off by
//! at most ε/2 of its result: times 1 + 8 ε it is too large. m also keeps numbers away from those
//! that processors are slow with. Sines, cosines and arc tangents of `trig-kernels` are off by less
//! than a unit of their last place, which is that of the exact number: 2 ε.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use trig_kernels::{atan2, sin_cos, sqrt};

use crate::matrix::Bounded;
use crate::number::{Number, Refusal, operators};

/// The numbers between two ends. Where nothing is known of a number any more, after a division by
/// what may be 0, both ends are not numbers, and so are those of all that is computed from it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interval {
    middle: f64,
    /// Infinite or not a number where nothing is known.
    radius: f64,
}

/// 2⁻³⁰⁰
pub(crate) const LEAST: f64 = f64::from_bits((1023 - 300) << 52);

/// What a radius may have lost in its computation.
pub(crate) const LOST: f64 = 1.0 + 8.0 * f64::EPSILON;

/// Radius of an angle, in radians, up to which it is looked at from its middle.
const SHORT: f64 = 0.25;

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

/// A sum rounded down, which is exact where it can be.
fn sum_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    // What rounding has lost, exactly (Knuth).
    let of_b = sum - a;
    let lost = (a - (sum - of_b)) + (b - of_b);
    if lost < 0.0 { down(sum) } else { sum }
}

impl Interval {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self {
        middle: f64::NAN,
        radius: f64::NAN,
    };

    /// From the lower to the upper end; [`UNKNOWN`](Self::UNKNOWN) where these are not in their
    /// order or not finite.
    #[must_use]
    pub fn new(low: f64, high: f64) -> Self {
        let is_known = low <= high && high - low < f64::INFINITY;
        if !is_known {
            return Self::UNKNOWN;
        }
        let middle = low * 0.5 + high * 0.5;
        let radius = larger(middle - low, high - middle);
        let is_exact = low == 0.0 || high == 0.0 || high - low == 0.0 || high + low == 0.0;
        let radius = if is_exact { radius } else { up(radius) };
        Self { middle, radius }
    }

    /// Around a number, by so much to both sides.
    #[must_use]
    #[inline]
    pub const fn around(middle: f64, by: f64) -> Self {
        // Of what is infinite or not a number nothing is known.
        let radius = by + middle * 0.0;
        Self { middle, radius }
    }

    /// Lower end.
    #[must_use]
    pub fn low(&self) -> f64 {
        -self.negated().high()
    }

    /// Upper end.
    #[must_use]
    pub fn high(&self) -> f64 {
        if self.is_known() {
            -sum_down(-self.middle, -self.radius)
        } else {
            f64::NAN
        }
    }

    /// The largest distance from 0.
    #[must_use]
    #[inline]
    pub const fn magnitude(&self) -> f64 {
        (self.middle.abs() + self.radius) * LOST
    }

    /// From the lower to the upper end, rounded up.
    #[must_use]
    #[inline]
    pub const fn width(&self) -> f64 {
        self.radius * 2.0
    }

    /// Half of that, rounded up.
    #[inline]
    pub(crate) const fn radius(&self) -> f64 {
        self.radius
    }

    #[inline]
    fn is_known(&self) -> bool {
        // Written so that NaN is not.
        self.radius < f64::INFINITY
    }

    /// Around what was computed as `middle`, with a radius that was computed as `radius`, of a
    /// product.
    #[inline]
    fn of_product(middle: f64, radius: f64) -> Self {
        Self {
            middle,
            radius: (radius + (middle.abs() * f64::EPSILON + LEAST)) * LOST,
        }
    }

    /// The same of a sum, which does not underflow.
    #[inline]
    fn of_sum(middle: f64, radius: f64) -> Self {
        Self {
            middle,
            radius: (radius + middle.abs() * f64::EPSILON) * LOST,
        }
    }

    /// Of a number that is not below 0.
    #[inline]
    fn not_below_0(self) -> Self {
        if self.radius > self.middle {
            let half = up((self.middle + self.radius) * 0.5);
            return Self::around(half, half);
        }
        self
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self::of_sum(self.middle + other.middle, self.radius + other.radius)
    }

    #[inline]
    fn minus(self, other: Self) -> Self {
        Self::of_sum(self.middle - other.middle, self.radius + other.radius)
    }

    #[inline]
    fn shifted(self, by: f64) -> Self {
        Self::of_sum(self.middle + by, self.radius)
    }

    #[inline]
    const fn negated(self) -> Self {
        Self {
            middle: -self.middle,
            radius: self.radius,
        }
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let radius =
            self.middle.abs() * other.radius + self.radius * (other.middle.abs() + other.radius);
        Self::of_product(self.middle * other.middle, radius)
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        Self::of_product(self.middle * by, self.radius * by.abs())
    }

    #[inline]
    fn divided(self, by: f64) -> Self {
        Self::of_product(self.middle / by, self.radius / by.abs())
    }

    #[inline]
    fn over(self, other: Self) -> Self {
        // Written so that NaN is unknown too.
        let is_apart = other.middle.abs() > other.radius;
        if !is_apart {
            return Self::UNKNOWN;
        }
        let middle = self.middle / other.middle;
        let apart = self.radius + middle.abs() * other.radius;
        Self::of_product(middle, apart / (other.middle.abs() - other.radius))
    }

    /// The interval of a function that trig-kernels is off by less than a unit of the last place.
    fn of_kernel(low: f64, high: f64) -> Self {
        Self::new(down(down(low)), up(up(high)))
    }

    /// The same around its value in the middle.
    #[inline]
    fn around_kernel(middle: f64, radius: f64) -> Self {
        Self::of_product(middle, radius + middle.abs() * f64::EPSILON)
    }
}

impl From<f64> for Interval {
    #[inline]
    fn from(value: f64) -> Self {
        Self::around(value, 0.0)
    }
}

operators!([] Interval);

/// Whether a whole multiple of 2π past `phase` may lie in the interval.
fn may_meet(interval: &Interval, phase: f64) -> bool {
    // Far more than what rounding is off by.
    const SLACK: f64 = 1e-9;
    let turns = |x: f64| (x - phase) / TAU;
    let (from, to) = (turns(interval.low()), turns(interval.high()));
    let slack = SLACK + larger(from.abs(), to.abs()) * SLACK;
    let is_between = libm::floor(to + slack) > libm::floor(from - slack);
    is_between || slack > 0.25
}

/// The angles of a box right of the axis of y.
fn angles_right(y: Interval, x: Interval) -> Interval {
    let ([x_low, x_high], [y_low, y_high]) = ([x.low(), x.high()], [y.low(), y.high()]);
    // The angle falls with x above the axis and rises with it below.
    let low = atan2(y_low, if y_low >= 0.0 { x_high } else { x_low });
    let high = atan2(y_high, if y_high >= 0.0 { x_low } else { x_high });
    Interval::of_kernel(low, high)
}

/// The angles of a box that is small beside its distance from 0, from its middle v.
///
/// ```text
/// tan |angle of v + d to v| = |v × d| / v·(v + d) ≤ k / w      k = |x| r_y + |y| r_x
///                                                             w = v² - |x| r_x - |y| r_y
/// ```
///
/// w is at least half of v², so that it is off by at most 12 ε of itself.
fn angles_around(y: Interval, x: Interval) -> Option<Interval> {
    let (across, down) = (x.middle.abs(), y.middle.abs());
    let square = across * across + down * down;
    let nearer = across * x.radius + down * y.radius;
    let turned = across * y.radius + down * x.radius;
    let least = square - nearer;
    // Written so that NaN is none.
    let is_small = square > LEAST
        && square < f64::INFINITY
        && nearer <= square * 0.5
        && turned <= least * SHORT;
    is_small.then(|| {
        let radius = turned / least * (1.0 + 32.0 * f64::EPSILON);
        Interval::around_kernel(atan2(y.middle, x.middle), radius)
    })
}

/// Sine and cosine of an angle that is not short, from those of its ends.
fn sines_between(angle: Interval) -> (Interval, Interval) {
    // Written so that NaN is any angle.
    let is_short = angle.radius < PI;
    if !is_short {
        let any = Interval::around(0.0, 1.0);
        return (any, any);
    }
    let (from, to) = (sin_cos(angle.low()), sin_cos(angle.high()));
    let hull = |a: f64, b: f64, top: f64| {
        let between = Interval::of_kernel(smaller(a, b), larger(a, b));
        let low = if may_meet(&angle, top + PI) {
            -1.0
        } else {
            larger(-1.0, between.low())
        };
        let high = if may_meet(&angle, top) {
            1.0
        } else {
            smaller(1.0, between.high())
        };
        Interval::new(low, high)
    };
    (hull(from.0, to.0, FRAC_PI_2), hull(from.1, to.1, 0.0))
}

impl Bounded for Interval {
    #[inline]
    fn most(&self) -> f64 {
        self.magnitude()
    }
}

impl Number for Interval {
    #[inline]
    fn squared(self) -> Self {
        // (a ± r)² is from (|a| - r)² to (|a| + r)².
        let (a, r) = (self.middle.abs(), self.radius);
        if a >= r {
            let (square, middle) = (a * a, a * a + r * r);
            return Self::of_product(middle, 2.0 * a * r + square * f64::EPSILON).not_below_0();
        }
        let half = up(up((a + r) * (a + r))) * 0.5;
        Self::around(half, half)
    }

    #[inline]
    fn root(self, reason: &'static str) -> Result<Self, Refusal> {
        let Self { middle, radius } = self;
        if middle >= radius {
            if middle == 0.0 {
                return Ok(Self::from(0.0));
            }
            // Half of √b - √a is half of (b - a) / (√a + √b).
            let sum = sqrt(middle - radius) + sqrt(middle + radius);
            let half = sum * 0.5;
            let root = Self::of_product(half, radius / sum + 2.0 * half * f64::EPSILON);
            return Ok(root.not_below_0());
        }
        if -middle > radius {
            return Err(Refusal::proven(reason, -self.high()));
        }
        Err(Refusal::undecided(reason))
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let r = self.radius;
        // Written so that NaN is any angle.
        let is_short = r <= SHORT;
        if !is_short {
            return sines_between(self);
        }
        // |f(a + d) - f(a)| ≤ |f'(a)| |d| + d²/2, and what the other of both is off by.
        let (sin, cos) = sin_cos(self.middle);
        let rest = r * r * 0.5 + r * f64::EPSILON * 2.0;
        (
            Self::around_kernel(sin, cos.abs() * r + rest),
            Self::around_kernel(cos, sin.abs() * r + rest),
        )
    }

    #[inline]
    fn atan2(y: Self, x: Self, reason: &'static str) -> Result<Self, Refusal> {
        if let Some(angles) = angles_around(y, x) {
            return Ok(angles);
        }
        if x.middle > x.radius {
            Ok(angles_right(y, x))
        } else if y.middle > y.radius {
            Ok(angles_right(-x, y) + Self::around(FRAC_PI_2, f64::EPSILON))
        } else if -y.middle > y.radius {
            Ok(angles_right(x, -y) - Self::around(FRAC_PI_2, f64::EPSILON))
        } else if -x.middle > x.radius {
            Ok(angles_right(-y, -x) + Self::around(PI, f64::EPSILON))
        } else {
            Err(Refusal::undecided(reason))
        }
    }

    #[inline]
    fn is_positive(self, reason: &'static str) -> Result<bool, Refusal> {
        if self.middle > self.radius {
            Ok(true)
        } else if -self.middle >= self.radius && self.is_known() {
            Ok(false)
        } else {
            Err(Refusal::undecided(reason))
        }
    }

    #[inline]
    fn middle(self) -> f64 {
        self.middle
    }
}
