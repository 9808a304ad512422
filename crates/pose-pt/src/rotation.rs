//! Rotations, accurate also where they are close to each other.

use nalgebra::{Matrix3, Quaternion, RealField, Rotation3, UnitQuaternion, Vector3, Vector4};
use trig_kernels::{Trig, atan2, sin_cos};

use crate::number::{epsilons, half, max_value, two};
use crate::short::short;
use crate::svd::Svd;

/// A 3 × 3 matrix that is not a rotation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error(
    "matrix is no rotation: Rᵀ R departs from 1 by {}, allowed {}, determinant {}",
    short(.departure), short(.allowed), short(.determinant)
)]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct NotARotation<T: RealField + Copy = f64> {
    /// Largest entry of Rᵀ R - 1; the largest number where an entry is not finite.
    pub departure: T,
    /// What was allowed.
    pub allowed: T,
    /// The determinant: negative for a reflection.
    pub determinant: T,
}

/// Zero where a quaternion is finite, else not a number: added to what is made of it, so that
/// nothing infinite ends as an angle or as a matrix of zeros and ones.
pub(crate) fn zero_if_finite<T: RealField + Copy>(quaternion: &Vector4<T>) -> T {
    quaternion.norm_squared() * T::zero()
}

/// The two quaternions, the second with the sign that makes the arc shorter.
fn shorter<T: RealField + Copy>(
    a: &UnitQuaternion<T>,
    b: &UnitQuaternion<T>,
) -> (Vector4<T>, Vector4<T>) {
    let (a, b) = (a.as_vector(), b.as_vector());
    if a.dot(b) < T::zero() {
        (*a, -b)
    } else {
        (*a, *b)
    }
}

/// Scalar and vector of b a*, the rotation from `a` to `b`.
///
/// ```text
/// vec(b a*) = vec((b - a) a*)
/// ```
///
/// The difference of close quaternions is exact; their product would round to an epsilon.
fn between<T: RealField + Copy>(a: &Vector4<T>, b: &Vector4<T>) -> (T, Vector3<T>) {
    let product = Quaternion::from(b - a) * Quaternion::from(*a).conjugate();
    (a.dot(b), product.vector().into_owned())
}

/// The angle between two rotations, in radians, 0..=π.
///
/// ```text
/// 2 atan2(|vec(b a*)|, a·b)
/// ```
///
/// Accurate for close rotations too, where an arc cosine is off by 1e-8.
#[must_use]
pub fn angle_between<T: RealField + Trig>(a: &UnitQuaternion<T>, b: &UnitQuaternion<T>) -> T {
    rotation_vector_between(a, b).norm()
}

/// The rotation at the fraction `t` of the turn from `a` to `b`, on the shorter arc at constant
/// speed.
///
/// ```text
/// (sin((1 - t) φ) a + sin(t φ) b) / sin φ,   φ the angle between the quaternions
/// ```
///
/// `t` = 0 gives `a` and 1 gives `b` to the last bit (up to the sign of the quaternion);
/// the turn from `b` to `a` at 1 - `t` is the same. Other values go on beyond the ends, to the
/// angle between both times `t` as it is rounded.
/// Where both arcs are π, the arc of the quaternions as they are is taken.
#[must_use]
pub fn slerp<T: RealField + Trig>(
    a: &UnitQuaternion<T>,
    b: &UnitQuaternion<T>,
    t: T,
) -> UnitQuaternion<T> {
    if t < T::zero() || t > T::one() {
        return from_rotation_vector(&(rotation_vector_between(a, b) * t)) * a;
    }
    let (a, b) = shorter(a, b);
    // The same from both ends, unlike the products of `between`; the weights of close rotations
    // do not depend on the last digits of the angle.
    let angle = two::<T>() * atan2((a - b).norm(), (a + b).norm());
    let sin = |angle| sin_cos(angle).0;
    let whole = sin(angle);
    let rest = T::one() - t;
    let (from, to) = if whole > T::zero() {
        (sin(rest * angle) / whole, sin(t * angle) / whole)
    } else {
        (rest, t)
    };
    UnitQuaternion::new_unchecked(Quaternion::from(a * from + b * to))
}

/// The rotation vector: axis times angle in radians, at most π long.
///
/// ```text
/// 2 atan2(|v|, w) v / |v|   of the quaternion w + v with w ≥ 0
/// ```
#[must_use]
pub fn rotation_vector<T: RealField + Trig>(rotation: &UnitQuaternion<T>) -> Vector3<T> {
    log(rotation.w, rotation.vector().into_owned())
}

/// The rotation vector, in the world, that turns `a` into `b`: b = exp(v) a, at most π long.
///
/// Divided by a time it is the angular velocity of [`slerp`].
#[must_use]
pub fn rotation_vector_between<T: RealField + Trig>(
    a: &UnitQuaternion<T>,
    b: &UnitQuaternion<T>,
) -> Vector3<T> {
    let (a, b) = shorter(a, b);
    let (w, v) = between(&a, &b);
    log(w, v)
}

fn log<T: RealField + Trig>(w: T, v: Vector3<T>) -> Vector3<T> {
    let (w, v) = if w < T::zero() { (-w, -v) } else { (w, v) };
    let sin = v.norm();
    let scale = if sin > T::zero() {
        two::<T>() * atan2(sin, w) / sin
    } else {
        two()
    };
    v * (scale + zero_if_finite(&Vector4::new(v.x, v.y, v.z, w)))
}

/// The rotation about `vector` by its length in radians.
#[must_use]
pub fn from_rotation_vector<T: RealField + Trig>(vector: &Vector3<T>) -> UnitQuaternion<T> {
    let angle = vector.norm();
    let (sin, cos) = sin_cos(angle * half());
    let scale = if angle > T::zero() {
        sin / angle
    } else {
        half()
    };
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, vector * scale))
}

/// The rotation as a matrix.
#[must_use]
pub fn to_matrix<T: RealField + Copy>(rotation: &UnitQuaternion<T>) -> Rotation3<T> {
    let (w, x, y, z) = (rotation.w, rotation.i, rotation.j, rotation.k);
    // Not 2: the squares of a rounded quaternion do not add up to one.
    let s = two::<T>() / rotation.as_vector().norm_squared() + zero_if_finite(rotation.as_vector());
    let (sx, sy, sz) = (s * x, s * y, s * z);
    let one = T::one();
    Rotation3::from_matrix_unchecked(Matrix3::new(
        one - (sy * y + sz * z),
        sx * y - sz * w,
        sx * z + sy * w,
        sx * y + sz * w,
        one - (sx * x + sz * z),
        sy * z - sx * w,
        sx * z - sy * w,
        sy * z + sx * w,
        one - (sx * x + sy * y),
    ))
}

/// The quaternion of a rotation matrix.
///
/// Rows that were rounded to a few decimals are accepted up to `allowed`, the largest entry
/// of Rᵀ R - 1 (0 allows rounding alone: 8 machine epsilons); the nearest rotation is
/// returned.
///
/// # Errors
/// [`NotARotation`] for more than that, for a reflection, for a singular matrix, and for entries
/// that are not finite.
pub fn from_matrix<T: RealField + Copy>(
    matrix: &Matrix3<T>,
    allowed: T,
) -> Result<UnitQuaternion<T>, NotARotation<T>> {
    let rounding = epsilons(ROUNDING_EPSILONS);
    let allowed = if allowed < rounding {
        rounding
    } else {
        allowed
    };
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return Err(NotARotation {
            departure: max_value(),
            allowed,
            determinant: T::zero(),
        });
    }
    let departure = (matrix.tr_mul(matrix) - Matrix3::identity()).amax();
    // Of a matrix far from a rotation no square may overflow or vanish.
    let scale = if departure <= half() {
        T::one()
    } else {
        matrix.amax()
    };
    let svd = Svd::new(&(matrix / scale));
    if departure <= allowed && svd.is_proper() {
        return Ok(quaternion(&svd.rotation()));
    }
    Err(NotARotation {
        departure: departure.min(max_value()),
        allowed,
        determinant: matrix.determinant(),
    })
}

/// What the products of an own rotation matrix may depart from 1 by rounding.
const ROUNDING_EPSILONS: f64 = 8.0;

/// The quaternion of a matrix that is a rotation but for rounding: the largest of its four
/// components from the diagonal, the others from sums and differences that do not cancel.
pub(crate) fn quaternion<T: RealField + Copy>(m: &Matrix3<T>) -> UnitQuaternion<T> {
    let one = T::one();
    let trace = m.m11 + m.m22 + m.m33;
    let largest = m.m11.max(m.m22).max(m.m33);
    let q = if trace >= largest {
        Quaternion::new(one + trace, m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
    } else if m.m11 >= largest {
        Quaternion::new(
            m.m32 - m.m23,
            one + m.m11 - m.m22 - m.m33,
            m.m12 + m.m21,
            m.m13 + m.m31,
        )
    } else if m.m22 >= largest {
        Quaternion::new(
            m.m13 - m.m31,
            m.m12 + m.m21,
            one + m.m22 - m.m11 - m.m33,
            m.m23 + m.m32,
        )
    } else {
        Quaternion::new(
            m.m21 - m.m12,
            m.m13 + m.m31,
            m.m23 + m.m32,
            one + m.m33 - m.m11 - m.m22,
        )
    };
    UnitQuaternion::new_normalize(q)
}
