//! The pose vector x, y, z, α, β, γ and its two conventions.

use nalgebra::{Isometry3, Matrix3, Quaternion, RealField, Rotation3, UnitQuaternion, Vector3};
use trig_kernels::{Trig, atan2, sin_cos};

use crate::number::{epsilons, half, largest_angle};
use crate::rotation::zero_if_finite;

/// How the three angles of a pose vector make a rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Convention {
    /// About the fixed X, then the fixed Y, then the fixed Z: R = Rz(γ) Ry(β) Rx(α),
    /// the matrix printed in [Alignment 2010].
    #[default]
    ExtrinsicXyz,
    /// About X, then the new Y, then the new Z: R = Rx(α) Ry(β) Rz(γ), the words
    /// next to the printed matrix.
    IntrinsicXyz,
}

/// A pose as six numbers: position in any unit of length, angles in radians.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "a pose has six numbers")]
pub struct PoseVector<T = f64> {
    /// Position along X.
    pub x: T,
    /// Position along Y.
    pub y: T,
    /// Position along Z.
    pub z: T,
    /// Angle about X, in radians.
    pub alpha: T,
    /// Angle about Y, in radians.
    pub beta: T,
    /// Angle about Z, in radians.
    pub gamma: T,
}

/// A pose vector made from a pose, and how well its angles are determined.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Resolved<T = f64> {
    /// The pose vector: α and γ within -π..=π, β within -π/2..=π/2.
    pub vector: PoseVector<T>,
    /// cos β, 0..=1: a rounding error of the pose appears divided by it in α and γ.
    pub cos_beta: T,
    /// Gimbal lock: only the sum or difference of α and γ is determined, and α was
    /// chosen.
    pub locked: bool,
}

/// Weight of the sum or the difference of α and γ, in machine epsilons, below which it
/// is nothing but what the products of `to_quaternion` round off.
const LOCK_EPSILONS: f64 = 2.0;

impl<T: RealField + Trig> PoseVector<T> {
    /// A pose vector: position in any unit of length, angles in radians.
    #[must_use]
    pub const fn new(x: T, y: T, z: T, alpha: T, beta: T, gamma: T) -> Self {
        Self {
            x,
            y,
            z,
            alpha,
            beta,
            gamma,
        }
    }

    /// The position.
    #[must_use]
    pub const fn position(&self) -> Vector3<T> {
        Vector3::new(self.x, self.y, self.z)
    }

    /// The angles α, β, γ, in radians.
    #[must_use]
    pub const fn angles(&self) -> Vector3<T> {
        Vector3::new(self.alpha, self.beta, self.gamma)
    }

    /// The rotation as a quaternion; finite angles give a finite one.
    #[must_use]
    pub fn to_quaternion(&self, convention: Convention) -> UnitQuaternion<T> {
        let (sa, ca) = sin_cos(self.alpha * half());
        let (sb, cb) = sin_cos(self.beta * half());
        let (sc, cc) = sin_cos(self.gamma * half());
        // The two orders differ in the sign of every product of the second kind.
        let s = match convention {
            Convention::ExtrinsicXyz => T::one(),
            Convention::IntrinsicXyz => -T::one(),
        };
        UnitQuaternion::new_unchecked(Quaternion::new(
            ca * cb * cc + s * (sa * sb * sc),
            sa * cb * cc - s * (ca * sb * sc),
            ca * sb * cc + s * (sa * cb * sc),
            ca * cb * sc - s * (sa * sb * cc),
        ))
    }

    /// The rotation as a matrix.
    #[must_use]
    pub fn to_rotation(&self, convention: Convention) -> Rotation3<T> {
        let angles = [self.alpha, self.beta, self.gamma];
        Self::rotation_of_sines(angles.map(sin_cos), convention)
    }

    /// The rotation by the sines and cosines of α, β, γ.
    #[inline]
    pub(crate) fn rotation_of_sines(
        [(sa, ca), (sb, cb), (sg, cg)]: [(T, T); 3],
        convention: Convention,
    ) -> Rotation3<T> {
        let matrix = match convention {
            Convention::ExtrinsicXyz => Matrix3::new(
                cg * cb,
                cg * sb * sa - sg * ca,
                sg * sa + cg * sb * ca,
                sg * cb,
                cg * ca + sg * sb * sa,
                sg * sb * ca - cg * sa,
                -sb,
                cb * sa,
                cb * ca,
            ),
            Convention::IntrinsicXyz => Matrix3::new(
                cb * cg,
                -cb * sg,
                sb,
                ca * sg + sa * sb * cg,
                ca * cg - sa * sb * sg,
                -sa * cb,
                sa * sg - ca * sb * cg,
                sa * cg + ca * sb * sg,
                ca * cb,
            ),
        };
        Rotation3::from_matrix_unchecked(matrix)
    }

    /// The pose; a finite vector gives a finite one.
    #[must_use]
    pub fn to_isometry(&self, convention: Convention) -> Isometry3<T> {
        Isometry3::from_parts(self.position().into(), self.to_quaternion(convention))
    }

    /// The pose vector of a pose; at gimbal lock α is zero.
    #[must_use]
    pub fn from_isometry(pose: &Isometry3<T>, convention: Convention) -> Resolved<T> {
        let angles = Angles::new(&pose.rotation, convention);
        angles.resolved(&pose.translation.vector, T::zero())
    }

    /// The pose vector of a pose that is nearest to `previous`: each angle at its whole
    /// turn nearest to the previous one, at gimbal lock with the previous α. But for whole
    /// turns β is within -π/2..=π/2. An angle of n turns is rounded to 2π n machine epsilons;
    /// beyond 1/√ε, 6.7e7 rad in f64 and 2896 in f32, it is not a number.
    #[must_use]
    pub fn from_isometry_near(
        pose: &Isometry3<T>,
        convention: Convention,
        previous: &Self,
    ) -> Resolved<T> {
        let angles = Angles::new(&pose.rotation, convention);
        let mut resolved = angles.resolved(&pose.translation.vector, previous.alpha);
        let vector = &mut resolved.vector;
        vector.alpha = nearest_turn(vector.alpha, previous.alpha);
        vector.beta = nearest_turn(vector.beta, previous.beta);
        vector.gamma = nearest_turn(vector.gamma, previous.gamma);
        resolved
    }
}

/// Half sum and half difference of α and γ with their weights: the polar forms of two
/// pairs of sums of the quaternion w + xi + yj + zk of Rz(γ) Ry(β) Rx(α).
///
/// ```text
/// w - y + i (x + z) = √(1 - sin β) exp(i (α + γ)/2)
/// w + y + i (x - z) = √(1 + sin β) exp(i (α - γ)/2)
/// ```
///
/// At gimbal lock one weight vanishes: its angle is then free, or of few digits, and the
/// matrix does not depend on them.
struct Angles<T> {
    half_sum: T,
    half_difference: T,
    /// √(1 - sin β).
    sum_weight: T,
    /// √(1 + sin β).
    difference_weight: T,
    sin_beta: T,
    sign: T,
}

impl<T: RealField + Trig> Angles<T> {
    fn new(rotation: &UnitQuaternion<T>, convention: Convention) -> Self {
        // Arc tangents would make angles of what is infinite.
        let q = rotation.quaternion() * (T::one() + zero_if_finite(rotation.as_vector()));
        // Rx(α) Ry(β) Rz(γ) is the inverse of Rz(-γ) Ry(-β) Rx(-α).
        let sign = match convention {
            Convention::ExtrinsicXyz => T::one(),
            Convention::IntrinsicXyz => -T::one(),
        };
        let (w, x, y, z) = (q.w, sign * q.i, sign * q.j, sign * q.k);
        let (a, b, c, d) = (w - y, x + z, w + y, x - z);
        let products = w * y - x * z;
        Self {
            half_sum: atan2(b, a),
            half_difference: atan2(d, c),
            sum_weight: a.hypot(b),
            difference_weight: c.hypot(d),
            sin_beta: products + products,
            sign,
        }
    }

    fn resolved(&self, position: &Vector3<T>, free_alpha: T) -> Resolved<T> {
        let cos_beta = self.sum_weight * self.difference_weight;
        let lock = epsilons(LOCK_EPSILONS);
        let free_alpha = self.sign * free_alpha;
        let locked = self.sum_weight <= lock || self.difference_weight <= lock;
        let (alpha, gamma) = if self.sum_weight <= lock {
            (
                free_alpha,
                free_alpha - self.half_difference - self.half_difference,
            )
        } else if self.difference_weight <= lock {
            (free_alpha, self.half_sum + self.half_sum - free_alpha)
        } else {
            (
                self.half_sum + self.half_difference,
                self.half_sum - self.half_difference,
            )
        };
        Resolved {
            vector: PoseVector {
                x: position.x,
                y: position.y,
                z: position.z,
                alpha: nearest_turn(self.sign * alpha, T::zero()),
                beta: self.sign * atan2(self.sin_beta, cos_beta),
                gamma: nearest_turn(self.sign * gamma, T::zero()),
            },
            cos_beta,
            locked,
        }
    }
}

/// `angle` at the whole turn nearest to `near`; not a number where that is out of range.
fn nearest_turn<T: RealField + Copy>(angle: T, near: T) -> T {
    if near.abs() > largest_angle() {
        return T::zero() / T::zero();
    }
    let turns = ((near - angle) / T::two_pi()).round();
    angle + turns * T::two_pi()
}
