//! The arm: link lengths, base, limits, keep-out.

mod error;

use nalgebra::{Isometry2, RealField, Vector2};
use trig_kernels::Trig;

pub use error::GeometryError;

use crate::Limits;
use crate::limits::two;
use crate::range::{largest_angle, largest_ratio, length, link_lengths, norm, within};

/// A two-link arm with parallel joint axes, in any unit of length, the same throughout.
///
/// Each `with_` method returns the changed arm, so that a machine reads as one expression:
///
/// ```
/// use core::f64::consts::{FRAC_PI_2, PI};
/// use scara_kin::{Arm, JointRange, Limits};
/// use scara_kin::nalgebra::{Isometry2, Vector2};
///
/// let arm = Arm::new(132.0, 132.0)?
///     .with_base(Isometry2::new(Vector2::new(0.0, -80.0), FRAC_PI_2))?
///     .with_limits(Limits {
///         shoulder: JointRange::new(-PI, PI)?,
///         elbow: JointRange::new(-2.6, 2.6)?,
///     })
///     .with_keep_out(40.0)?;
/// assert_eq!(arm.reach(), 264.0);
/// # Ok::<(), scara_kin::GeometryError<f64>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arm<T: RealField = f64> {
    upper: T,
    fore: T,
    base: Isometry2<T>,
    limits: Limits<T>,
    /// The part of the limits in which an angle is at its turn.
    principal_range: Limits<T>,
    keep_out: T,
    tolerance: T,
    squares: Squares<T>,
}

/// Squares that follow from the geometry, of which each `inverse` takes all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Squares<T> {
    /// Squares of the distances from the base between which the tool can be, a rounding past the
    /// edges included; zero where there is no inner one.
    pub(crate) nearest: T,
    pub(crate) farthest: T,
    /// Squares of the links' difference and of their sum.
    pub(crate) folded: T,
    pub(crate) reach: T,
    /// Squares of the links.
    pub(crate) longer: T,
    pub(crate) shorter: T,
    /// That of the upper arm less that of the forearm.
    pub(crate) difference: T,
    /// 1 / (2 l1 l2), and 1 / (2 l1).
    pub(crate) per_elbow: T,
    pub(crate) per_shoulder: T,
}

impl<T: RealField + Copy> Squares<T> {
    fn new([upper, fore]: [T; 2], keep_out: T, tolerance: T) -> Self {
        let (folded, reach) = (upper - fore, upper + fore);
        let nearest = (folded.abs().max(keep_out) - tolerance).max(T::zero());
        let farthest = reach + tolerance;
        let (longer, shorter) = (upper.max(fore), upper.min(fore));
        Self {
            nearest: nearest * nearest,
            farthest: farthest * farthest,
            folded: folded * folded,
            reach: reach * reach,
            longer: longer * longer,
            shorter: shorter * shorter,
            difference: folded * reach,
            per_elbow: (upper * fore * two()).recip(),
            per_shoulder: (upper * two()).recip(),
        }
    }
}

/// Rounding steps allowed between `forward` and `inverse`, in machine epsilons of
/// reach and base distance: a product, a rotation and a sum for each of two
/// links, and the base's transformation there and back.
const ROUNDING_STEPS: f64 = 16.0;

impl<T: RealField + Trig> Arm<T> {
    /// An arm of the two link lengths, its base at the origin along X, without limits.
    ///
    /// The lengths may differ by a factor of 1/64ε (f64: 7e13, f32: 1.3e5). In f64 they lie
    /// within 6e-39..=2.8e76, in f32 within 3e-5..=1e9.
    ///
    /// # Errors
    /// [`GeometryError::LinkLength`].
    pub fn new(upper: T, fore: T) -> Result<Self, GeometryError<T>> {
        let (min, max) = link_lengths::<T>();
        let check = |link, length: T, min: T, max: T| {
            // Written so that NaN is refused too.
            if length >= min && length <= max {
                Ok(())
            } else {
                Err(GeometryError::LinkLength {
                    link,
                    length,
                    min,
                    max,
                })
            }
        };
        check("upper arm", upper, min, max)?;
        let ratio = largest_ratio::<T>();
        check(
            "forearm",
            fore,
            min.max(upper / ratio),
            max.min(upper * ratio),
        )?;
        let arm = Self {
            upper,
            fore,
            base: Isometry2::identity(),
            limits: Limits::unlimited(),
            principal_range: Limits::unlimited().principal_range(),
            keep_out: T::zero(),
            tolerance: T::zero(),
            squares: Squares::new([upper, fore], T::zero(), T::zero()),
        };
        Ok(arm.prepared())
    }

    /// The arm with its base at `base`: the position of the shoulder's axis and the
    /// direction in which the upper arm's zero points.
    ///
    /// Its coordinates are at most 1/64ε (f64: 7e13, f32: 1.3e5) of the shorter link. A
    /// rotation that has drifted from length one by up to √ε is corrected.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`], [`GeometryError::Rotation`].
    pub fn with_base(mut self, mut base: Isometry2<T>) -> Result<Self, GeometryError<T>> {
        let farthest = self.upper.min(self.fore) * largest_ratio();
        within(farthest, "base x", base.translation.x)?;
        within(farthest, "base y", base.translation.y)?;
        let (re, im) = (base.rotation.re, base.rotation.im);
        let length = length(Vector2::new(re, im));
        let drift = (length - T::one()).abs();
        let is_rotation = drift <= largest_angle::<T>().recip();
        if !is_rotation {
            return Err(GeometryError::Rotation { length });
        }
        // What nalgebra's constructors make stays as it is, to the bit.
        if drift > T::default_epsilon() * two() {
            base.rotation.renormalize();
        }
        self.base = base;
        Ok(self.prepared())
    }

    /// The arm with joint limits.
    #[must_use]
    pub fn with_limits(mut self, limits: Limits<T>) -> Self {
        self.limits = limits;
        self.principal_range = limits.principal_range();
        self
    }

    /// The arm with a disc round the base's axis that the tool must not enter.
    ///
    /// # Errors
    /// [`GeometryError::KeepOut`].
    pub fn with_keep_out(mut self, radius: T) -> Result<Self, GeometryError<T>> {
        let reach = self.reach();
        if !(radius >= T::zero() && radius < reach) {
            return Err(GeometryError::KeepOut { radius, reach });
        }
        self.keep_out = radius;
        Ok(self.prepared())
    }

    /// With what follows from the rest.
    fn prepared(mut self) -> Self {
        let span = self.reach() + norm(self.base.translation.vector);
        self.tolerance = span * T::default_epsilon() * nalgebra::convert(ROUNDING_STEPS);
        self.squares = Squares::new([self.upper, self.fore], self.keep_out, self.tolerance);
        self
    }

    /// Length of the upper arm.
    #[must_use]
    pub const fn upper(&self) -> T {
        self.upper
    }

    /// Length of the forearm.
    #[must_use]
    pub const fn fore(&self) -> T {
        self.fore
    }

    /// Base position and rotation.
    #[must_use]
    pub const fn base(&self) -> &Isometry2<T> {
        &self.base
    }

    /// Joint limits.
    #[must_use]
    pub const fn limits(&self) -> &Limits<T> {
        &self.limits
    }

    pub(crate) const fn principal_range(&self) -> &Limits<T> {
        &self.principal_range
    }

    pub(crate) const fn squares(&self) -> &Squares<T> {
        &self.squares
    }

    /// Radius of the disc round the base that the tool must not enter; zero for none.
    #[must_use]
    pub const fn keep_out(&self) -> T {
        self.keep_out
    }

    /// Distance from base to tool of the stretched arm.
    #[must_use]
    pub fn reach(&self) -> T {
        self.upper + self.fore
    }

    /// Distance from the base within which the tool cannot be: that of the folded
    /// arm, or the keep-out radius where that is larger.
    #[must_use]
    pub fn inner_reach(&self) -> T {
        (self.upper - self.fore).abs().max(self.keep_out)
    }

    /// How far past an edge of the workspace a point may lie by rounding alone, in the
    /// unit of length: 16 machine epsilons of reach plus base distance. Such a point is
    /// taken as being on the edge.
    #[must_use]
    pub const fn tolerance(&self) -> T {
        self.tolerance
    }
}
