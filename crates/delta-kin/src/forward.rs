//! From the three angles to the position: where three spheres meet.

use nalgebra::{Point3, RealField, Vector3};

use crate::arm::zip;
use crate::limits::half;
use crate::{Arm, Delta};

/// Where the platform can be with given angles: above or below the plane of the knees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::exhaustive_structs,
    reason = "three spheres meet in two points"
)]
pub struct Assemblies<T: RealField = f64> {
    /// The lower place, in which Delta robots hang.
    pub lower: Point3<T>,
    /// The upper place, its mirror image in the plane of the knees.
    pub upper: Point3<T>,
}

/// Why no platform position belongs to the angles.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ForwardError<T = f64> {
    /// An angle is infinite or not a number, or is so when it is counted from straight down.
    #[error("{arm}: angle {angle} is not finite from straight down")]
    NotFinite {
        /// The arm.
        arm: Arm,
        /// The angle given.
        angle: T,
    },
    /// The knees are so far apart that the lower arms cannot meet.
    #[error("the lower arms do not meet: that of arm 1 ends {by} before the others' line")]
    Apart {
        /// How far the sphere of arm 1 is from the line on which the other two, and it, could
        /// meet; with equal lower arms, by how much each is too short.
        by: T,
    },
    /// The knees, each moved inward by the platform's radius, lie on a line: the platform could
    /// turn about it.
    #[error("the knees, moved inward by the platform's radius, lie on a line")]
    Collinear,
}

/// Twice the area of the centres' triangle over the squares of two of its sides, below which
/// rounding in its circumcentre is felt in the lengths: an equilateral one has 0.43.
const THIN: f64 = 1.0 / 16.0;

impl<T: RealField + Copy> Delta<T> {
    /// The position of the platform's centre, in the lower of the two assemblies.
    ///
    /// See [`forward_both`](Self::forward_both).
    ///
    /// # Errors
    /// [`ForwardError`].
    #[inline]
    pub fn forward(&self, angles: Vector3<T>) -> Result<Point3<T>, ForwardError<T>> {
        Ok(self.forward_both(angles)?.lower)
    }

    /// The position of the platform's centre in both assemblies.
    ///
    /// It lies on three spheres round the knees, moved inward by the platform's radius, each
    /// with its own lower arm as radius. With c their centres:
    ///
    /// ```text
    /// d2 = c2 - c1,   d3 = c3 - c1,   n = d2 × d3,   n̂ = n/|n|
    /// b2 = (|d2|² + La1² - La2²)/2,   b3 = (|d3|² + La1² - La3²)/2
    /// v = (b2 d3 × n̂ + b3 n̂ × d2)/|n|,   P = c1 + v ± n̂ √(La1² - |v|²)
    /// ```
    ///
    /// All three lengths are met within 8 machine epsilons of the [`span`](Self::span); the
    /// position is as exact times the conditioning, which is 1 over
    /// [`Pose::parallel_distance`](crate::Pose::parallel_distance). Limits are not looked at.
    ///
    /// # Errors
    /// [`ForwardError`].
    #[inline]
    pub fn forward_both(&self, angles: Vector3<T>) -> Result<Assemblies<T>, ForwardError<T>> {
        let centres = self.centres(angles);
        let [c1, c2, c3] = centres;
        let [l1, l2, l3] = self.legs().each_ref().map(|leg| leg.lower);
        let (d2, d3) = (c2 - c1, c3 - c1);
        let n = d2.cross(&d3);
        let n_length = n.norm();
        let unit = n / n_length;
        let b2 = (d2.norm_squared() + (l1 - l2) * (l1 + l2)) * half();
        let b3 = (d3.norm_squared() + (l1 - l3) * (l1 + l3)) * half();
        let v = (d3.cross(&unit) * b2 + unit.cross(&d2) * b3) / n_length;
        let rest = l1 * l1 - v.norm_squared();
        let is_flat = n_length <= self.tolerance() * self.span();
        let is_thin = n_length < (d2.norm_squared() + d3.norm_squared()) * nalgebra::convert(THIN);
        // Not if either is not a number.
        let meet = (rest > T::zero()) & !is_flat;
        if !meet {
            self.check(angles, &v, l1, rest, is_flat)?;
        }
        let up = unit * rest.max(T::zero()).sqrt();
        let up = if n.z < T::zero() { -up } else { up };
        let foot = c1 + v;
        let (mut lower, mut upper) = (foot - up, foot + up);
        if is_thin {
            lower = polished(lower, &centres, [l1, l2, l3]);
            upper = polished(upper, &centres, [l1, l2, l3]);
        }
        Ok(Assemblies {
            lower: Point3::from(self.flip(lower)),
            upper: Point3::from(self.flip(upper)),
        })
    }

    /// Whether the spheres only just touch, or why they do not meet.
    #[cold]
    fn check(
        &self,
        angles: Vector3<T>,
        v: &Vector3<T>,
        lower: T,
        rest: T,
        is_flat: bool,
    ) -> Result<(), ForwardError<T>> {
        // With the zero added an angle may leave the numbers of `T`.
        let read = zip(angles.into(), self.thetas(angles));
        for (arm, (angle, theta)) in zip(Arm::ALL, read) {
            if !theta.is_finite() {
                return Err(ForwardError::NotFinite { arm, angle });
            }
        }
        if is_flat {
            return Err(ForwardError::Collinear);
        }
        if rest < -lower * self.tolerance() {
            let by = v.norm() - lower;
            return Err(ForwardError::Apart { by });
        }
        Ok(())
    }
}

/// One step of Newton's method on the three lengths, if it brings them nearer.
#[cold]
fn polished<T: RealField + Copy>(
    place: Vector3<T>,
    centres: &[Vector3<T>; 3],
    lowers: [T; 3],
) -> Vector3<T> {
    let rods = centres.map(|centre| place - centre);
    let [m1, m2, m3] = misses(&rods, lowers);
    let [a, b, c] = rods;
    let (bc, ca, ab) = (b.cross(&c), c.cross(&a), a.cross(&b));
    let [l1, l2, l3] = lowers;
    let step = (bc * (m1 * l1) + ca * (m2 * l2) + ab * (m3 * l3)) / a.dot(&bc);
    let next = place + step;
    let left = misses(&centres.map(|centre| next - centre), lowers);
    let largest = |misses: [T; 3]| {
        misses
            .map(|miss| miss.abs())
            .into_iter()
            .fold(T::zero(), T::max)
    };
    // Written so that what is not a number is not nearer.
    let is_nearer = step.norm_squared().is_finite() && largest(left) < largest([m1, m2, m3]);
    if is_nearer { next } else { place }
}

/// By how much each rod is shorter than its lower arm.
fn misses<T: RealField + Copy>(rods: &[Vector3<T>; 3], lowers: [T; 3]) -> [T; 3] {
    zip(rods.each_ref(), lowers).map(|(rod, lower)| lower - rod.norm())
}
