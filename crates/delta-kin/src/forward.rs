//! From the three angles to the position: where three spheres meet.

use nalgebra::{Matrix2, Point3, RealField, Vector2, Vector3};
use trig_kernels::{Trig, sqrt};

use crate::arm::{smallest, zip};
use crate::range::{half, is_within, largest_angle, length, norm};
use crate::rounded::Rounded;
use crate::{Arm, Delta};

/// Why no platform position belongs to the angles.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ForwardError<T: RealField + Copy = f64> {
    /// An angle is not a number of the stated size, or is not when counted from straight down.
    #[error("{arm}: angle {} rad is not within ±{} rad", Rounded(*.angle), Rounded(*.largest))]
    Angle {
        /// The arm.
        arm: Arm,
        /// The angle given.
        angle: T,
        /// The largest angle from straight down, either way: 1/√ε.
        largest: T,
    },
    /// The elbows are so far apart that the lower arms cannot meet.
    #[error("the lower arms do not meet: that of {arm} ends {} before the others' line", Rounded(*.by))]
    Apart {
        /// The arm with the shortest lower arm.
        arm: Arm,
        /// How far its sphere is from the line on which the other two, and it, could meet; with
        /// equal lower arms, by how much each is too short.
        by: T,
    },
    /// The elbows, each moved inward by the platform's radius, lie on a line: the platform could
    /// turn about it.
    #[error("the elbows, moved inward by the platform's radius, lie on a line")]
    Collinear,
    /// The plane of the elbows is upright: of the two points where the lower arms meet neither is
    /// the lower, so that no assembly mode names the one that is meant.
    #[error(
        "the plane of the elbows is upright: neither of the platform's two points is the lower"
    )]
    Upright,
}

/// Where three spheres could meet, in the plane of their centres and seen from the first.
struct Foot<T> {
    /// To the second centre; across it, to the third; perpendicular to both.
    axes: [Vector3<T>; 3],
    x: T,
    y: T,
    /// Square of the height above the plane.
    squared: T,
    /// The second centre along the first axis, the third along both.
    second: T,
    third: [T; 2],
}

impl<T: RealField + Trig> Foot<T> {
    fn new([c1, c2, c3]: [Vector3<T>; 3], [l1, l2, l3]: [T; 3]) -> Self {
        let (d2, d3) = (c2 - c1, c3 - c1);
        let second = norm(&d2);
        let along = d2 / second;
        // Twice, so that the axes are perpendicular to each other also where the triangle is thin.
        let rest = d3 - along * along.dot(&d3);
        let rest = rest - along * along.dot(&rest);
        let across = rest / norm(&rest);
        let third = [along.dot(&d3), across.dot(&d3)];
        let b2 = (d2.norm_squared() + (l1 - l2) * (l1 + l2)) * half();
        let b3 = (d3.norm_squared() + (l1 - l3) * (l1 + l3)) * half();
        let x = b2 / second;
        let y = (b3 - third[0] * x) / third[1];
        Self {
            axes: [along, across, along.cross(&across)],
            x,
            y,
            squared: l1 * l1 - (x * x + y * y),
            second,
            third,
        }
    }

    /// Height of the centres' triangle, about the smallest; not a number where two are one.
    fn height(&self) -> T {
        let [along, across] = self.third;
        self.second * across / self.second.max(along.abs()).max(across)
    }

    /// The point of the first sphere's circle in the plane at which the other two lengths are met
    /// best, and by how much the worse is not.
    ///
    /// With v0 = (x, y) outside the circle and a change of v changing the lengths by A v, to first
    /// order,
    ///
    /// ```text
    /// |A (v - v0)|² → min, |v| = La1:   v = v0 - μ (Aᵀ A + μ)⁻¹ v0
    /// ```
    ///
    /// with μ > 0 by Newton's method on 1/|v|, which is nearly linear in it.
    fn touching(&self, [l1, l2, l3]: [T; 3]) -> (Vector2<T>, T) {
        let start = Vector2::new(self.x, self.y);
        let [along, across] = self.third;
        let a = Matrix2::new(self.second / l2, T::zero(), along / l3, across / l3);
        let m = a.tr_mul(&a);
        let area = self.second / l2 * (across / l3);
        let solve = |mu: T, w: Vector2<T>| {
            let det = area * area + mu * (m.m11 + m.m22 + mu);
            let x = (m.m22 + mu) * w.x - m.m12 * w.y;
            let y = (m.m11 + mu) * w.y - m.m12 * w.x;
            Vector2::new(x, y) / det
        };
        let (mut mu, mut v) = (T::zero(), start);
        for _ in 0..NEWTON_STEPS {
            let slope = v.dot(&solve(mu, v));
            mu += v.norm_squared() / slope * (norm(&v) / l1 - T::one());
            v = start - solve(mu, start) * mu;
        }
        v *= l1 / norm(&v);
        (v, (a * (v - start)).amax())
    }
}

/// The error is squared with each step: this is enough from any start.
const NEWTON_STEPS: u32 = 12;

impl<T: RealField + Trig> Delta<T> {
    /// The position of the platform's centre, in the machine's assembly mode.
    ///
    /// It lies on three spheres round the elbows, moved inward by the platform's radius, each
    /// with its own lower arm as radius. With c their centres, the first that of the shortest
    /// lower arm, and e1, e2 the directions from it to the second and across to the third:
    ///
    /// ```text
    /// d2 = c2 - c1,   d3 = c3 - c1
    /// x = (|d2|² + La1² - La2²) / (2 |d2|)
    /// y = ((|d3|² + La1² - La3²) / 2 - x d3 · e1) / (d3 · e2)
    /// P = c1 + x e1 + y e2 ± √(La1² - x² - y²) e1 × e2
    /// ```
    ///
    /// with the sign that makes P the lower or the higher point, as the mode has it.
    ///
    /// The position is as exact as the three lengths that it meets times the conditioning, which
    /// is 1 over [`Pose::parallel_distance`](crate::Pose::parallel_distance). Limits are not
    /// looked at.
    ///
    /// # Errors
    /// [`ForwardError`].
    #[inline]
    pub fn forward(&self, angles: impl Into<Vector3<T>>) -> Result<Point3<T>, ForwardError<T>> {
        let angles = angles.into();
        let thetas = self.thetas(angles);
        let lowers = self.prepared().each_ref().map(|prepared| prepared.lower);
        let (shortest, _) = smallest(lowers);
        let centres = turned(self.centres_at(thetas), shortest);
        let lowers = turned(lowers, shortest);
        let foot = Foot::new(centres, lowers);
        let are_angles = thetas
            .iter()
            .all(|theta| is_within(*theta, largest_angle()));
        let [along, across, normal] = foot.axes;
        let height = foot.height();
        // As seen from above. Not if it is not a number.
        let is_plane = height * normal.z.abs() > self.tolerance();
        let [x, y, up] = if are_angles & is_plane & (foot.squared > T::zero()) {
            [foot.x, foot.y, sqrt(foot.squared)]
        } else {
            self.check_angles(angles, thetas)?;
            if !is_plane {
                return Err(if height > self.tolerance() {
                    ForwardError::Upright
                } else {
                    ForwardError::Collinear
                });
            }
            let (v, miss) = foot.touching(lowers);
            // Half is left for `inverse`.
            let is_met = miss <= self.tolerance() * half();
            if !is_met {
                let by = length(&Vector2::new(foot.x, foot.y)) - lowers[0];
                return Err(ForwardError::Apart { arm: shortest, by });
            }
            [v.x, v.y, T::zero()]
        };
        let higher = if normal.z > T::zero() { up } else { -up };
        let local = centres[0] + along * x + across * y + normal * (higher * self.side());
        Ok(Point3::from(self.flip(local)))
    }

    #[cold]
    fn check_angles(&self, angles: Vector3<T>, thetas: [T; 3]) -> Result<(), ForwardError<T>> {
        let largest = largest_angle();
        for (arm, (angle, theta)) in zip(Arm::ALL, zip(angles.into(), thetas)) {
            if !is_within(theta, largest) {
                return Err(ForwardError::Angle {
                    arm,
                    angle,
                    largest,
                });
            }
        }
        Ok(())
    }
}

/// What belongs to the arms, in their order but from the one named.
fn turned<A>([first, second, third]: [A; 3], from: Arm) -> [A; 3] {
    match from {
        Arm::First => [first, second, third],
        Arm::Second => [second, third, first],
        Arm::Third => [third, first, second],
    }
}
