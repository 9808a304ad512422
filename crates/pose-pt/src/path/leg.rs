//! The motion from one pose to the next.

use core::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use trig_kernels::sin_cos;

use super::Interpolation;
use crate::number::{ceil, epsilons, hypot, sqrt};
use crate::rotation::{from_rotation_vector, rotation_vector_between};
use crate::turn::Turn;
use crate::{Convention, PoseVector};

/// The motion from one pose to the next over a parameter 0..=1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    pub(crate) shape: Shape,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shape {
    Turning(Turning),
    Vector(VectorLeg),
}

/// A turn at constant speed about a constant direction, with θ = s · angle:
///
/// ```text
/// translation(s) = start + s slide + sin θ sine + (1 - cos θ) versine
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turning {
    pub(crate) start: Vector3<f64>,
    pub(crate) rotation: UnitQuaternion<f64>,
    /// Unit direction of the axis in the world; zero without a turn.
    pub(crate) axis: Vector3<f64>,
    pub(crate) angle: f64,
    pub(crate) slide: Vector3<f64>,
    pub(crate) sine: Vector3<f64>,
    pub(crate) versine: Vector3<f64>,
}

/// Six numbers linear in s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VectorLeg {
    pub(crate) from: PoseVector,
    pub(crate) to: PoseVector,
    pub(crate) convention: Convention,
}

impl Leg {
    pub(super) fn new(
        from: &Isometry3<f64>,
        to: &Isometry3<f64>,
        interpolation: Interpolation,
    ) -> Self {
        let shape = match interpolation {
            Interpolation::Straight => Shape::Turning(Turning::straight(from, to)),
            Interpolation::Screw => Shape::Turning(Turning::straight(from, to).into_screw()),
            Interpolation::Vector(convention) => {
                let from = PoseVector::from_isometry(from, convention).vector;
                let to = PoseVector::from_isometry_near(to, convention, &from).vector;
                return Self::of_vectors(&from, &to, convention);
            }
        };
        Self { shape }
    }

    pub(super) const fn of_vectors(
        from: &PoseVector,
        to: &PoseVector,
        convention: Convention,
    ) -> Self {
        Self {
            shape: Shape::Vector(VectorLeg {
                from: *from,
                to: *to,
                convention,
            }),
        }
    }

    /// The pose at the parameter `s`, 0..=1.
    #[must_use]
    pub fn pose(&self, s: f64) -> Isometry3<f64> {
        match &self.shape {
            Shape::Turning(leg) => leg.pose(s),
            Shape::Vector(leg) => leg.at(s).to_isometry(leg.convention),
        }
    }

    /// A bound on the turn of the body over the leg, in radians: the angle itself for straight
    /// and screw motion, for pose vectors the largest angular speed per unit of s.
    #[must_use]
    pub fn turn(&self) -> f64 {
        match &self.shape {
            Shape::Turning(leg) => leg.angle,
            Shape::Vector(leg) => leg.fastest_turn(),
        }
    }

    /// The length of the reference point's path.
    #[must_use]
    pub fn length(&self) -> f64 {
        match &self.shape {
            Shape::Turning(leg) => hypot(leg.slide.norm(), leg.sine.norm() * leg.angle),
            Shape::Vector(leg) => leg.slide().norm(),
        }
    }

    /// Whether all equal segments of the leg turn the body alike.
    pub(crate) const fn is_even(&self) -> bool {
        matches!(self.shape, Shape::Turning(_))
    }
}

impl Turning {
    fn straight(from: &Isometry3<f64>, to: &Isometry3<f64>) -> Self {
        let turn = rotation_vector_between(&from.rotation, &to.rotation);
        let angle = turn.norm();
        // A smaller turn is below the rounding of the poses, and its axis is noise.
        let turns = angle > epsilons(1.0);
        Self {
            start: from.translation.vector,
            rotation: from.rotation,
            axis: if turns {
                turn / angle
            } else {
                Vector3::zeros()
            },
            angle: if turns { angle } else { 0.0 },
            slide: to.translation.vector - from.translation.vector,
            sine: Vector3::zeros(),
            versine: Vector3::zeros(),
        }
    }

    /// The screw with the same ends. Its velocity v at the start is found from the displacement d
    /// across the axis n, with θ the whole angle:
    ///
    /// ```text
    /// d = (sin θ v + (1 - cos θ) n × v) / θ
    /// v / θ = (sin θ d - (1 - cos θ) n × d) / (2 (1 - cos θ))
    /// ```
    fn into_screw(self) -> Self {
        if self.angle == 0.0 {
            return self;
        }
        let along = self.axis * self.axis.dot(&self.slide);
        let across = self.slide - along;
        let turn = Turn::of(self.angle);
        let sideways = self.axis.cross(&across);
        let sine = (across * (turn.sin / turn.versine) - sideways) / 2.0;
        Self {
            slide: along,
            sine,
            versine: self.axis.cross(&sine),
            ..self
        }
    }

    fn pose(&self, s: f64) -> Isometry3<f64> {
        let turn = Turn::of(self.angle * s);
        let translation =
            self.start + self.slide * s + self.sine * turn.sin + self.versine * turn.versine;
        let rotation = from_rotation_vector(&(self.axis * (self.angle * s)));
        Isometry3::from_parts(Translation3::from(translation), rotation * self.rotation)
    }
}

impl VectorLeg {
    pub(crate) fn slide(&self) -> Vector3<f64> {
        self.to.position() - self.from.position()
    }

    pub(crate) fn angles_change(&self) -> Vector3<f64> {
        self.to.angles() - self.from.angles()
    }

    pub(crate) fn at(&self, s: f64) -> PoseVector {
        let position = self.from.position() + self.slide() * s;
        let angles = self.from.angles() + self.angles_change() * s;
        PoseVector::new(
            position.x, position.y, position.z, angles.x, angles.y, angles.z,
        )
    }

    /// The largest |ω| on the leg. |ω|² = α'² + β'² + γ'² ∓ 2 α' γ' sin β, so that it is
    /// found where sin β is largest or smallest.
    fn fastest_turn(&self) -> f64 {
        let rate = self.angles_change();
        let (low, high) = sine_range(self.from.beta, self.to.beta);
        let product = 2.0 * rate.x * rate.z;
        let product = match self.convention {
            Convention::ExtrinsicXyz => -product,
            Convention::IntrinsicXyz => product,
        };
        let largest = (product * low).max(product * high);
        sqrt((rate.norm_squared() + largest).max(0.0))
    }
}

/// The smallest and the largest sine of the angles from `a` to `b`.
fn sine_range(a: f64, b: f64) -> (f64, f64) {
    let (from, to) = (a.min(b), a.max(b));
    // Whether a whole turn past `peak` lies between.
    let passes = |peak: f64| {
        let turns = ceil((from - peak) / TAU);
        peak + turns * TAU <= to
    };
    let (sa, sb) = (sin_cos(a).0, sin_cos(b).0);
    let low = if passes(-FRAC_PI_2) { -1.0 } else { sa.min(sb) };
    let high = if passes(FRAC_PI_2) { 1.0 } else { sa.max(sb) };
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::sine_range;

    #[test]
    fn sines_of_several_turns() {
        // Between samples a thousandth of the range apart a sine passes its peak by less than this.
        const BETWEEN: f64 = 1e-3;
        const ROUNDING: f64 = 1e-13;
        for number in 0..2000 {
            let spread = |step: f64| ((f64::from(number) * step).fract() * 2.0 - 1.0) * 20.0;
            let (a, b) = (spread(0.618_034), spread(0.414_214));
            let samples = (0..=1000).map(|index| (a + (b - a) * f64::from(index) / 1e3).sin());
            let (min, max) = samples.fold((1.0_f64, -1.0_f64), |(min, max), sine| {
                (min.min(sine), max.max(sine))
            });
            let (low, high) = sine_range(a, b);
            assert!(
                low <= min + ROUNDING && low > min - BETWEEN,
                "{a} {b}: {low} {min}"
            );
            assert!(
                high >= max - ROUNDING && high < max + BETWEEN,
                "{a} {b}: {high} {max}"
            );
        }
    }
}
