//! What one axis runs from a row to the next.

use crate::number::sqrt;
use crate::{Axes, Row};

/// One axis between two rows: the cubic with given positions and velocities at its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "five numbers make a cubic")]
pub struct Cubic {
    /// Position at the start.
    pub q0: f64,
    /// Position at the end.
    pub q1: f64,
    /// Velocity at the start, per second.
    pub v0: f64,
    /// Velocity at the end, per second.
    pub v1: f64,
    /// Seconds from the start to the end, above 0.
    pub duration_s: f64,
}

impl Cubic {
    /// The cubics of all axes, in their order, from a row to the next.
    pub fn between<'a, A: Axes>(
        from: &'a Row<A>,
        to: &'a Row<A>,
    ) -> impl Iterator<Item = Self> + use<'a, A> {
        let positions = (from.position.as_slice().iter()).zip(to.position.as_slice());
        let velocities = (from.velocity.as_slice().iter()).zip(to.velocity.as_slice());
        let duration_s = to.duration_s;
        positions
            .zip(velocities)
            .map(move |((q0, q1), (v0, v1))| Self {
                q0: *q0,
                q1: *q1,
                v0: *v0,
                v1: *v1,
                duration_s,
            })
    }

    /// Accelerations at both ends; between them the acceleration is linear.
    ///
    /// ```text
    /// a₀ = (6m - 4v₀ - 2v₁) / T    a₁ = (2v₀ + 4v₁ - 6m) / T    m = (q₁ - q₀) / T
    /// ```
    #[must_use]
    pub fn accelerations(&self) -> [f64; 2] {
        let six_means = 6.0 * (self.q1 - self.q0) / self.duration_s;
        [
            (six_means - 4.0 * self.v0 - 2.0 * self.v1) / self.duration_s,
            (2.0 * self.v0 + 4.0 * self.v1 - six_means) / self.duration_s,
        ]
    }

    /// The largest speed: at an end, or where the acceleration is zero.
    #[must_use]
    pub fn peak_speed(&self) -> f64 {
        let ends = self.v0.abs().max(self.v1.abs());
        let [a0, a1] = self.accelerations();
        if (a0 > 0.0) == (a1 > 0.0) {
            return ends;
        }
        let time = self.duration_s * a0 / (a0 - a1);
        ends.max((self.v0 + a0 * time * 0.5).abs())
    }

    /// The position at a fraction 0..=1 of the duration.
    #[must_use]
    pub fn position(&self, fraction: f64) -> f64 {
        let rest = 1.0 - fraction;
        let [_, b1, b2, _] = self.control_points();
        let outer = self.q0 * rest * rest * rest + self.q1 * fraction * fraction * fraction;
        outer + 3.0 * fraction * rest * (b1 * rest + b2 * fraction)
    }

    /// The velocity at a fraction 0..=1 of the duration, per second.
    ///
    /// ```text
    /// v = v₀ + (a₀ + (a₁ - a₀) u/2) u T
    /// ```
    #[must_use]
    pub fn velocity(&self, fraction: f64) -> f64 {
        let [a0, a1] = self.accelerations();
        self.v0 + (a0 + (a1 - a0) * fraction * 0.5) * fraction * self.duration_s
    }

    /// The control points of its Bézier form: the cubic stays between the smallest and the largest.
    #[must_use]
    pub fn control_points(&self) -> [f64; 4] {
        let third = self.duration_s / 3.0;
        [
            self.q0,
            self.q0 + self.v0 * third,
            self.q1 - self.v1 * third,
            self.q1,
        ]
    }

    /// The lowest and the highest position.
    #[must_use]
    pub fn extent(&self) -> [f64; 2] {
        let (mut low, mut high) = (self.q0.min(self.q1), self.q0.max(self.q1));
        let [a0, a1] = self.accelerations();
        // v₀ + a₀ t + (a₁ - a₀) t² / 2T = 0, as fractions of the duration.
        let (a, b) = (
            (a1 - a0) * self.duration_s * 0.5,
            a0 * self.duration_s * 0.5,
        );
        let square = b * b - a * self.v0;
        if square >= 0.0 {
            let sum = -(b + sqrt(square).copysign(b));
            for fraction in [sum / a, self.v0 / sum] {
                if fraction > 0.0 && fraction < 1.0 {
                    let position = self.position(fraction);
                    (low, high) = (low.min(position), high.max(position));
                }
            }
        }
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::Cubic;

    /// Samples of a cubic; between them it rises by less than `BETWEEN`.
    const SAMPLES: u32 = 2000;
    const BETWEEN: f64 = 1e-4;
    const ROUNDING: f64 = 1e-12;

    /// Numbers spread over -1..1.
    fn spread(number: u32, step: f64) -> f64 {
        (f64::from(number) * step).fract() * 2.0 - 1.0
    }

    fn cubics() -> impl Iterator<Item = Cubic> {
        (1..400).map(|number| Cubic {
            q0: spread(number, 0.618_034),
            q1: spread(number, 0.414_214),
            v0: 6.0 * spread(number, 0.732_051),
            v1: 6.0 * spread(number, 0.236_068),
            duration_s: 1.1 + spread(number, 0.302_776),
        })
    }

    /// Position and speed by time.
    fn motion(cubic: &Cubic, fraction: f64) -> [f64; 2] {
        let [a0, a1] = cubic.accelerations();
        let time = fraction * cubic.duration_s;
        let jerk = (a1 - a0) / cubic.duration_s;
        [
            cubic.q0 + (cubic.v0 + (a0 / 2.0 + jerk * time / 6.0) * time) * time,
            cubic.v0 + (a0 + jerk * time / 2.0) * time,
        ]
    }

    #[test]
    fn a_cubic_reaches_as_far_and_as_fast_as_its_samples() {
        for cubic in cubics() {
            let fractions = (0..=SAMPLES).map(|sample| f64::from(sample) / f64::from(SAMPLES));
            let (mut min, mut max, mut fastest) = (f64::MAX, f64::MIN, 0.0_f64);
            for fraction in fractions {
                let [position, speed] = motion(&cubic, fraction);
                assert!((cubic.position(fraction) - position).abs() < ROUNDING);
                (min, max) = (min.min(position), max.max(position));
                fastest = fastest.max(speed.abs());
            }
            let [end, speed] = motion(&cubic, 1.0);
            assert!((end - cubic.q1).abs() < ROUNDING && (speed - cubic.v1).abs() < ROUNDING);
            let [low, high] = cubic.extent();
            assert!(low <= min + ROUNDING && low > min - BETWEEN, "{cubic:?}");
            assert!(high >= max - ROUNDING && high < max + BETWEEN, "{cubic:?}");
            let peak = cubic.peak_speed();
            assert!(
                peak >= fastest - ROUNDING && peak < fastest + BETWEEN,
                "{cubic:?}"
            );
        }
    }

    #[test]
    fn a_cubic_stays_between_its_control_points() {
        for cubic in cubics() {
            let points = cubic.control_points();
            let [low, high] = cubic.extent();
            assert!(points.iter().any(|point| *point <= low + ROUNDING));
            assert!(points.iter().any(|point| *point >= high - ROUNDING));
        }
    }
}
