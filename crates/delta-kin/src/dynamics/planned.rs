//! The Delta's dynamics for limits of torque.

use nalgebra::Vector3;
use path_timing::{Cubic, Dynamics, Friction, Span};

use super::DeltaDynamics;
use crate::Pose;
use crate::arm::zip;
use crate::pose::{invert_rods, smallest_sine};
use crate::range::sqrt;

/// The largest values of a function on a segment, and of its derivatives by time.
type Largest<const N: usize> = [f64; N];

/// The most by which the inverse of the rods' directions may grow on a segment.
const GROWTH: f64 = 1.25;

/// One arm on its cubic.
struct Turning {
    /// Largest derivatives 1 to 3 of its angle.
    angle: Largest<3>,
    /// Derivatives 1 to 4 of its elbow's position.
    elbow: Largest<4>,
    /// Derivatives 0 to 2 of the elbow's tangent.
    tangent: Largest<3>,
}

impl Turning {
    /// By the derivatives of l·e^{iθ}, of which the longest are the sums.
    fn new(cubic: &Cubic, upper: f64) -> Self {
        let [a0, a1] = cubic.accelerations();
        let (v, a) = (cubic.peak_speed(), a0.abs().max(a1.abs()));
        let j = (a1 - a0).abs() / cubic.duration_s;
        let second = sqrt(a * a + v * v * v * v);
        let fourth = 4.0 * v * j + 3.0 * a * a + (6.0 * a + v * v) * v * v;
        Self {
            angle: [v, a, j],
            elbow: [v, second, j + (3.0 * a + v * v) * v, fourth].map(|turn| turn * upper),
            tangent: [1.0, v, second].map(|turn| turn * upper),
        }
    }
}

impl DeltaDynamics {
    /// The bound of [`Dynamics::bend`]; none where the segment is too long to know.
    ///
    /// With κ the norm of the inverse of the matrix of the rods' directions everywhere on the
    /// segment, all derivatives of the platform's place follow from those of the elbows by the
    /// constant lengths of the rods, D · D⁽ⁿ⁾ + ... = 0, and those of the columns J of the Jacobian
    /// by B J = e D · K' / La.
    fn bent(&self, span: &Span<[f64; 3]>) -> Option<[f64; 3]> {
        let (delta, masses) = (&self.delta, self.masses());
        let [from, to] = &span.rows;
        let mut cubics = Cubic::between(from, to);
        let cubics = [cubics.next()?, cubics.next()?, cubics.next()?];
        let prepared = delta.prepared().each_ref();
        let turning = zip(prepared, cubics).map(|(arm, cubic)| Turning::new(&cubic, arm.upper));
        let lower = prepared.map(|arm| arm.lower);
        let [l1, l2, l3] = lower;
        let shortest = l1.min(l2).min(l3);

        let halfway = Vector3::from(cubics.map(|cubic| cubic.position(0.5)));
        let pose = delta.pose_of(halfway).ok()?;
        if smallest_sine(pose.rods()) <= sqrt(f64::EPSILON) {
            return None;
        }
        let [a, b, c] = invert_rods(pose.rods());
        let kappa = sqrt(a.norm_squared() + b.norm_squared() + c.norm_squared());
        let everywhere = kappa * GROWTH;
        let norm = |of: &dyn Fn(&Turning) -> f64| Vector3::from(turning.each_ref().map(of)).norm();

        // Derivatives 1 and 2 of each D, and with them whether the rods turn as little as was said.
        let p1 = everywhere * norm(&|arm| arm.elbow[0]);
        let d1 = turning.each_ref().map(|arm| p1 + arm.elbow[0]);
        let turned = Vector3::from(d1).norm() / shortest;
        if kappa * turned * to.duration_s * 0.5 > 1.0 - 1.0 / GROWTH {
            return None;
        }
        let square = |arms: [f64; 3]| Vector3::from(arms).norm() / shortest;
        let p2 = everywhere * (norm(&|arm| arm.elbow[1]) + square(d1.map(|d| d * d)));
        let d2 = turning.each_ref().map(|arm| p2 + arm.elbow[1]);
        let mixed = square(zip(d1, d2).map(|(first, second)| 3.0 * first * second));
        let p3 = everywhere * (norm(&|arm| arm.elbow[2]) + mixed);
        let d3 = turning.each_ref().map(|arm| p3 + arm.elbow[2]);
        let mixed = zip(d1, zip(d2, d3)).map(|(d1, (d2, d3))| 4.0 * d1 * d3 + 3.0 * d2 * d2);
        let p4 = everywhere * (norm(&|arm| arm.elbow[3]) + square(mixed));

        // The force at the platform and its derivatives.
        let sixth = masses.rods_kg / 6.0;
        let gravity = masses.gravity_m_s2.abs() / self.unit_m;
        let carried = masses.platform_kg + masses.payload_kg;
        let moved = carried + 6.0 * sixth;
        let all = |derivative: usize| {
            let elbows = turning
                .each_ref()
                .map(|arm| arm.elbow.get(derivative).copied());
            elbows.into_iter().flatten().sum::<f64>() * sixth
        };
        let force = [
            moved * p2 + all(1) + (carried + 9.0 * sixth) * gravity,
            moved * p3 + all(2),
            moved * p4 + all(3),
        ];

        let bent = Vector3::from(d2).norm() / shortest;
        let arms = zip(zip(turning.each_ref(), lower), zip(d1, d2));
        Some(arms.map(|((arm, lower), (d1, d2))| {
            let [t0, t1, t2] = arm.tangent;
            // D · K' / La and its derivatives.
            let lever = [
                t0,
                (d1 * t0) / lower + t1,
                (d2 * t0 + 2.0 * d1 * t1) / lower + t2,
            ];
            let j0 = everywhere * lever[0];
            let j1 = everywhere * (lever[1] + turned * j0);
            let j2 = everywhere * (lever[2] + 2.0 * turned * j1 + bent * j0);
            let at_platform = second_of([j0, j1, j2], force);
            let [_, k2, k3, k4] = arm.elbow;
            let at_elbow = [
                sixth * (2.0 * k2 + p2 + 3.0 * gravity),
                sixth * (2.0 * k3 + p3),
                sixth * (2.0 * k4 + p4),
            ];
            let [v, a, _] = arm.angle;
            let weight = (masses.arm_kg_m * masses.gravity_m_s2).abs() * (a + v * v);
            let carried = at_platform + second_of(arm.tangent, at_elbow);
            weight + carried * self.unit_m * self.unit_m
        }))
    }
}

/// The largest second derivative of a product, by the product rule.
fn second_of([f, f1, f2]: Largest<3>, [g, g1, g2]: Largest<3>) -> f64 {
    f2 * g + 2.0 * f1 * g1 + f * g2
}

impl Dynamics for DeltaDynamics {
    type Axes = [f64; 3];

    /// Not numbers where the angles leave the platform no place.
    fn torques(
        &self,
        position: &[f64; 3],
        velocity: &[f64; 3],
        acceleration: &[f64; 3],
    ) -> [f64; 3] {
        let [torques] = self.torques_of(position, &[[*velocity, *acceleration]]);
        torques
    }

    fn torques_of<const N: usize>(
        &self,
        position: &[f64; 3],
        motions: &[[[f64; 3]; 2]; N],
    ) -> [[f64; 3]; N] {
        let pose: Option<Pose> = self.delta.pose_of(Vector3::from(*position)).ok();
        let posture = pose.as_ref().and_then(|pose| self.posture(pose).ok());
        posture.map_or([[f64::NAN; 3]; N], |posture| {
            motions.map(|[rates, accelerations]| {
                posture.torques(rates.into(), accelerations.into()).into()
            })
        })
    }

    fn friction(&self) -> [Friction; 3] {
        let masses = self.masses();
        [Friction {
            viscous: masses.viscous_nm_s,
            coulomb: masses.coulomb_nm,
        }; 3]
    }

    fn bend(&self, span: &Span<[f64; 3]>) -> [f64; 3] {
        self.bent(span).unwrap_or([f64::INFINITY; 3])
    }
}
