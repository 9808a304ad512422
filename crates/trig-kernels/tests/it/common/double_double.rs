//! Sine and cosine to 100 bits: sums of two f64, by Dekker's and Knuth's error-free
//! transformations, reduced by a π/2 of 182 bits, by Taylor's series.
//!
//! Relative error below 2^-95 for angles up to 2^27, checked against 40 digits of mpmath.

#[derive(Debug, Clone, Copy)]
pub(crate) struct Wide {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

/// A number of one f64.
pub(crate) fn wide(high: f64) -> Wide {
    Wide { high, low: 0.0 }
}

impl Wide {
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        let low = (a - (high - part)) + (b - part);
        Self { high, low }
    }

    fn ordered_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        Self {
            high,
            low: b - (high - a),
        }
    }

    pub(crate) fn product(a: f64, b: f64) -> Self {
        let halves = |x: f64| {
            let scaled = 134_217_729.0 * x; // 2^27 + 1
            let head = scaled - (scaled - x);
            (head, x - head)
        };
        let high = a * b;
        let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
        let low = ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2;
        Self { high, low }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let middle = Self::ordered_sum(high.high, high.low + low.high);
        Self::ordered_sum(middle.high, middle.low + low.low)
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(Self {
            high: -other.high,
            low: -other.low,
        })
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let high = Self::product(self.high, other.high);
        let low = high.low + (self.high * other.low + self.low * other.high);
        Self::ordered_sum(high.high, low)
    }

    pub(crate) fn over(self, divisor: f64) -> Self {
        let quotient = self.high / divisor;
        let back = Self::product(quotient, divisor);
        let rest = ((self.high - back.high) - back.low) + self.low;
        Self::ordered_sum(quotient, rest / divisor)
    }
}

/// π/2 in parts of 26 bits, the first 2^0 to 2^-25: products with 27 bits are exact.
const HALF_PI: [u32; 7] = [
    0x0324_3F6A,
    0x0222_168C,
    0x008D_3131,
    0x0262_8B80,
    0x0370_7344,
    0x0290_24E0,
    0x0222_99F3,
];

/// n modulo four and x - n · π/2, for |x| < 2^27.
fn reduced(x: f64) -> (f64, Wide) {
    let n = (x * core::f64::consts::FRAC_2_PI).round_ties_even();
    let mut rest = wide(x);
    let mut unit = 2f64.powi(-25);
    for part in HALF_PI {
        let product = -n * (f64::from(part) * unit);
        rest = rest.plus(wide(product));
        unit *= 2f64.powi(-26);
    }
    (n.rem_euclid(4.0), rest)
}

/// sin x and cos x.
#[derive(Debug)]
pub(crate) struct Reference {
    /// 1/k!
    inverse_factorials: Vec<Wide>,
}

impl Reference {
    pub(crate) fn new() -> Self {
        let mut term = wide(1.0);
        let inverse_factorials = (1..=30)
            .map(|k| {
                let this = term;
                term = term.over(f64::from(k));
                this
            })
            .collect();
        Self { inverse_factorials }
    }

    pub(crate) fn sin_cos(&self, x: f64) -> (Wide, Wide) {
        let (n, t) = reduced(x);
        let square = t.times(t);
        let series = |first: usize| {
            let terms = self.inverse_factorials.iter().skip(first).step_by(2);
            terms
                .rev()
                .fold(wide(0.0), |sum, term| term.minus(square.times(sum)))
        };
        let (sin, cos) = (t.times(series(1)), series(0));
        let minus = |v: Wide| wide(0.0).minus(v);
        match n {
            0.0 => (sin, cos),
            1.0 => (cos, minus(sin)),
            2.0 => (minus(sin), minus(cos)),
            _ => (minus(cos), sin),
        }
    }
}

/// The distance between a number and the one next to it, away from zero.
pub(crate) fn last_place(x: f64) -> f64 {
    let x = x.abs();
    f64::from_bits(x.to_bits() + 1) - x
}
