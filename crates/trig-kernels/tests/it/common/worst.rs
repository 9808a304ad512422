//! The worst of many errors, and arguments to look for it with.

use core::fmt::{self, Debug, Display, Formatter};

use crate::common::double_double::{Wide, last_place};

/// The largest error in units of the last place, and where it was.
#[derive(Debug, Clone, Default)]
pub(crate) struct Worst {
    pub(crate) error: f64,
    place: String,
    pub(crate) count: u64,
}

impl Worst {
    pub(crate) fn see(&mut self, error: f64, place: impl Debug) {
        self.count += 1;
        // What is not a number is worst of all.
        if error > self.error || error.is_nan() {
            self.error = if error.is_nan() { f64::INFINITY } else { error };
            self.place = format!("{place:?}");
        }
    }

    /// Against f64, whose own error is 2^-29 of the last place of f32.
    pub(crate) fn see_f32(&mut self, found: f32, exact: f64, place: impl Debug) {
        let nearest = single(exact).abs();
        let last_place = f32::from_bits(nearest.to_bits() + 1) - nearest;
        self.see(
            (f64::from(found) - exact).abs() / f64::from(last_place),
            place,
        );
    }

    pub(crate) fn see_f64(&mut self, found: f64, exact: Wide, place: impl Debug) {
        let error = ((found - exact.high) - exact.low).abs();
        self.see(error / last_place(exact.high), place);
    }
}

impl Display for Worst {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:.4} of the last place at {}, of {}",
            self.error, self.place, self.count
        )
    }
}

/// The nearest number of single precision.
#[expect(clippy::cast_possible_truncation, reason = "that is what it is for")]
pub(crate) fn single(x: f64) -> f32 {
    x as f32
}

/// Numbers that look random, the same every time: xorshift.
#[derive(Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u32) -> Self {
        let seed = u64::from(seed) + 1;
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// Evenly from 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        f64::from_bits(self.bits() >> 12 | 1f64.to_bits()) - 1.0
    }

    /// Evenly from -1 to 1.
    pub(crate) fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// An angle up to `end`, by the kind of the part: any size, one turn, or beside quarter turns.
    pub(crate) fn angle(&mut self, part: u32, end: f64) -> f64 {
        let any = self.signed() * 2f64.powf(self.unit() * 57.0 - 30.0);
        match part % 4 {
            0 => self.signed() * end,
            1 => any.clamp(-end, end),
            2 => self.signed() * core::f64::consts::TAU,
            _ => {
                let quarters = (any * core::f64::consts::FRAC_2_PI).round();
                let beside = self.signed() * 2f64.powf(self.unit() * -50.0);
                (quarters * core::f64::consts::FRAC_PI_2 + beside).clamp(-end, end)
            }
        }
    }

    /// A vector, by the kind of the part: in a square, in all directions and sizes, beside an axis
    /// or a diagonal.
    pub(crate) fn vector(&mut self, part: u32) -> [f64; 2] {
        let [x, y] = [self.signed(), self.signed()];
        match part % 4 {
            0 | 1 => [x, y],
            2 => [x, y].map(|v| v * 2f64.powf(self.unit() * 60.0 - 30.0)),
            _ => {
                let little = 2f64.powf(self.unit() * -40.0);
                let side = match self.bits() % 4 {
                    0 => 0.0,
                    1 => 0.25,
                    2 => 0.5,
                    _ => 1.0,
                };
                [x, x * (side + y * little)]
            }
        }
    }
}
