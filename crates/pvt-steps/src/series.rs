//! The time of a cubic's steps as a cubic of their number, and its error: names and proof are those
//! of [`AxisSegments`](crate::AxisSegments).
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "ranges beside the sums"
)]

use crate::fixed::{Inverse, ONE, fraction, high, shifted, signed_high, times};
use crate::polynomial::Cubic;
use crate::segment::{MAX_COUNT, Units};

/// The widest half width that is looked for, in half steps.
const MAX_HALVES: i64 = MAX_COUNT as i64 - 32;

/// A place of a cubic and its derivatives there.
#[derive(Clone, Debug)]
pub(crate) struct Centre {
    pub(crate) fraction: u64,
    ticks: u32,
    /// Fraction bits of positions.
    bits: u32,
    /// Position.
    pub(crate) d0: i64,
    d1: i64,
    d2: i64,
    d3: i64,
    /// 1 / d1; `None` where the cubic does not rise.
    inverse: Option<Inverse>,
}

/// The series round one centre for one half width.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    centre_fraction: u64,
    /// In 2^-32 ticks.
    centre_time: u64,
    bits: u32,
    /// h.
    half_width: i64,
    /// w.
    fraction: u64,
    /// w in 2^-32 ticks.
    time: u64,
    /// Of the velocity at the centre.
    inverse: Inverse,
    ticks: u32,
    /// As ratios.
    p0: i64,
    p1: i64,
    p2: i64,
    p3: i64,
    /// Bound on what the series leaves out, in 2^-32 ticks.
    pub(crate) error: u64,
}

/// Which end of a series' positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    First,
    Last,
}

/// Times of steps: the first, and the differences of those that follow, in the units of
/// [`Segment`](crate::Segment).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Times {
    /// In 2^-32 ticks of the row.
    pub(crate) first: u64,
    pub(crate) interval: i64,
    pub(crate) second: i64,
    pub(crate) third: i64,
}

impl Times {
    pub(crate) const fn single(first: u64) -> Self {
        Self {
            first,
            interval: 0,
            second: 0,
            third: 0,
        }
    }
}

/// A fraction of a row in 2^-32 ticks, rounded down to even ones.
pub(crate) const fn time_of(fraction: u64, ticks: u32) -> u64 {
    high(fraction << 1, (ticks as u64) << 32) << 1
}

impl Centre {
    pub(crate) fn new(cubic: &Cubic, ticks: u32, s: u64) -> Self {
        let at = cubic.at(s);
        Self {
            fraction: s,
            ticks,
            bits: cubic.bits,
            d0: at.position,
            d1: at.velocity,
            d2: at.half_acceleration,
            d3: cubic.q3,
            inverse: u64::try_from(at.velocity).ok().and_then(Inverse::of),
        }
    }

    /// The series for positions up to `half_width` from this place; `None` above 512 steps, and
    /// where γ > 1/16.
    pub(crate) fn series(&self, half_width: i64) -> Option<Series> {
        let inverse = self.inverse?;
        let w = inverse.fraction(half_width as u64)?;
        let n2 = fraction(self.d2, w);
        let n3 = fraction(fraction(self.d3, w), w);
        let wide = half_width >> (self.bits - 1) >= i64::from(MAX_COUNT);
        if wide || n2.abs() > self.d1 >> 4 || n3.abs() > self.d1 >> 8 {
            return None;
        }
        // |g2| <= 1/16, |g3| <= 1/256; their products need 32 bits.
        let (g2, g3) = (inverse.ratio(n2), inverse.ratio(n3));
        let (a, c) = (g2 >> 30, g3 >> 30);
        let square = (a * a) >> 32;
        let size = c.abs();
        let b4 = 5 * a * (c - square);
        let b5 = 14 * square * square - 21 * square * c + 3 * c * c;
        let inner = 42 * square * square + 84 * square * size + 28 * size * size;
        let b6 = a.abs() * ((inner >> 32) + 1);
        let gamma = square.max(size) + 1;
        let rest = 1300 * gamma * (((gamma * gamma) >> 32) + 1);
        // In 2^-64; 2^-31 more than covers what the 32 bits leave out.
        let left_out = (b4.abs() >> 3) + (b5.abs() >> 4) + b6 + rest + (1 << 33);
        let time = time_of(w, self.ticks);
        Some(Series {
            centre_fraction: self.fraction,
            centre_time: time_of(self.fraction, self.ticks),
            bits: self.bits,
            half_width,
            fraction: w,
            time,
            inverse,
            ticks: self.ticks,
            p0: -(b4 >> 5),
            p1: ONE as i64 - ((5 * b5) >> 6),
            p2: (b4 >> 2) - g2,
            p3: ((a * a) >> 1) - g3 + ((5 * b5) >> 4),
            error: high(time, left_out as u64),
        })
    }

    /// About where the cubic has moved `distance` further, by y = x - g2 x²; `None` outside the row
    /// or where it turns round before.
    pub(crate) fn reach(&self, distance: i64) -> Option<u64> {
        let inverse = self.inverse?;
        let w = inverse.fraction(distance.unsigned_abs())?;
        let n2 = fraction(self.d2, w);
        if n2.abs() > self.d1 >> 1 {
            return None;
        }
        let bend = fraction(inverse.ratio(n2), w);
        if distance < 0 {
            self.fraction.checked_sub(w.checked_add_signed(bend)?)
        } else {
            self.fraction.checked_add(w.checked_add_signed(-bend)?)
        }
    }
}

/// n 2^-bits to the nearest, for bits >= 1.
const fn rounded(n: i64, bits: u32) -> i64 {
    ((n >> (bits - 1)) + 1) >> 1
}

/// 4 log2 of a number, within 1.
const fn log(n: u64) -> i32 {
    let zeros = (n | 1).leading_zeros();
    let quarters = ((n << zeros) >> 61) & 3;
    4 * (63 - zeros as i32) + quarters as i32
}

impl Series {
    /// Steps from x = -1 to x = 1.
    pub(crate) fn count(&self) -> u16 {
        // At most 1024.
        ((self.half_width >> (self.bits - 1)) + 1) as u16
    }

    /// About the half width, in half steps, whose error is 7/8 of the tolerance, by the fourth
    /// power; at most twice this one.
    pub(crate) fn fitting(&self, tolerance: u64) -> u64 {
        // 16 log2 of the ratio of the widths.
        let ratio = (log(tolerance - (tolerance >> 3)) - 1 - log(self.error)).clamp(-64, 16);
        // 2^(n/16) in 2^-15, within 1/300.
        let n = i64::from(ratio & 15);
        let root = 32768 + n * (1372 + 42 * n);
        let half_width = shifted((self.half_width >> 15) * root, ratio >> 4);
        (half_width >> (self.bits - 1)).min(MAX_HALVES) as u64
    }

    /// y at x = -1 or x = 1.
    const fn at(&self, end: End) -> i64 {
        match end {
            End::First => self.p0 - self.p1 + self.p2 - self.p3,
            End::Last => self.p0 + self.p1 + self.p2 + self.p3,
        }
    }

    /// The time at one end, in 2^-32 ticks of the row; those before the row wrap.
    pub(crate) fn time_at(&self, end: End) -> u64 {
        let away = signed_high(self.at(end), self.time) << 2;
        self.centre_time.wrapping_add(away as u64)
    }

    /// The times of the steps that begin at x = -1: with the fraction e = 1 / h of a step to the
    /// next,
    /// ```text
    /// y(-1 + e) - y(-1) = e (p1 + p2 (e - 2) + p3 (3 - 3 e + e²))
    /// second difference = e² (2 p2 + 6 p3 (e - 1))
    /// third difference  = 6 p3 e³
    /// ```
    /// and w e in ticks is the pace at the centre. `steps` is [`per_half_width`]. For half widths
    /// of half a step and more; `None` where a step takes 2^31 ticks.
    ///
    /// [`per_half_width`]: Self::per_half_width
    pub(crate) fn times(&self, steps: Inverse, count: u16) -> Option<Times> {
        const ONE_STEP: u64 = 1 << 60;
        // w / h, ticks a step, has to stay below 2^31.
        if self.time >> (63 - self.bits) >= self.half_width as u64 {
            return None;
        }
        let bits = self.bits as i32;
        // In 2^-60, at most 2 and 4; everything with p3 is below 1/2.
        let e = steps.quotient(1 << 62, bits - 2);
        let square = high(e << 1, e << 1) << 2;
        let interval = (self.p1 >> 2) - times(self.p2, 2 * ONE_STEP - e)
            + times(self.p3, 3 * ONE_STEP + square)
            - 3 * times(self.p3, e);
        let sixfold = 6 * self.p3;
        let second = times(2 * self.p2 - sixfold + (times(sixfold, e) << 2), e);
        let third = times(sixfold, square);
        // T / d1, ticks a step in 2^-32.
        let pace = self.inverse.quotient(u64::from(self.ticks) << 31, bits + 1);
        // Products in 2^-30, 2^-30 and 2^-33 ticks.
        let units = Units::of(count);
        Some(Times {
            first: self.time_at(End::First),
            interval: rounded(signed_high(interval << 2, pace), 30 - units.interval),
            second: if count > 2 {
                rounded(signed_high(second << 2, pace), 30 - units.second)
            } else {
                0
            },
            third: if count > 3 {
                rounded(signed_high(third << 4, pace << 1), 33 - units.third)
            } else {
                0
            },
        })
    }

    /// 1 / h.
    pub(crate) fn per_half_width(&self) -> Option<Inverse> {
        Inverse::of(self.half_width as u64)
    }

    /// About where the cubic is `distance` away from the centre, up to 4 half widths.
    pub(crate) fn extrapolated(&self, distance: i64, steps: Inverse) -> Option<u64> {
        if distance.abs() >> 2 > self.half_width {
            return None;
        }
        // x / 8 and y / 8 in 2^-30.
        let x = steps.ratio(distance >> 3) >> 32;
        let [p0, p1, p2, p3] = [self.p0, self.p1, self.p2, self.p3].map(|p| p >> 32);
        let y = p2 + ((8 * x * p3) >> 30);
        let y = p1 + ((8 * x * y) >> 30);
        let y = (p0 >> 3) + ((x * y) >> 30);
        let away = signed_high(y << 32, self.fraction) << 5;
        self.centre_fraction.checked_add_signed(away)
    }
}
