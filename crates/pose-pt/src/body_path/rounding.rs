//! A path rounded at a pose.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use trig_kernels::sin_cos;

use super::motion::{Motion, angular_velocity};
use crate::path::leg::{Leg, Shape};
use crate::rotation::{from_rotation_vector, to_matrix};
use crate::{Blend, Convention, PoseVector};

/// The largest fraction of a leg that a blend takes: two blends leave a tenth of it.
const LARGEST_FRACTION: f64 = 0.45;

/// The smallest fraction of a leg that a blend takes: a smaller one is a stop.
const SMALLEST_FRACTION: f64 = 1e-6;

/// By how much angles of the same rotation, whole turns aside, differ by rounding, in radians.
const SAME_ANGLE: f64 = 1e-9;

/// A rounded pose: position and rotation run from one leg to the next by
///
/// ```text
/// x(u) = l (g(u) b - g(1-u) a),   g(u) = u³ (2 - u),   u = 0..=1
/// ```
///
/// x are position and rotation vector from the pose, or the six numbers of the pose vector; a and b
/// are their derivatives on both legs, l what is taken of each. Since g(u) - g(1-u) = 2u - 1, x is
/// l (2u - 1) a + l g(u) (b - a): it leaves the first leg and meets the second with their
/// derivatives and no second derivative, and before u = ½ it is l g(½) |b - a| = 3/16 l |b - a| at
/// most from the point of the first leg at the same u, after it from that of the second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rounding {
    position: Vector3<f64>,
    chart: Chart,
    before: Rates,
    after: Rates,
    /// What is taken of each leg, in the common parameter.
    reach: f64,
}

/// How three numbers near zero are rotations near that of the pose.
#[derive(Debug, Clone, Copy)]
enum Chart {
    /// exp(r) R, r in the world.
    RotationVector(UnitQuaternion<f64>),
    /// Angles from those of the pose.
    Angles(Vector3<f64>, Convention),
}

/// Derivatives by the common parameter.
#[derive(Debug, Clone, Copy)]
struct Rates {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
}

impl Rates {
    /// The rates of a leg that the common parameter takes `size` to run.
    fn of(leg: &Leg, size: f64) -> Self {
        let (linear, angular) = match &leg.shape {
            Shape::Turning(leg) => (leg.slide, leg.axis * leg.angle),
            Shape::Vector(leg) => (leg.slide(), leg.angles_change()),
        };
        Self {
            linear: linear / size,
            angular: angular / size,
        }
    }
}

impl Chart {
    /// Around the pose where two legs meet; none where their angles there are not the same ones.
    fn between(before: &Leg, after: &Leg) -> Option<Self> {
        match (&before.shape, &after.shape) {
            (Shape::Turning(_), Shape::Turning(after)) => {
                Some(Self::RotationVector(after.rotation))
            }
            (Shape::Vector(before), Shape::Vector(after)) => {
                let apart = (after.from.angles() - before.to.angles()) * 0.5;
                let is_same = apart
                    .iter()
                    .all(|apart| sin_cos(*apart).0.abs() < SAME_ANGLE);
                is_same.then(|| Self::Angles(after.from.angles(), after.convention))
            }
            _ => None,
        }
    }

    /// A bound on the angle between two rotations whose numbers differ by this.
    fn angle(&self, difference: &Vector3<f64>) -> f64 {
        match self {
            Self::RotationVector(_) => difference.norm(),
            Self::Angles(..) => difference.abs().sum(),
        }
    }

    /// The rotation, and its angular velocity while the numbers change at `rate`.
    fn rotation(&self, at: &Vector3<f64>, rate: &Vector3<f64>) -> (Rotation3<f64>, Vector3<f64>) {
        match self {
            Self::RotationVector(rotation) => {
                let rotation = from_rotation_vector(at) * rotation;
                (to_matrix(&rotation), left_jacobian(at) * rate)
            }
            Self::Angles(angles, convention) => {
                let at = angles + at;
                let vector = PoseVector::new(0.0, 0.0, 0.0, at.x, at.y, at.z);
                let velocity = angular_velocity(*convention, &at, rate);
                (vector.to_rotation(*convention), velocity)
            }
        }
    }
}

impl Rounding {
    /// The rounding of the pose where two legs meet; `sizes` is what the common parameter takes to
    /// run each. None where the body has to stop there.
    pub(super) fn new(blend: &Blend, legs: [&Leg; 2], sizes: [f64; 2]) -> Option<Self> {
        if *blend == Blend::STOP {
            return None;
        }
        let ([before, after], [before_size, after_size]) = (legs, sizes);
        let chart = Chart::between(before, after)?;
        let position = match &after.shape {
            Shape::Turning(leg) => leg.start,
            Shape::Vector(leg) => leg.from.position(),
        };
        let (before, after) = (Rates::of(before, before_size), Rates::of(after, after_size));
        let smaller = before_size.min(after_size);
        let slide = (after.linear - before.linear).norm();
        let turn = chart.angle(&(after.angular - before.angular));
        let mut reach = smaller * LARGEST_FRACTION;
        for (allowed, change) in [(blend.distance, slide), (blend.rotation_rad, turn)] {
            if change > 0.0 {
                reach = reach.min(allowed / (change * HALFWAY));
            }
        }
        (reach >= smaller * SMALLEST_FRACTION).then_some(Self {
            position,
            chart,
            before,
            after,
            reach,
        })
    }

    /// What is taken of each leg, in the common parameter.
    pub(super) const fn reach(&self) -> f64 {
        self.reach
    }

    /// The body at the common parameter, 0 to twice the reach, and its velocity by it.
    pub(super) fn motion(&self, s: f64) -> Motion {
        let u = s / (2.0 * self.reach);
        let (ahead, back) = (weight(u), weight(1.0 - u));
        let (faster, slower) = (weight_rate(u), weight_rate(1.0 - u));
        let at = |a: &Vector3<f64>, b: &Vector3<f64>| (b * ahead - a * back) * self.reach;
        let rate = |a: &Vector3<f64>, b: &Vector3<f64>| (b * faster + a * slower) * 0.5;
        let (before, after) = (&self.before, &self.after);
        let (rotation, angular) = self.chart.rotation(
            &at(&before.angular, &after.angular),
            &rate(&before.angular, &after.angular),
        );
        Motion {
            rotation,
            position: self.position + at(&before.linear, &after.linear),
            linear: rate(&before.linear, &after.linear),
            angular,
        }
    }
}

/// g(½)
const HALFWAY: f64 = 3.0 / 16.0;

/// g(u)
fn weight(u: f64) -> f64 {
    u * u * u * (2.0 - u)
}

/// dg/du
fn weight_rate(u: f64) -> f64 {
    u * u * (6.0 - 4.0 * u)
}

/// The matrix that turns the rate of a rotation vector r into the angular velocity in the world.
///
/// ```text
/// J = 1 + (1 - cos θ)/θ² [r] + (θ - sin θ)/θ³ [r]²,   θ = |r|
/// ```
fn left_jacobian(r: &Vector3<f64>) -> Matrix3<f64> {
    let angle = r.norm();
    if angle == 0.0 {
        return Matrix3::identity();
    }
    let cross = r.cross_matrix();
    let (half_sin, _) = sin_cos(angle * 0.5);
    let (sin, _) = sin_cos(angle);
    let first = 2.0 * (half_sin / angle) * (half_sin / angle);
    let second = (angle - sin) / (angle * angle * angle);
    Matrix3::identity() + cross * first + cross * cross * second
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::rotation_vector_between;

    /// Central differences over `STEP`: its square, and rounding over it.
    const STEP: f64 = 1e-4;
    const NEAR: f64 = 1e-7;

    #[test]
    fn the_jacobian_gives_the_angular_velocity() {
        let rate = Vector3::new(0.3, -0.7, 0.4);
        for r in [
            Vector3::zeros(),
            Vector3::new(1e-9, 0.0, -1e-9),
            Vector3::new(0.02, 0.01, -0.03),
            Vector3::new(1.0, -0.8, 1.5),
        ] {
            let [from, to] = [-STEP, STEP].map(|t| from_rotation_vector(&(r + rate * t)));
            let measured = rotation_vector_between(&from, &to) / (2.0 * STEP);
            let found = left_jacobian(&r) * rate;
            assert!((measured - found).norm() < NEAR, "{r}: {measured} {found}");
        }
    }

    #[test]
    fn weights_add_up_to_a_line_and_are_highest_halfway() {
        for k in 0..=64 {
            let u = f64::from(k) / 64.0;
            assert!((weight(u) - weight(1.0 - u) - (2.0 * u - 1.0)).abs() < 1e-15);
            assert!(weight(u.min(0.5)) <= HALFWAY);
        }
    }
}
