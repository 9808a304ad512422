//! Singular values of a 3 × 3 matrix, with two proper rotations.

use nalgebra::{Matrix3, RealField, Vector3};

use crate::number::{epsilons, two};

/// H = Σ σₖ uₖ vₖᵀ, σ₁ ≥ σ₂ ≥ |σ₃|; u and v are right-handed, so that σ₃ has the sign
/// of det H.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Svd<T> {
    pub(crate) u: [Vector3<T>; 3],
    pub(crate) v: [Vector3<T>; 3],
    pub(crate) sigma: [T; 3],
}

/// Sweeps of rotations; they converge quadratically, after four to six in f64.
const SWEEPS: usize = 12;

/// Rounding of a singular value, in machine epsilons of the largest.
const ROUNDING_EPSILONS: f64 = 64.0;

/// A column of H V and the column of V that made it.
type Pair<T> = (Vector3<T>, Vector3<T>);

impl<T: RealField + Copy> Svd<T> {
    /// One-sided Jacobi: rotates the columns of H until they are orthogonal. Where H is
    /// graded, as from narrow sets of points, small singular values keep their digits.
    pub(crate) fn new(h: &Matrix3<T>) -> Self {
        let mut a = (h.column(0).into_owned(), Vector3::x());
        let mut b = (h.column(1).into_owned(), Vector3::y());
        let mut c = (h.column(2).into_owned(), Vector3::z());
        for _ in 0..SWEEPS {
            let rotated = orthogonalise(&mut a, &mut b)
                | orthogonalise(&mut b, &mut c)
                | orthogonalise(&mut a, &mut c);
            if !rotated {
                break;
            }
        }
        order(&mut a, &mut b);
        order(&mut b, &mut c);
        order(&mut a, &mut b);
        let u1 = a.0.try_normalize(T::zero()).unwrap_or_else(Vector3::x);
        let u2 = (b.0 - u1 * u1.dot(&b.0))
            .try_normalize(T::zero())
            .unwrap_or_else(|| perpendicular(&u1));
        let (u3, v3) = (u1.cross(&u2), a.1.cross(&b.1));
        // The third column of V is ±v3.
        let sigma3 = u3.dot(&c.0) * v3.dot(&c.1);
        Self {
            u: [u1, u2, u3],
            v: [a.1, b.1, v3],
            sigma: [a.0.norm(), b.0.norm(), sigma3],
        }
    }

    /// Gap between the two largest eigenvalues of the quaternion problem of H: how firmly
    /// the rotation nearest to H is determined.
    pub(crate) fn gap(&self) -> T {
        let [_, s2, s3] = self.sigma;
        two::<T>() * (s2 + s3)
    }

    /// Whether H turns and stretches, without a reflection, and no direction vanishes by
    /// rounding.
    pub(crate) fn is_proper(&self) -> bool {
        let [s1, _, s3] = self.sigma;
        s3 > s1 * epsilons(ROUNDING_EPSILONS)
    }

    /// The second singular value.
    pub(crate) fn second(&self) -> T {
        let [_, s2, _] = self.sigma;
        s2
    }

    /// The rotation nearest to H: U Vᵀ, never a reflection.
    pub(crate) fn rotation(&self) -> Matrix3<T> {
        let ([u1, u2, u3], [v1, v2, v3]) = (&self.u, &self.v);
        u1 * v1.transpose() + u2 * v2.transpose() + u3 * v3.transpose()
    }
}

/// Turns both pairs so that their first columns are orthogonal; false if they were.
fn orthogonalise<T: RealField + Copy>(a: &mut Pair<T>, b: &mut Pair<T>) -> bool {
    let (aa, bb, ab) = (a.0.norm_squared(), b.0.norm_squared(), a.0.dot(&b.0));
    if ab.abs() <= T::default_epsilon() * aa.sqrt() * bb.sqrt() {
        return false;
    }
    let zeta = (bb - aa) / (two::<T>() * ab);
    let tan = (zeta.abs() + zeta.hypot(T::one())).recip().copysign(zeta);
    let cos = tan.hypot(T::one()).recip();
    let sin = cos * tan;
    let turned = |x: Vector3<T>, y: Vector3<T>| (x * cos - y * sin, x * sin + y * cos);
    ((a.0, b.0), (a.1, b.1)) = (turned(a.0, b.0), turned(a.1, b.1));
    true
}

fn order<T: RealField + Copy>(a: &mut Pair<T>, b: &mut Pair<T>) {
    if a.0.norm_squared() < b.0.norm_squared() {
        core::mem::swap(a, b);
    }
}

/// Any unit vector perpendicular to a unit vector.
fn perpendicular<T: RealField + Copy>(u: &Vector3<T>) -> Vector3<T> {
    let other = if u.x.abs() < u.y.abs() {
        Vector3::x()
    } else {
        Vector3::y()
    };
    u.cross(&other).normalize()
}
