//! Sine and versine of an angle that grows by equal steps.

use trig_kernels::sin_cos;

/// sin θ and 1 - cos θ; the versine keeps its digits where the angle is small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    pub(crate) sin: f64,
    pub(crate) versine: f64,
}

impl Turn {
    pub(crate) fn of(angle: f64) -> Self {
        let (sin, cos) = sin_cos(angle / 2.0);
        Self {
            sin: 2.0 * sin * cos,
            versine: 2.0 * sin * sin,
        }
    }

    pub(crate) fn cos(self) -> f64 {
        1.0 - self.versine
    }

    /// The turn by the sum of both angles, by additions to sine and versine:
    ///
    /// ```text
    /// sin(θ + δ) = sin θ + (cos θ sin δ - sin θ vers δ)
    /// vers(θ + δ) = vers θ + (cos θ vers δ + sin θ sin δ)
    /// ```
    #[inline]
    pub(crate) fn then(self, step: Self) -> Self {
        let cos = self.cos();
        Self {
            sin: self.sin + (cos * step.sin - self.sin * step.versine),
            versine: self.versine + (cos * step.versine + self.sin * step.sin),
        }
    }
}

/// Equal steps after which the angle is computed again. Each step rounds off less than
/// two machine epsilons, so that a point is never off by more than 128 of its arm.
const RENEWAL: u32 = 64;

/// `K` angles that run from zero or another start by equal steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sweep<const K: usize> {
    from: [f64; K],
    change: [f64; K],
    segments: f64,
    step: [Turn; K],
    now: [Turn; K],
    index: u32,
}

impl<const K: usize> Sweep<K> {
    /// Angles `from` that change by `change` in `segments` steps.
    pub(crate) fn new(from: [f64; K], change: [f64; K], segments: u32) -> Self {
        let segments = f64::from(segments.max(1));
        Self {
            from,
            change,
            segments,
            step: change.map(|change| Turn::of(change / segments)),
            now: from.map(Turn::of),
            index: 0,
        }
    }

    pub(crate) const fn now(&self) -> &[Turn; K] {
        &self.now
    }

    /// The fraction of the change up to now.
    #[inline]
    pub(crate) fn fraction(&self) -> f64 {
        f64::from(self.index) / self.segments
    }

    /// Makes one step.
    #[inline]
    pub(crate) fn advance(&mut self) {
        self.index = self.index.saturating_add(1);
        if self.index.is_multiple_of(RENEWAL) {
            self.renew();
        } else {
            for (now, step) in self.now.iter_mut().zip(&self.step) {
                *now = now.then(*step);
            }
        }
    }

    /// Goes to a step, with the bits that steps from the start would have had.
    pub(crate) fn seek(&mut self, index: u32) {
        self.index = index - index % RENEWAL;
        self.renew();
        while self.index < index {
            self.advance();
        }
    }

    #[cold]
    fn renew(&mut self) {
        let fraction = self.fraction();
        for ((now, from), change) in self.now.iter_mut().zip(self.from).zip(self.change) {
            *now = Turn::of(from + change * fraction);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two epsilons a step between renewals.
    const DRIFT: f64 = 128.0 * f64::EPSILON;

    #[test]
    fn steps_keep_the_angle() {
        for (from, change, segments) in [(0.0, 3.0, 1000), (-2.0, 1e-3, 777), (1.0, -6.0, 129)] {
            let mut sweep = Sweep::new([from], [change], segments);
            for index in 0..=segments {
                let angle = from + change * f64::from(index) / f64::from(segments);
                let [now] = *sweep.now();
                assert!((now.sin - libm::sin(angle)).abs() < DRIFT, "{index}");
                assert!((now.cos() - libm::cos(angle)).abs() < DRIFT, "{index}");
                sweep.advance();
            }
        }
    }

    #[test]
    fn seeking_gives_the_same_bits() {
        let mut walked = Sweep::new([0.1], [1.0], 500);
        let start = walked;
        for index in 0..=500 {
            let mut sought = start;
            sought.seek(index);
            assert_eq!(sought.now(), walked.now());
            walked.advance();
        }
    }
}
