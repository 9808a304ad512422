//! Straight lines and arcs as joint waypoints within a chord tolerance, with durations.

mod bisect;
mod bound;
mod path;
mod walk;

use core::fmt;
use core::iter::FusedIterator;

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::Trig;

use crate::range::largest_rate;
use crate::rounded::Rounded;
use crate::{Arm, Delta, InverseError};
pub use path::{PlatformPath, PlatformPathError};
use walk::Walk;

/// A point of the path with the angles that reach it, and the time of the move to it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Waypoint<T: RealField = f64> {
    /// The angles as they read, in radians.
    pub angles: Vector3<T>,
    /// The platform's centre, on the path.
    pub point: Point3<T>,
    /// The fraction of the path up to there, 0..=1.
    pub fraction: T,
    /// Length of the path since the waypoint before.
    pub length: T,
    /// Time since the waypoint before, in seconds: as the feed has it, or longer where an arm
    /// would turn faster than it may.
    pub duration_s: T,
}

/// How fast the platform and the arms may move.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedLimits<T = f64> {
    feed: T,
    max_rates: [T; 3],
}

impl<T: RealField + Copy> SpeedLimits<T> {
    /// A feed of the platform in length per second, and the largest rate of each arm in rad/s.
    ///
    /// # Errors
    /// [`FollowError::SpeedLimits`] unless all are within 1/h²..=h², h the fourth root of the
    /// largest number divided by 32 (f64: 8e-152..=1e151, f32: 6e-17..=1.8e16).
    pub fn new(feed: T, max_rates: [T; 3]) -> Result<Self, FollowError<T>> {
        let [first, second, third] = max_rates;
        for (name, value) in [
            ("feed", feed),
            ("rate of arm 1", first),
            ("rate of arm 2", second),
            ("rate of arm 3", third),
        ] {
            let max = largest_rate::<T>();
            let min = max.recip();
            // Written so that NaN is refused too.
            if !(value >= min && value <= max) {
                return Err(FollowError::SpeedLimits {
                    name,
                    value,
                    min,
                    max,
                });
            }
        }
        Ok(Self { feed, max_rates })
    }

    /// The time that a straight joint move along a path of `length` needs, in seconds.
    fn duration_s(&self, length: T, change: Vector3<T>) -> T {
        let rates = Vector3::from(self.max_rates);
        change
            .abs()
            .component_div(&rates)
            .max()
            .max(length / self.feed)
    }
}

/// Why a path cannot be followed; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FollowError<T: RealField + Copy = f64> {
    /// The tolerance is not a length well above the machine's rounding.
    #[error("chord tolerance {} is not above the rounding {}", Rounded(*.tolerance), Rounded(*.rounding))]
    Tolerance {
        /// The tolerance given.
        tolerance: T,
        /// What it has to be above: 64 times [`Delta::tolerance`].
        rounding: T,
    },
    /// A feed or rate is not a number between the stated ends.
    #[error("{name} {} is not within {}..={}", Rounded(*.value), Rounded(*.min), Rounded(*.max))]
    SpeedLimits {
        /// `feed` or the rate of an arm.
        name: &'static str,
        /// The value given.
        value: T,
        /// The smallest allowed.
        min: T,
        /// The largest allowed.
        max: T,
    },
    /// The platform cannot be at a point of the path.
    #[error("{}: {reason}", At(*.fraction, *.point))]
    Unreachable {
        /// The fraction of the path up to there.
        fraction: T,
        /// The first such point.
        point: Point3<T>,
        /// Why.
        reason: InverseError<T>,
    },
    /// No step is short enough: the path leads through a singularity.
    #[error("{}: singular", At(*.fraction, *.point))]
    Singular {
        /// The fraction of the path up to there.
        fraction: T,
        /// The point.
        point: Point3<T>,
    },
    /// An arm would have to jump by a whole turn: at π from straight down, or from one end of a
    /// range of a whole turn to the other. An [`ArmRange`](crate::ArmRange) that holds the
    /// path avoids it.
    #[error("{}: {arm} would have to jump by a whole turn", At(*.fraction, *.point))]
    Turn {
        /// The fraction of the path up to there.
        fraction: T,
        /// The point.
        point: Point3<T>,
        /// The arm.
        arm: Arm,
    },
}

/// A point of a path.
struct At<T: RealField>(T, Point3<T>);

impl<T: RealField + Copy> fmt::Display for At<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.1.coords.into();
        let [fraction, x, y, z] = [self.0, x, y, z].map(Rounded);
        write!(f, "at {fraction} of the path, ({x}, {y}, {z})")
    }
}

/// The smallest tolerance, in those of the machine: the rounding of three rods, times conditioning.
const SMALLEST_TOLERANCE: f64 = 64.0;

impl<T: RealField + Trig> Delta<T> {
    /// Joint waypoints along `path`, in the machine's modes, such that the straight joint move from
    /// each to the next keeps the platform within `tolerance` of the path, in the time that
    /// `limits` allows.
    ///
    /// The tolerance is a guarantee: a step is taken when its
    /// [`chord_bound`](Self::chord_bound), which is proven and not sampled, plus the height of
    /// its arc keeps it, and is halved until it does. Point of the path and platform are
    /// that near at every fraction of the step, so this holds from the platform to the path and
    /// from the path to the platform. Between two waypoints the arms turn at constant rates, so
    /// none is faster than its limit; ranges are kept since they hold both ends, ball joints but
    /// for the tolerance. The working mode is kept at each waypoint, the assembly mode between them
    /// too.
    ///
    /// The path is walked once before anything is handed out, so that an error comes first
    /// and the number of waypoints is known: [`Follow::remaining`]. Memory does not grow with the
    /// path.
    ///
    /// # Errors
    /// [`FollowError`]; the point named is the first along the path.
    pub fn follow(
        &self,
        path: PlatformPath<T>,
        tolerance: T,
        limits: SpeedLimits<T>,
    ) -> Result<Follow<T>, FollowError<T>> {
        let rounding = self.tolerance() * nalgebra::convert(SMALLEST_TOLERANCE);
        if !(tolerance.is_finite() && tolerance > rounding) {
            return Err(FollowError::Tolerance {
                tolerance,
                rounding,
            });
        }
        let walk = Walk::new(*self, path, tolerance, limits);
        let mut remaining: u64 = 0;
        for waypoint in walk.clone() {
            waypoint?;
            remaining = remaining.saturating_add(1);
        }
        Ok(Follow { walk, remaining })
    }
}

/// The waypoints of a path that has been found to be reachable: see [`Delta::follow`].
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Follow<T: RealField = f64> {
    walk: Walk<T>,
    remaining: u64,
}

impl<T: RealField> Follow<T> {
    /// Waypoints still to come.
    #[must_use]
    pub const fn remaining(&self) -> u64 {
        self.remaining
    }
}

impl<T: RealField + Trig> Iterator for Follow<T> {
    type Item = Waypoint<T>;

    fn next(&mut self) -> Option<Waypoint<T>> {
        // The walk has no error: it is the one that was checked.
        let waypoint = self.walk.next()?.ok()?;
        self.remaining = self.remaining.saturating_sub(1);
        Some(waypoint)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        match usize::try_from(self.remaining) {
            Ok(remaining) => (remaining, Some(remaining)),
            Err(_) => (usize::MAX, None),
        }
    }
}

impl<T: RealField + Trig> FusedIterator for Follow<T> {}
