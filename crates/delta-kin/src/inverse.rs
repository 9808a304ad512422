//! From a position to the three angles, knees out or in, within the limits, with reasons.

use nalgebra::{Point3, RealField, Vector3};

use crate::arm::zip;
use crate::leg::{Leg, Triangle, middle};
use crate::limits::max_value;
use crate::{Arm, Delta, Knee};

/// Why no angles bring the platform to a point.
///
/// Where more than one arm fails, the reach comes before the limits, and of several arms the
/// one that misses by most is named.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InverseError<T = f64> {
    /// A coordinate is infinite or not a number.
    #[error("point ({x}, {y}, {z}) is not finite")]
    NotFinite {
        /// X as given.
        x: T,
        /// Y as given.
        y: T,
        /// Z as given.
        z: T,
    },
    /// Wherever the arm turns, its lower arm ends before the platform.
    #[error("out of reach: {arm} is {by} too short")]
    TooFar {
        /// The arm.
        arm: Arm,
        /// By how much the lower arm is too short, in the unit of length.
        by: T,
    },
    /// Wherever the arm turns, its lower arm ends behind the platform.
    #[error("out of reach: {arm} is {by} too long")]
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
    /// The point is within reach, but a rod would lean too far for its ball joints.
    #[error("{arm} would lean by {lean} rad at its ball joints, more than {max} rad")]
    BallJoint {
        /// The arm.
        arm: Arm,
        /// How far the rods would lean out of the arm's plane, in radians.
        lean: T,
        /// How far they may, in radians.
        max: T,
    },
    /// The point is within reach, but an arm would leave its range.
    #[error("{arm} at {angle} rad is outside its range {min}..={max} rad")]
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

impl<T: RealField + Copy> Delta<T> {
    /// The angles that bring the platform's centre to `point`, knees out.
    ///
    /// For each arm, with u the point along its azimuth, w beside it, D = R - r:
    ///
    /// ```text
    /// p = D - u,   h² = p² + z²,   k = (La² - Lb² - h² - w²) / (2 Lb),   m = √(h² - k²)
    /// knee out: θ = atan2(k p - m z, k z + m p)
    /// knee in:  θ = atan2(k p + m z, k z - m p)
    /// ```
    ///
    /// Nothing is divided by what can vanish, and the two solutions never change places. m is
    /// the distance of the wrist from the upper arm's line; m² < 0 is out of reach. The angle is
    /// such that the lower arm's length is met within 4 machine epsilons of the
    /// [`span`](Self::span), also on the edges of the workspace. What [`forward`](Self::forward) made is
    /// never refused: up to [`tolerance`](Self::tolerance) past an edge counts as on it, for
    /// limits too.
    ///
    /// Angles read from the machine's zero, in radians. θ is within -π..=π, and where the arm
    /// has a range, at the whole turn that lies in it.
    ///
    /// # Errors
    /// [`InverseError`].
    #[inline]
    pub fn inverse(&self, point: Point3<T>) -> Result<Vector3<T>, InverseError<T>> {
        self.inverse_knees(point, [Knee::Out; 3])
    }

    /// As [`inverse`](Self::inverse), with the knee of each arm as named.
    ///
    /// # Errors
    /// [`InverseError`].
    #[inline]
    pub fn inverse_knees(
        &self,
        point: Point3<T>,
        knees: [Knee; 3],
    ) -> Result<Vector3<T>, InverseError<T>> {
        let local = self.flip(point.coords);
        let [first, second, third] = zip(self.legs().each_ref(), knees).map(|(leg, knee)| {
            let triangle = leg.triangle(&local);
            let m2 = triangle.m2();
            // Out of reach it is not a number, and so within no range.
            let angle = leg.angle(triangle.theta(knee, m2.sqrt()));
            let admitted = (m2 > T::zero())
                & (leg.min <= angle)
                & (angle <= leg.max)
                & (triangle.side.abs() <= leg.max_side);
            (angle, admitted)
        });
        if first.1 & second.1 & third.1 {
            return Ok(Vector3::new(first.0, second.0, third.0));
        }
        self.inverse_at_limits(point, local, knees)
    }

    /// The angle of one arm alone, whatever the others can do.
    ///
    /// # Errors
    /// [`InverseError`].
    pub fn inverse_arm(
        &self,
        point: Point3<T>,
        arm: Arm,
        knee: Knee,
    ) -> Result<T, InverseError<T>> {
        let [first, second, third] = self.legs();
        let leg = match arm {
            Arm::First => first,
            Arm::Second => second,
            Arm::Third => third,
        };
        if !point.coords.iter().all(T::is_finite) {
            return Err(not_finite(point));
        }
        self.solve(arm, leg, &self.flip(point.coords), knee)
            .map_err(|miss| miss.error)
    }

    /// By how much each arm can reach `point` without its limits, in the unit of length: no
    /// point nearer than this is out of the arm's reach. Negative: by how much the lower arm
    /// is too short or too long.
    #[must_use]
    pub fn reach_margins(&self, point: Point3<T>) -> Vector3<T> {
        let local = self.flip(point.coords);
        let margins = self.legs().each_ref().map(|leg| leg.reach_margin(&local));
        Vector3::from(margins)
    }

    /// The same where an arm is on an edge or beyond.
    #[cold]
    fn inverse_at_limits(
        &self,
        point: Point3<T>,
        local: Vector3<T>,
        knees: [Knee; 3],
    ) -> Result<Vector3<T>, InverseError<T>> {
        if !point.coords.iter().all(T::is_finite) {
            return Err(not_finite(point));
        }
        let solved = zip(zip(Arm::ALL, self.legs().each_ref()), knees)
            .map(|((arm, leg), knee)| self.solve(arm, leg, &local, knee));
        let worst = solved
            .iter()
            .filter_map(|arm| arm.err())
            .reduce(|a, b| if b.is_worse_than(&a) { b } else { a });
        match (solved, worst) {
            ([Ok(first), Ok(second), Ok(third)], _) => Ok(Vector3::new(first, second, third)),
            (_, Some(miss)) => Err(miss.error),
            // Not all are solved, so there is a miss.
            (_, None) => Err(not_finite(point)),
        }
    }

    fn solve(&self, arm: Arm, leg: &Leg<T>, local: &Vector3<T>, knee: Knee) -> Result<T, Miss<T>> {
        let triangle = leg.triangle(local);
        self.reach(arm, leg, &triangle)?;
        let m = triangle.m2().max(T::zero()).sqrt();
        let angle = leg.angle(triangle.theta(knee, m));
        let angle = self
            .fit(leg, local, angle)
            .map_err(|(angle, by)| Miss::limit(arm, leg, angle, by))?;
        if triangle.side.abs() > leg.max_side + self.tolerance() {
            let lean = lean(&triangle, leg.lower);
            let max = (leg.max_side / leg.lower).asin();
            let error = InverseError::BallJoint { arm, lean, max };
            return Err(Miss::new(1, lean - max, error));
        }
        Ok(angle)
    }

    /// Whether the rod can be where the wrist is.
    fn reach(&self, arm: Arm, leg: &Leg<T>, triangle: &Triangle<T>) -> Result<(), Miss<T>> {
        let (near, far) = leg.knee_distances(triangle);
        let tolerance = self.tolerance();
        // Near the largest number a distance overflows.
        let short = (near - leg.lower).min(max_value());
        let long = leg.lower - far;
        if short > tolerance {
            let error = InverseError::TooFar { arm, by: short };
            return Err(Miss::new(3, short, error));
        }
        if long > tolerance {
            let error = InverseError::TooNear { arm, by: long };
            return Err(Miss::new(3, long, error));
        }
        if triangle.h2.sqrt() <= tolerance {
            let error = InverseError::AnyAngle { arm };
            return Err(Miss::new(2, T::zero(), error));
        }
        Ok(())
    }

    /// `angle` at the whole turn within the range; on an end that it misses by rounding alone;
    /// else by how much it misses.
    fn fit(&self, leg: &Leg<T>, local: &Vector3<T>, angle: T) -> Result<T, (T, T)> {
        let (min, max) = (leg.min, leg.max);
        let holds = |angle: T| min <= angle && angle <= max;
        if holds(angle) {
            return Ok(angle);
        }
        let turn = T::two_pi();
        let turns = ((middle(min, max) - angle) / turn).round();
        let angle = angle + turns * turn;
        if holds(angle) {
            return Ok(angle);
        }
        for end in [min, max] {
            // The other end may be the nearer one by a whole turn.
            let apart = (end - angle) / turn;
            let nearest = (apart - apart.round()).abs() * turn;
            let miss = leg.stretch(local, leg.theta(end)).abs();
            if nearest < T::frac_pi_2() && miss <= self.tolerance() {
                return Ok(end);
            }
        }
        Err((angle, (min - angle).max(angle - max)))
    }
}

impl<T: RealField + Copy> Leg<T> {
    /// How far the point can move before the arm, without its limits, no longer reaches it.
    pub(crate) fn reach_margin(&self, local: &Vector3<T>) -> T {
        let (near, far) = self.knee_distances(&self.triangle(local));
        (self.lower - near).min(far - self.lower)
    }
}

/// How far the rods lean out of the arm's plane.
fn lean<T: RealField + Copy>(triangle: &Triangle<T>, lower: T) -> T {
    (triangle.side.abs() / lower).min(T::one()).asin()
}

#[cold]
fn not_finite<T: RealField + Copy>(point: Point3<T>) -> InverseError<T> {
    let (x, y, z) = (point.x, point.y, point.z);
    InverseError::NotFinite { x, y, z }
}

/// What an arm cannot do.
#[derive(Debug, Clone, Copy)]
struct Miss<T> {
    class: u8,
    by: T,
    error: InverseError<T>,
}

impl<T: RealField + Copy> Miss<T> {
    const fn new(class: u8, by: T, error: InverseError<T>) -> Self {
        Self { class, by, error }
    }

    fn limit(arm: Arm, leg: &Leg<T>, angle: T, by: T) -> Self {
        let (min, max) = (leg.min, leg.max);
        let error = InverseError::JointLimit {
            arm,
            angle,
            min,
            max,
        };
        Self::new(0, by, error)
    }

    fn is_worse_than(&self, other: &Self) -> bool {
        self.class > other.class || (self.class == other.class && self.by > other.by)
    }
}
