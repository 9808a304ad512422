//! How far the platform can move from a point in any direction.

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

use crate::arm::zip;
use crate::assembly::from_above;
use crate::pose::invert_rods;
use crate::prepared::PreparedArm;
use crate::range::{norm, two};
use crate::{Delta, ElbowSide, Pose};

impl<T: RealField + Trig> Delta<T> {
    /// How far the platform can be moved from `point` in any direction, in the unit of length: the
    /// whole ball round it is in the workspace. Zero where `point` itself is not.
    ///
    /// It is the smallest of the distances to what limits each arm, less the
    /// [`tolerance`](Self::tolerance), and of a distance within which the rods cannot come to lie
    /// in a plane:
    ///
    /// ```text
    /// reach:    La - |P - nearest point of the elbow's circle|,  |P - farthest point of it| - La
    /// ranges:   ||P - elbow at the end of the range| - La|
    /// balls:    La sin(max swivel) - |w|
    /// assembly: see below
    /// ```
    ///
    /// None of the first three changes by more than the point moves, and by continuity no angle
    /// leaves its range inside the ball. The last is a lower bound: more may be free.
    ///
    /// Proof. Let the platform move by d, |d| ≤ δ, and an elbow by a chord of length y. With e
    /// along the rod, t and s along the elbow's path and the upper arm, λ = |e · t|, σ = |e · s|,
    /// the length of the rod is kept if
    ///
    /// ```text
    /// λ y ≤ δ + (δ + y)²/(2 La) + (λ + σ) y²/(2 Lb)
    /// ```
    ///
    /// While y grows from 0 it cannot pass a Y for which this is false, such as Y = 2 δ/λ if
    ///
    /// ```text
    /// Y < λ / (9/(4 La) + (λ + σ)/Lb)
    /// ```
    ///
    /// So no rod turns by more than η = (δ + Y)/La, and with κ the Frobenius norm of the inverse
    /// of the rods' matrix none comes into the plane of the others while κ √(η1² + η2² + η3²) < 1.
    /// And no elbow moves by more than Y: as seen from above, twice the area of the elbows'
    /// triangle with the sides s, each opposite its elbow, changes by at most
    ///
    /// ```text
    /// Y1 s1 + Y2 s2 + Y3 s3 + Y1 Y2 + Y2 Y3 + Y3 Y1
    /// ```
    ///
    /// and while that is less than it was the plane of the elbows does not come upright.
    #[must_use]
    pub fn clearance(&self, point: impl Into<Point3<T>>) -> T {
        let point = point.into();
        let Ok(pose) = self.pose_at(point) else {
            return T::zero();
        };
        let local = self.flip(point.coords);
        zip(self.prepared().each_ref(), self.working_mode())
            .map(|(prepared, elbow)| arm_clearance(prepared, elbow, &local) - self.tolerance())
            .into_iter()
            .fold(assembly_clearance(self, &pose), T::min)
            .max(T::zero())
    }
}

fn arm_clearance<T: RealField + Trig>(
    prepared: &PreparedArm<T>,
    elbow: ElbowSide,
    local: &Vector3<T>,
) -> T {
    let side = local.dot(&prepared.sideways()).abs();
    let clearance = prepared.reach_margin(local).min(prepared.max_side - side);
    if !prepared.is_limited() {
        return clearance;
    }
    let end = |theta: T| {
        // The elbow at an end may also belong to the other solution: then the wrist's distance
        // from the upper arm's line at that end holds it off.
        let direction = sin_cos(theta);
        let shoulder = prepared.centre(direction) - prepared.spoke(direction);
        let ahead = (local - shoulder).dot(&prepared.tangent(direction)) / prepared.upper;
        let other = match elbow {
            ElbowSide::Out => ahead,
            ElbowSide::In => -ahead,
        };
        prepared.stretch(local, theta).abs().max(other)
    };
    clearance.min(end(prepared.low)).min(end(prepared.high))
}

/// How far the platform can move from a pose before its rods could lie in a plane.
fn assembly_clearance<T: RealField + Trig>(delta: &Delta<T>, pose: &Pose<T>) -> T {
    if pose.rod_inverse().is_err() {
        return T::zero();
    }
    let [a, b, c] = invert_rods(pose.rods());
    let kappa = (a.norm_squared() + b.norm_squared() + c.norm_squared()).sqrt();
    let nine_quarters: T = nalgebra::convert(2.25);
    let prepared = zip(delta.prepared().each_ref(), pose.levers().into());
    let [first, second, third] = prepared.map(|(prepared, lever)| {
        let along = (lever / prepared.upper).abs();
        // λ + σ is largest with the rod in the arm's plane.
        let both = along
            + ((T::one() - along) * (T::one() + along))
                .max(T::zero())
                .sqrt();
        let min_y = along / (nine_quarters / prepared.lower + both / prepared.upper);
        // η for δ = 1.
        let turn = (T::one() + two::<T>() / along) / prepared.lower;
        (min_y * along / two(), turn, along)
    });
    let held = first.0.min(second.0).min(third.0);
    let held = held.min(upright_clearance(delta, pose, [first.2, second.2, third.2]));
    let turn = Vector3::new(first.1, second.1, third.1).norm();
    // There rods that are longer or shorter by the tolerance decide whether they meet at all: at
    // a height d over the elbows' plane with d²/(2 La) up to the tolerance.
    let rounding = (pose.rounding() * two()).sqrt() * two();
    let margin: T = nalgebra::convert(1.0 - 1e-3);
    held.min((kappa.recip() - rounding) / turn) * margin
}

/// How far the platform can move before elbows that move by 2 δ/λ could lie on a line, as seen from
/// above.
fn upright_clearance<T: RealField + Trig>(delta: &Delta<T>, pose: &Pose<T>, lambdas: [T; 3]) -> T {
    let centres = delta.centres_at(delta.thetas(pose.angles()));
    let ([s1, s2, s3], area2) = from_above(centres);
    let [u1, u2, u3] = lambdas.map(|lambda| two::<T>() / lambda);
    let a = u1 * u2 + u2 * u3 + u3 * u1;
    // `inverse` asks for a height over the longest side, which may be steep: four times that, as
    // the angles are rounded and sides get longer.
    let b = u1 * s1 + u2 * s2 + u3 * s3;
    let [c1, c2, c3] = centres;
    let perimeter = norm(&(c2 - c1)) + norm(&(c3 - c2)) + norm(&(c1 - c3));
    let rounding = delta.tolerance() * perimeter * two() * two();
    let c = area2 - rounding;
    // a δ² + b δ = c
    two::<T>() * c / (b + (b * b + two::<T>() * two() * a * c).max(T::zero()).sqrt())
}
