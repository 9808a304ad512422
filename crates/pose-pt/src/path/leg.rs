//! The motion from one pose to the next.

use nalgebra::{Isometry3, RealField, Translation3, UnitQuaternion, Vector3};

use super::Interpolation;
use crate::number::{epsilons, two};
use crate::rotation::{from_rotation_vector, rotation_vector_between};
use crate::turn::Turn;
use crate::{Convention, PoseVector};

/// The motion from one pose to the next over a parameter 0..=1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg<T: RealField = f64> {
    pub(crate) shape: Shape<T>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shape<T: RealField> {
    Turning(Turning<T>),
    Vector(VectorLeg<T>),
}

/// A turn at constant speed about a constant direction, with θ = s · angle:
///
/// ```text
/// translation(s) = start + s slide + sin θ sine + (1 - cos θ) versine
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turning<T: RealField> {
    pub(crate) start: Vector3<T>,
    pub(crate) rotation: UnitQuaternion<T>,
    /// Unit direction of the axis in the world; zero without a turn.
    pub(crate) axis: Vector3<T>,
    pub(crate) angle: T,
    pub(crate) slide: Vector3<T>,
    pub(crate) sine: Vector3<T>,
    pub(crate) versine: Vector3<T>,
}

/// Six numbers linear in s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VectorLeg<T> {
    pub(crate) from: PoseVector<T>,
    pub(crate) to: PoseVector<T>,
    pub(crate) convention: Convention,
}

impl<T: RealField + Copy> Leg<T> {
    pub(super) fn new(
        from: &Isometry3<T>,
        to: &Isometry3<T>,
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
        from: &PoseVector<T>,
        to: &PoseVector<T>,
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
    pub fn pose(&self, s: T) -> Isometry3<T> {
        match &self.shape {
            Shape::Turning(leg) => leg.pose(s),
            Shape::Vector(leg) => leg.at(s).to_isometry(leg.convention),
        }
    }

    /// The most that the body turns over the leg, in radians: the angle itself for straight
    /// and screw motion, for pose vectors the largest angular speed per unit of s.
    #[must_use]
    pub fn turn(&self) -> T {
        match &self.shape {
            Shape::Turning(leg) => leg.angle,
            Shape::Vector(leg) => leg.fastest_turn(),
        }
    }

    /// The length of the reference point's way.
    #[must_use]
    pub fn length(&self) -> T {
        match &self.shape {
            Shape::Turning(leg) => leg.slide.norm().hypot(leg.sine.norm() * leg.angle),
            Shape::Vector(leg) => leg.slide().norm(),
        }
    }

    /// Whether all equal segments of the leg turn the body alike.
    pub(crate) const fn is_even(&self) -> bool {
        matches!(self.shape, Shape::Turning(_))
    }
}

impl<T: RealField + Copy> Turning<T> {
    fn straight(from: &Isometry3<T>, to: &Isometry3<T>) -> Self {
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
            angle: if turns { angle } else { T::zero() },
            slide: to.translation.vector - from.translation.vector,
            sine: Vector3::zeros(),
            versine: Vector3::zeros(),
        }
    }

    /// The screw with the same ends. Its velocity v at the start is found from the way d
    /// across the axis n, with θ the whole angle:
    ///
    /// ```text
    /// d = (sin θ v + (1 - cos θ) n × v) / θ
    /// v / θ = (sin θ d - (1 - cos θ) n × d) / (2 (1 - cos θ))
    /// ```
    fn into_screw(self) -> Self {
        if self.angle == T::zero() {
            return self;
        }
        let along = self.axis * self.axis.dot(&self.slide);
        let across = self.slide - along;
        let turn = Turn::of(self.angle);
        let sideways = self.axis.cross(&across);
        let sine = (across * (turn.sin / turn.versine) - sideways) / two::<T>();
        Self {
            slide: along,
            sine,
            versine: self.axis.cross(&sine),
            ..self
        }
    }

    fn pose(&self, s: T) -> Isometry3<T> {
        let turn = Turn::of(self.angle * s);
        let translation =
            self.start + self.slide * s + self.sine * turn.sin + self.versine * turn.versine;
        let rotation = from_rotation_vector(&(self.axis * (self.angle * s)));
        Isometry3::from_parts(Translation3::from(translation), rotation * self.rotation)
    }
}

impl<T: RealField + Copy> VectorLeg<T> {
    pub(crate) fn slide(&self) -> Vector3<T> {
        self.to.position() - self.from.position()
    }

    pub(crate) fn angles_change(&self) -> Vector3<T> {
        self.to.angles() - self.from.angles()
    }

    pub(crate) fn at(&self, s: T) -> PoseVector<T> {
        let position = self.from.position() + self.slide() * s;
        let angles = self.from.angles() + self.angles_change() * s;
        PoseVector::new(
            position.x, position.y, position.z, angles.x, angles.y, angles.z,
        )
    }

    /// Angular velocity in the world, per unit of s, while the angles are `angles`.
    ///
    /// ```text
    /// R = Rz(γ) Ry(β) Rx(α)   ω = γ' ẑ + Rz (β' ŷ + Ry α' x̂)
    /// R = Rx(α) Ry(β) Rz(γ)   ω = α' x̂ + Rx (β' ŷ + Ry γ' ẑ)
    /// ```
    pub(crate) fn angular(&self, angles: &Vector3<T>) -> Vector3<T> {
        let rate = self.angles_change();
        let (sb, cb) = angles.y.sin_cos();
        match self.convention {
            Convention::ExtrinsicXyz => {
                let (sg, cg) = angles.z.sin_cos();
                let across = cb * rate.x;
                Vector3::new(
                    cg * across - sg * rate.y,
                    sg * across + cg * rate.y,
                    rate.z - sb * rate.x,
                )
            }
            Convention::IntrinsicXyz => {
                let (sa, ca) = angles.x.sin_cos();
                let across = cb * rate.z;
                Vector3::new(
                    rate.x + sb * rate.z,
                    ca * rate.y - sa * across,
                    sa * rate.y + ca * across,
                )
            }
        }
    }

    /// The largest |ω| on the leg. |ω|² = α'² + β'² + γ'² ∓ 2 α' γ' sin β, so that it is
    /// found where sin β is largest or smallest.
    fn fastest_turn(&self) -> T {
        let rate = self.angles_change();
        let (low, high) = sine_range(self.from.beta, self.to.beta);
        let product = two::<T>() * rate.x * rate.z;
        let product = match self.convention {
            Convention::ExtrinsicXyz => -product,
            Convention::IntrinsicXyz => product,
        };
        let most = (product * low).max(product * high);
        (rate.norm_squared() + most).max(T::zero()).sqrt()
    }
}

/// The least and the largest sine of the angles from `a` to `b`.
fn sine_range<T: RealField + Copy>(a: T, b: T) -> (T, T) {
    let (from, to) = (a.min(b), a.max(b));
    // Whether a whole turn past `peak` lies between.
    let passes = |peak: T| {
        let turns = ((from - peak) / T::two_pi()).ceil();
        peak + turns * T::two_pi() <= to
    };
    let (sa, sb) = (a.sin(), b.sin());
    let low = if passes(-T::frac_pi_2()) {
        -T::one()
    } else {
        sa.min(sb)
    };
    let high = if passes(T::frac_pi_2()) {
        T::one()
    } else {
        sa.max(sb)
    };
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::sine_range;

    #[test]
    fn sines_of_several_turns() {
        // Between places of a thousandth of the way a sine passes its peak by less than this.
        const BETWEEN: f64 = 1e-3;
        const ROUNDING: f64 = 1e-13;
        for number in 0..2000 {
            let spread = |step: f64| ((f64::from(number) * step).fract() * 2.0 - 1.0) * 20.0;
            let (a, b) = (spread(0.618_034), spread(0.414_214));
            let places = (0..=1000).map(|place| (a + (b - a) * f64::from(place) / 1e3).sin());
            let (least, most) = places.fold((1.0_f64, -1.0_f64), |(least, most), sine| {
                (least.min(sine), most.max(sine))
            });
            let (low, high) = sine_range(a, b);
            assert!(
                low <= least + ROUNDING && low > least - BETWEEN,
                "{a} {b}: {low} {least}"
            );
            assert!(
                high >= most - ROUNDING && high < most + BETWEEN,
                "{a} {b}: {high} {most}"
            );
        }
    }
}
