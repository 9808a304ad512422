//! What swings on a machine: a tool on a spring, shaken by the edges.

use core::f64::consts::TAU;

/// A body of N coordinates on a base that goes from place to place at once, as whole steps take it.
///
/// ```text
/// d'' + 2 ζ ω d' + ω² d = -b''        b the base, d what the body is off it
/// ```
/// Between two places of the base it swings freely, which is reckoned by its closed form; the
/// base's step by Δb takes d by -Δb and d' by 2 ζ ω Δb.
///
/// # Examples
/// ```
/// use machine_sim::ElasticMode;
/// // A step, and half a period later another one: the second takes out what the first has left.
/// let mut tool = ElasticMode::new(25.0, 0.0, [0.0]);
/// tool.follow(0.0, [1.0]);
/// assert!((tool.swing() - 1.0).abs() < 1e-12);
/// tool.follow(0.02, [2.0]);
/// assert!(tool.swing() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticMode<const N: usize> {
    /// 2π times the undamped frequency, and the damped one.
    omega: f64,
    damped: f64,
    /// ζ ω
    decay: f64,
    time_s: f64,
    base: [f64; N],
    /// d and d'.
    state: [[f64; 2]; N],
}

impl<const N: usize> ElasticMode<N> {
    /// A body at rest on its base, with the undamped natural frequency in Hz and the damping ratio,
    /// 0 to below 1.
    #[must_use]
    pub fn new(hz: f64, damping: f64, base: [f64; N]) -> Self {
        let omega = TAU * hz;
        Self {
            omega,
            damped: omega * ((1.0 - damping) * (1.0 + damping)).sqrt(),
            decay: damping * omega,
            time_s: 0.0,
            base,
            state: [[0.0; 2]; N],
        }
    }

    /// The base stands still up to a time in s, not before the last one, and then goes to a place.
    pub fn follow(&mut self, time_s: f64, base: [f64; N]) {
        self.swing_until(time_s);
        let moves = base.into_iter().zip(&mut self.base);
        for ([off, speed], (to, from)) in self.state.iter_mut().zip(moves) {
            let step = to - core::mem::replace(from, to);
            *off -= step;
            *speed += 2.0 * self.decay * step;
        }
    }

    /// The base stands still up to a time in s.
    pub fn swing_until(&mut self, time_s: f64) {
        let span_s = time_s - self.time_s;
        if span_s <= 0.0 {
            return;
        }
        self.time_s = time_s;
        let (sine, cosine) = trig_kernels::sin_cos(self.damped * span_s);
        let (left, sine) = (libm::exp(-self.decay * span_s), sine / self.damped);
        for [off, speed] in &mut self.state {
            let (d, v) = (*off, *speed);
            *off = left * (d * cosine + (v + self.decay * d) * sine);
            *speed = left * (v * cosine - (self.omega * self.omega * d + self.decay * v) * sine);
        }
    }

    /// How far the body is off its base.
    #[must_use]
    pub fn deflection(&self) -> f64 {
        let squares = self.state.iter().map(|[off, _]| off * off);
        squares.sum::<f64>().sqrt()
    }

    /// How far it swings from here on at most, while the base stands: the root of the energy in it,
    /// over that of the spring.
    ///
    /// ```text
    /// sqrt(d² + d'²/ω²)
    /// ```
    #[must_use]
    pub fn swing(&self) -> f64 {
        let energies = self.state.iter().map(|[off, speed]| {
            let speed = speed / self.omega;
            off * off + speed * speed
        });
        energies.sum::<f64>().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of rounding.
    const CLOSE: f64 = 1e-9;

    /// Along an even acceleration the body hangs back by a/ω², and what swings about it dies away.
    #[test]
    fn it_hangs_back_by_the_acceleration() {
        let (hz, acceleration) = (20.0, 3000.0);
        let mut tool = ElasticMode::new(hz, 0.2, [0.0; 2]);
        let base = |t: f64| [0.6, -0.8].map(|part| part * acceleration * t * t / 2.0);
        for n in 1..=100_000_u32 {
            let t = f64::from(n) * 1e-5;
            tool.follow(t, base(t));
        }
        let wanted = acceleration / (TAU * hz).powi(2);
        // In steps of 10 µs at up to 3000 mm/s.
        assert!(
            (tool.deflection() - wanted).abs() < 0.03,
            "{}",
            tool.deflection()
        );
    }

    /// By the logarithmic decrement.
    #[test]
    fn a_swing_dies_away_by_its_damping() {
        for damping in [0.0, 0.03, 0.5] {
            let mut tool = ElasticMode::new(40.0, damping, [0.0]);
            tool.follow(0.0, [1.0]);
            let before = tool;
            let root = (1.0_f64 - damping * damping).sqrt();
            tool.swing_until(1.0 / (40.0 * root));
            let wanted = (-TAU * damping / root).exp();
            assert!((tool.swing() / before.swing() - wanted).abs() < CLOSE);
            assert!((tool.deflection() / before.deflection() - wanted).abs() < CLOSE);
        }
    }

    /// In small parts as in one.
    #[test]
    fn its_closed_form_is_a_semigroup() {
        let mut whole = ElasticMode::new(33.0, 0.05, [0.0]);
        whole.follow(0.01, [2.0]);
        let mut parts = whole;
        whole.swing_until(0.5);
        for n in 1..=490_u32 {
            parts.swing_until(0.01 + f64::from(n) * 1e-3);
        }
        assert!((whole.deflection() - parts.deflection()).abs() < CLOSE);
        assert!((whole.swing() - parts.swing()).abs() < CLOSE);
    }
}
