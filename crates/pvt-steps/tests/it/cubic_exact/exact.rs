//! The cubic of a row in 256-bit integers.

use ethnum::I256;
use pvt_steps::PvtKnot;

use crate::cubic_exact::STEP;

/// The exact cubic of a row, times T³, in 2^-56 steps.
pub(crate) struct Exact {
    pub(crate) ticks: i128,
    pub(crate) q: [I256; 4],
    /// u of the documentation: what the axis moves in a tick at least where times can be said.
    pub(crate) standstill: i128,
}

impl Exact {
    pub(crate) fn new(from: PvtKnot, to: PvtKnot, ticks: u32) -> Self {
        let ticks = i128::from(ticks);
        let (p0, p1) = (
            i128::from(from.position) << 24,
            i128::from(to.position) << 24,
        );
        let (v0, v1) = (
            i128::from(from.velocity) * ticks,
            i128::from(to.velocity) * ticks,
        );
        let travel = p1 - p0;
        let reach = travel.abs().max(v0.abs()).max(v1.abs());
        Self {
            ticks,
            standstill: (STEP >> 40).max(reach >> 47),
            q: [p0, v0, 3 * travel - 2 * v0 - v1, v0 + v1 - 2 * travel].map(I256::from),
        }
    }

    pub(crate) fn cube(&self) -> I256 {
        let t = I256::from(self.ticks);
        t * t * t
    }

    /// u T³.
    pub(crate) fn standstill(&self) -> I256 {
        I256::from(self.standstill) * self.cube()
    }

    /// (q(n) - place) T³.
    pub(crate) fn past_place(&self, n: i128, place: i128) -> I256 {
        let (t, n) = (I256::from(self.ticks), I256::from(n));
        let [q0, q1, q2, q3] = self.q;
        (((q0 - I256::from(place)) * t + q1 * n) * t + q2 * n * n) * t + q3 * n * n * n
    }

    /// q'(n) T³ per tick.
    pub(crate) fn velocity(&self, n: i128) -> I256 {
        let (t, n) = (I256::from(self.ticks), I256::from(n));
        let [_, q1, q2, q3] = self.q;
        (q1 * t + I256::from(2) * q2 * n) * t + I256::from(3) * q3 * n * n
    }

    /// The greatest |q'| within a tick of n, times T³.
    pub(crate) fn speed_near(&self, n: i128) -> I256 {
        let ends = [n - 1, n, n + 1].map(|n| self.velocity(n).abs());
        // q' is a parabola: between them it is above by less than their spread.
        let [a, b, c] = ends;
        let most = a.max(b).max(c);
        most + (most - a.min(b).min(c))
    }

    /// Whether q' changes by less than a 64th within a tick of n.
    pub(crate) fn is_steady(&self, n: i128) -> bool {
        let v = self.velocity(n);
        let change = |n| (self.velocity(n) - v).abs();
        change(n - 1).max(change(n + 1)) * I256::from(64) < v.abs()
    }

    /// Whether the axis turns round within a tick of n.
    pub(crate) fn turns_near(&self, n: i128) -> bool {
        turns(self)
            .into_iter()
            .any(|turn| (n - 1..=n).contains(&turn))
    }
}

/// Ticks near which q' is zero.
pub(crate) fn turns(exact: &Exact) -> Vec<i128> {
    let [_, a, b, c] = exact.q.map(|q| q.as_f64());
    let (b, c) = (2.0 * b, 3.0 * c);
    let root = (b * b - 4.0 * a * c).sqrt();
    [(-b + root) / (2.0 * c), (-b - root) / (2.0 * c), -a / b]
        .into_iter()
        .filter(|s| (0.0..=1.0).contains(s))
        .map(|s| (s * exact.ticks as f64) as i128)
        .collect()
}
