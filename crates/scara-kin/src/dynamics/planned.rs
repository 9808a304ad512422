//! The arm's dynamics for limits of torque.

use path_timing::{Axes, Cubic, Dynamics, Friction, Span};

use super::ArmDynamics;
use crate::Joints;

/// The largest values of a function on a segment, and of its first two derivatives by time.
#[derive(Debug, Clone, Copy)]
struct Largest([f64; 3]);

impl Largest {
    fn plus(self, other: Self) -> Self {
        let [a, b, c] = self.0;
        let [d, e, f] = other.0;
        Self([a + d, b + e, c + f])
    }

    /// By the product rule.
    fn times(self, other: Self) -> Self {
        let [f, f1, f2] = self.0;
        let [g, g1, g2] = other.0;
        Self([f * g, f1 * g + f * g1, f2 * g + 2.0 * f1 * g1 + f * g2])
    }

    const fn second(self) -> f64 {
        let [.., second] = self.0;
        second
    }
}

/// One joint on its cubic.
#[derive(Debug, Clone, Copy)]
struct Turning {
    rate: Largest,
    acceleration: Largest,
}

impl Turning {
    fn new(cubic: &Cubic) -> Self {
        let [a0, a1] = cubic.accelerations();
        let (acceleration, jerk) = (a0.abs().max(a1.abs()), (a1 - a0).abs() / cubic.duration_s);
        Self {
            rate: Largest([cubic.peak_speed(), acceleration, jerk]),
            acceleration: Largest([acceleration, jerk, 0.0]),
        }
    }

    /// The sine or cosine of its angle.
    fn wave(&self) -> Largest {
        let [rate, acceleration, _] = self.rate.0;
        Largest([1.0, rate, acceleration + rate * rate])
    }
}

impl Dynamics for ArmDynamics {
    type Axes = [f64; 2];

    fn torques(
        &self,
        position: &[f64; 2],
        velocity: &[f64; 2],
        acceleration: &[f64; 2],
    ) -> [f64; 2] {
        let [torques] = self.torques_of(position, &[[*velocity, *acceleration]]);
        torques
    }

    fn torques_of<const N: usize>(
        &self,
        &[shoulder, elbow]: &[f64; 2],
        motions: &[[[f64; 2]; 2]; N],
    ) -> [[f64; 2]; N] {
        let posture = self.posture(Joints::new(shoulder, elbow));
        motions.map(|[rates, accelerations]| {
            posture.torques(rates.into(), accelerations.into()).into()
        })
    }

    fn friction(&self) -> [Friction; 2] {
        [self.masses().shoulder, self.masses().elbow].map(|drive| Friction {
            viscous: drive.viscous_nm_s,
            coulomb: drive.coulomb_nm,
        })
    }

    /// What of both torques is no straight line in time: products of the elbow's sine and cosine,
    /// rates and accelerations, by the product rule, and the waves of gravity.
    fn bend(&self, span: &Span<[f64; 2]>) -> [f64; 2] {
        let [from, to] = &span.rows;
        let mut cubics = Cubic::between(from, to);
        let (Some(shoulder), Some(elbow)) = (cubics.next(), cubics.next()) else {
            return <[f64; 2]>::zeros();
        };
        let forearm = Cubic {
            q0: shoulder.q0 + elbow.q0,
            q1: shoulder.q1 + elbow.q1,
            v0: shoulder.v0 + elbow.v0,
            v1: shoulder.v1 + elbow.v1,
            ..shoulder
        };
        let [first, second, both] = [shoulder, elbow, forearm].map(|cubic| Turning::new(&cubic));
        let lumped = self.lumped();
        let wave = second.wave();
        // 2 q̈1 + q̈2 and 2 q̇1 q̇2 + q̇2² by sums of both joints: q̈1 + (q̈1 + q̈2), (q̇1 +
        // q̇2)² - q̇1².
        let inertial = wave.times(first.acceleration.plus(both.acceleration));
        let square = first.rate.times(first.rate);
        let centrifugal = wave.times(both.rate.times(both.rate).plus(square));
        let [upper, fore] = lumped.weights.map(f64::abs);
        let weight = fore * both.wave().second();
        let coupling = lumped.coupling.abs();
        [
            coupling * inertial.plus(centrifugal).second() + upper * first.wave().second() + weight,
            coupling
                * wave
                    .times(first.acceleration)
                    .plus(wave.times(square))
                    .second()
                + weight,
        ]
    }
}
