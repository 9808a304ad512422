//! From a position to the three angles, in the machine's modes and within its limits, with reasons.

use core::fmt;

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::{Trig, atan2_of_length, sqrt};

#[cfg(feature = "path-timing")]
use crate::PoseError;
use crate::arm::{smallest, zip};
use crate::prepared::{Heading, PreparedArm, Triangle, middle, thetas};
use crate::range::{half, max_value};
use crate::rounded::Rounded;
use crate::{Arm, AssemblyMode, Delta, ElbowSide, ZAxis};

/// Why no angles bring the platform to a point.
///
/// Where more than one thing is wrong the first of this list is reported, and of several arms the
/// one that misses by most.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InverseError<T: RealField + Copy = f64> {
    /// A coordinate is infinite or not a number.
    #[error("point ({}, {}, {}) is not finite", Rounded(*.x), Rounded(*.y), Rounded(*.z))]
    NotFinite {
        /// X as given.
        x: T,
        /// Y as given.
        y: T,
        /// Z as given.
        z: T,
    },
    /// Wherever the arm turns, its lower arm ends short of the platform.
    #[error("out of reach: {arm} is {} too short", Rounded(*.by))]
    TooFar {
        /// The arm.
        arm: Arm,
        /// By how much the lower arm is too short, in the unit of length.
        by: T,
    },
    /// Wherever the arm turns, its lower arm ends past the platform.
    #[error("out of reach: {arm} is {} too long", Rounded(*.by))]
    TooNear {
        /// The arm.
        arm: Arm,
        /// By how much the lower arm is too long, in the unit of length.
        by: T,
    },
    /// The wrist is on the motor's axis: every angle of the arm is a solution.
    #[error("the wrist of {arm} is on the axis of its motor: any angle reaches it")]
    AnyAngle {
        /// The arm.
        arm: Arm,
    },
    /// The elbows would lie on a line, each moved inward by the platform's radius: the arms do not
    /// hold the platform, it could turn about that line.
    #[error(
        "the elbows, moved inward by the platform's radius, lie on a line: nothing holds the platform"
    )]
    Collinear,
    /// The plane of the elbows would be upright: of the two points of these angles neither is the
    /// lower, so that the point is in no assembly mode.
    #[error(
        "the plane of the elbows is upright: neither of the two points of these angles is the lower"
    )]
    Upright,
    /// The arms reach the point, but only in the other assembly mode: with these angles
    /// [`forward`](Delta::forward) is elsewhere.
    #[error("{}", Across { assembly_mode: *.assembly_mode, z: *.z })]
    OtherAssembly {
        /// The assembly mode in which it is reached.
        assembly_mode: AssemblyMode,
        /// The direction of z with which the machine would reach it, where it lies on the far side
        /// of the base plane: most likely the one that was meant. `None`: it lies beyond the
        /// singular surface, or where the plane of the elbows is past upright.
        z: Option<ZAxis>,
    },
    /// The point is within reach, but a rod would swivel too far for its ball joints.
    #[error(
        "{arm} would swivel by {} rad at its ball joints, more than {} rad",
        Rounded(*.swivel), Rounded(*.max)
    )]
    BallJoint {
        /// The arm.
        arm: Arm,
        /// How far the rods would swivel out of the arm's plane, in radians.
        swivel: T,
        /// How far they may, in radians.
        max: T,
    },
    /// The point is within reach, but an arm would leave its range.
    #[error(
        "{arm} at {} rad is outside its range {}..={} rad",
        Rounded(*.angle), Rounded(*.min), Rounded(*.max)
    )]
    JointLimit {
        /// The arm.
        arm: Arm,
        /// Its angle as it reads, in radians.
        angle: T,
        /// Lower end of its range, in radians.
        min: T,
        /// Upper end of its range, in radians.
        max: T,
    },
}

/// Why the other assembly mode, and what was probably meant.
pub(crate) struct Across {
    pub(crate) assembly_mode: AssemblyMode,
    pub(crate) z: Option<ZAxis>,
}

impl fmt::Display for Across {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mode = self.assembly_mode;
        let (side, other) = match mode {
            AssemblyMode::Upper => ("above", "higher"),
            AssemblyMode::Lower => ("below", "lower"),
        };
        match self.z {
            None => write!(
                f,
                "the point is the {other} of the two to which its angles bring the platform: \
                 it is reached in the {mode} assembly mode"
            ),
            Some(z) => write!(
                f,
                "the point lies {side} the base plane, where only the {mode} assembly mode \
                 reaches it; ZAxis::{z:?} would put it where the machine works"
            ),
        }
    }
}

#[cfg(feature = "path-timing")]
/// How fast the angles turn along a direction, or why they do not at a finite rate.
type Slopes<T> = Result<Vector3<T>, PoseError<T>>;

/// An arm, its triangle and heading, and one over the length of the heading.
type Reached<'a, T> = (&'a PreparedArm<T>, Triangle<T>, Heading<T>, T);

impl<T: RealField + Trig> Delta<T> {
    /// The angles that bring the platform's centre to `point`, in the machine's working and
    /// assembly modes: `forward` of them is the point.
    ///
    /// For each arm, with u the point along its azimuth, w across it, D = R - r:
    ///
    /// ```text
    /// p = D - u,   h² = p² + z²,   L² = La² - w²
    /// k = L² - h² - Lb²
    /// m = √(4 L² Lb² - (h² - L² - Lb²)²)
    /// elbow out: θ = atan2(k p - m z, k z + m p)
    /// elbow in:  θ = atan2(k p + m z, k z - m p)
    /// ```
    ///
    /// Nothing is divided by what can vanish, and the two solutions are never swapped. Where what
    /// is under the root is negative the point is out of reach. Where h < Lb/2 it is instead
    /// (L² - (h - Lb)²) ((h + Lb)² - L²), in which no squares of about equal lengths cancel. What
    /// [`forward`](Self::forward) made in the same modes is not refused: up to
    /// [`tolerance`](Self::tolerance) past an edge counts as on it, for limits too. Elbows within
    /// that of a line, as they are or seen from above, are in no mode.
    ///
    /// Angles read from the machine's zero, in radians. θ is within -π..=π, and where the arm
    /// has a range, at the whole turn that lies in it.
    ///
    /// # Errors
    /// [`InverseError`].
    #[inline]
    pub fn inverse(&self, point: impl Into<Point3<T>>) -> Result<Vector3<T>, InverseError<T>> {
        let point = point.into();
        let local = self.flip(point.coords);
        match self.admitted(&local) {
            Some((angles, _)) => Ok(angles),
            None => self.inverse_at_limits(point, local),
        }
    }

    #[cfg(feature = "path-timing")]
    /// The angles, and how fast each of them turns while the centre moves along `along`. With e the
    /// rod and t the direction of the elbow when its angle grows:
    ///
    /// ```text
    /// θ' = (e · along) / (e · t)
    /// ```
    pub(crate) fn inverse_with_slopes(
        &self,
        point: Point3<T>,
        along: Vector3<T>,
    ) -> Result<(Vector3<T>, Slopes<T>), InverseError<T>> {
        let local = self.flip(point.coords);
        if let Some((angles, arms)) = self.admitted(&local) {
            let along = self.flip(along);
            let parts = arms.map(|(prepared, triangle, heading, scale)| {
                let rod = prepared.rod(&triangle, &heading, scale);
                let tangent = prepared.in_plane(heading.cos * scale, heading.sin * scale);
                let lever = rod.dot(&tangent) * prepared.turn;
                let is_free = lever.abs() > self.tolerance() * prepared.lower;
                (is_free, rod.dot(&along) / lever)
            });
            let [(first, a), (second, b), (third, c)] = parts;
            if first && second && third {
                return Ok((angles, Ok(Vector3::new(a, b, c))));
            }
        }
        let pose = self.pose_at(point)?;
        Ok((pose.angles(), pose.joint_rates(along)))
    }

    /// The angles, and what they were found by, of a point that no arm reaches at a limit.
    #[inline(always)]
    fn admitted(&self, local: &Vector3<T>) -> Option<(Vector3<T>, [Reached<'_, T>; 3])> {
        let arms = zip(self.prepared().each_ref(), self.working_mode()).map(|(prepared, elbow)| {
            let triangle = prepared.triangle(local);
            (
                prepared,
                triangle,
                triangle.heading(elbow),
                triangle.scale(),
            )
        });
        let thetas = thetas(
            arms.map(|(prepared, _, heading, scale)| (heading, prepared.per_heading(scale))),
        );
        let angles =
            zip(self.prepared().each_ref(), thetas).map(|(prepared, theta)| prepared.angle(theta));
        // Out of reach an angle is not a number, and in no range.
        let is_admitted = zip(arms, angles).map(|((prepared, triangle, ..), angle)| {
            prepared.min <= angle
                && angle <= prepared.max
                && triangle.side.abs() <= prepared.max_side
        });
        let [first, second, third] = is_admitted;
        let rods = arms
            .map(|(prepared, triangle, heading, scale)| prepared.rod(&triangle, &heading, scale));
        if first && second && third && self.is_assembled(rods) {
            return Some((Vector3::from(angles), arms));
        }
        None
    }

    /// The angles where an arm is on an edge or beyond.
    #[cold]
    fn inverse_at_limits(
        &self,
        point: Point3<T>,
        local: Vector3<T>,
    ) -> Result<Vector3<T>, InverseError<T>> {
        if !point.coords.iter().all(T::is_finite) {
            let (x, y, z) = (point.x, point.y, point.z);
            return Err(InverseError::NotFinite { x, y, z });
        }
        // Each of these once for all arms, out of line: what is rare should be small.
        let arms = zip(Arm::ALL, self.prepared().each_ref())
            .map(|(arm, prepared)| (arm, prepared, triangle(prepared, &local)));
        worst(arms.map(|(arm, prepared, triangle)| self.out_of_reach(arm, prepared, &triangle)))?;
        for (arm, _, triangle) in arms {
            if sqrt(triangle.h2) <= self.tolerance() {
                return Err(InverseError::AnyAngle { arm });
            }
        }
        let thetas = zip(arms, self.working_mode())
            .map(|((_, prepared, triangle), elbow)| theta(prepared, &triangle.at_edge(), elbow));
        self.check_assembly(&local, thetas)?;
        worst(arms.map(|(arm, prepared, triangle)| self.swivelling(arm, prepared, &triangle)))?;
        let fitted = zip(arms, thetas).map(|((arm, prepared, _), theta)| {
            (
                arm,
                prepared,
                self.fit(prepared, &local, prepared.angle(theta)),
            )
        });
        worst(fitted.map(|(arm, prepared, (angle, by))| {
            let (min, max) = (prepared.min, prepared.max);
            let error = InverseError::JointLimit {
                arm,
                angle,
                min,
                max,
            };
            (by > T::zero()).then_some((by, error))
        }))?;
        let angles = Vector3::from(fitted.map(|(_, _, (angle, _))| angle));
        if self.forward(angles).is_err() {
            // Beyond the edges by a rounding each, and all rods in a plane: together too much.
            return Err(self.missed(&local, angles));
        }
        Ok(angles)
    }

    /// The arm whose rods miss by most.
    fn missed(&self, local: &Vector3<T>, angles: Vector3<T>) -> InverseError<T> {
        let misses = zip(self.prepared().each_ref(), self.thetas(angles))
            .map(|(prepared, theta)| prepared.stretch(local, theta));
        let (arm, negative) = smallest(misses.map(|miss| -miss.abs()));
        let by = -negative;
        let [first, second, third] = misses;
        if first.max(second).max(third) >= by {
            InverseError::TooFar { arm, by }
        } else {
            InverseError::TooNear { arm, by }
        }
    }

    /// By how much the rod cannot be where the wrist is.
    #[inline(never)]
    fn out_of_reach(
        &self,
        arm: Arm,
        prepared: &PreparedArm<T>,
        triangle: &Triangle<T>,
    ) -> Option<(T, InverseError<T>)> {
        let (near, far) = prepared.elbow_distances(triangle);
        // Near the largest number a distance overflows.
        let short = (near - prepared.lower).min(max_value());
        let long = prepared.lower - far;
        if short > self.tolerance() {
            return Some((short, InverseError::TooFar { arm, by: short }));
        }
        (long > self.tolerance()).then_some((long, InverseError::TooNear { arm, by: long }))
    }

    /// By how much the rods swivel too far.
    #[inline(never)]
    fn swivelling(
        &self,
        arm: Arm,
        prepared: &PreparedArm<T>,
        triangle: &Triangle<T>,
    ) -> Option<(T, InverseError<T>)> {
        let asin = |side: T| {
            let side = side.min(prepared.lower);
            atan2(
                side,
                sqrt((prepared.lower - side) * (prepared.lower + side)),
            )
        };
        let (swivel, max) = (asin(triangle.side.abs()), asin(prepared.max_side));
        let error = InverseError::BallJoint { arm, swivel, max };
        (triangle.side.abs() > prepared.max_side + self.tolerance())
            .then_some((swivel - max, error))
    }

    /// `angle` at the whole turn within the range, or on an end that it misses by rounding alone;
    /// and by how much it misses the range.
    #[inline(never)]
    fn fit(&self, prepared: &PreparedArm<T>, local: &Vector3<T>, angle: T) -> (T, T) {
        let (min, max) = (prepared.min, prepared.max);
        let holds = |angle: T| min <= angle && angle <= max;
        if holds(angle) {
            return (angle, T::zero());
        }
        let turn = T::two_pi();
        let turns = ((middle(min, max) - angle) / turn).round();
        let angle = angle + turns * turn;
        if holds(angle) {
            return (angle, T::zero());
        }
        let misses = |angle: T| {
            let miss = prepared.stretch(local, prepared.theta(angle)).abs();
            miss > self.tolerance()
        };
        for end in [min, max] {
            // The other end may be the nearer one by a whole turn.
            let turns = (end - angle) / turn;
            let apart = (turns - turns.round()) * turn;
            // Not where the elbow would be on the other side: halfway there the rod misses.
            let halfway = end - apart * half();
            if apart.abs() < T::frac_pi_2() && !misses(end) && !misses(halfway) {
                return (end, T::zero());
            }
        }
        (angle, (min - angle).max(angle - max))
    }
}

impl<T: RealField + Trig> PreparedArm<T> {
    /// How far the point can move before the arm, without its limits, no longer reaches it.
    pub(crate) fn reach_margin(&self, local: &Vector3<T>) -> T {
        let (near, far) = self.elbow_distances(&self.triangle(local));
        (self.lower - near).min(far - self.lower)
    }
}

#[inline(never)]
fn triangle<T: RealField + Trig>(prepared: &PreparedArm<T>, local: &Vector3<T>) -> Triangle<T> {
    prepared.triangle(local)
}

#[inline(never)]
fn theta<T: RealField + Trig>(
    prepared: &PreparedArm<T>,
    triangle: &Triangle<T>,
    elbow: ElbowSide,
) -> T {
    let heading = triangle.heading(elbow);
    let per_heading = prepared.per_heading(triangle.scale());
    atan2_of_length(heading.sin, heading.cos, per_heading)
}

#[inline(never)]
fn atan2<T: Trig>(y: T, x: T) -> T {
    trig_kernels::atan2(y, x)
}

/// The error of the arm that misses by most.
#[inline(never)]
fn worst<T: RealField + Copy>(
    misses: [Option<(T, InverseError<T>)>; 3],
) -> Result<(), InverseError<T>> {
    let worst = misses
        .into_iter()
        .flatten()
        .reduce(|a, b| if b.0 > a.0 { b } else { a });
    worst.map_or(Ok(()), |(_, error)| Err(error))
}
