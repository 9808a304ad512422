//! The way of a body through poses.

pub(crate) mod leg;

use nalgebra::{Isometry3, RealField};

pub use leg::Leg;

use crate::number::epsilons;
use crate::{Convention, PoseVector};

/// How a body moves from one pose to the next. The three differ: say which one you mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Interpolation {
    /// The body's reference point on a straight line, the rotation on its shortest arc about
    /// an axis that keeps its direction.
    Straight,
    /// A turn about one line of space and a slide along it, by the shorter turn; every point
    /// of the body on a helix, whichever point is the reference.
    Screw,
    /// All six numbers of the pose vector linear, as in [Alignment 2010]. Angles take the
    /// whole turn nearest to those of the pose before.
    Vector(Convention),
}

/// Why poses do not make a path.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PathError<T = f64> {
    /// A path has at least a first and a last pose.
    #[error("{poses} poses do not make a path, at least 2 do")]
    TooFew {
        /// The number of poses.
        poses: usize,
    },
    /// A pose is not finite.
    #[error("pose {pose} is not finite")]
    NotFinite {
        /// The pose, from 0.
        pose: usize,
    },
    /// The turn between two poses is half a turn: both ways round are the shorter one.
    #[error(
        "the turn from pose {pose} to the next is {angle} rad, half a turn: name a pose between"
    )]
    HalfTurn {
        /// The first of the two poses, from 0.
        pose: usize,
        /// The angle between them, in radians.
        angle: T,
    },
}

/// How near to half a turn its direction is lost, in machine epsilons.
const HALF_TURN_EPSILONS: f64 = 64.0;

/// Poses that the caller keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stations<'a, T: RealField> {
    Poses(&'a [Isometry3<T>], Interpolation),
    Vectors(&'a [PoseVector<T>], Convention),
}

/// A checked path: a first pose, any number of poses on the way, a last pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Path<'a, T: RealField = f64> {
    stations: Stations<'a, T>,
}

impl<'a, T: RealField + Copy> Path<'a, T> {
    /// A path through poses, each leg by the same `interpolation`.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn new(
        poses: &'a [Isometry3<T>],
        interpolation: Interpolation,
    ) -> Result<Self, PathError<T>> {
        let finite = |pose: &Isometry3<T>| {
            let rotation = pose.rotation.as_vector();
            (pose.translation.vector.norm() + rotation.norm()).is_finite()
        };
        check(poses, finite)?;
        let path = Self {
            stations: Stations::Poses(poses, interpolation),
        };
        if !matches!(interpolation, Interpolation::Vector(_)) {
            path.check_turns()?;
        }
        Ok(path)
    }

    /// A path through pose vectors, all six numbers linear between them as they are given:
    /// an angle may run through more than half a turn.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn of_vectors(
        vectors: &'a [PoseVector<T>],
        convention: Convention,
    ) -> Result<Self, PathError<T>> {
        let finite = |v: &PoseVector<T>| (v.position().norm() + v.angles().norm()).is_finite();
        check(vectors, finite)?;
        Ok(Self {
            stations: Stations::Vectors(vectors, convention),
        })
    }

    /// The number of legs: one fewer than poses.
    #[must_use]
    pub const fn legs(&self) -> usize {
        let poses = match self.stations {
            Stations::Poses(poses, _) => poses.len(),
            Stations::Vectors(vectors, _) => vectors.len(),
        };
        poses.saturating_sub(1)
    }

    /// The leg from pose `number` to the next; `None` past the last.
    #[must_use]
    pub fn leg(&self, number: usize) -> Option<Leg<T>> {
        let next = number.checked_add(1)?;
        Some(match self.stations {
            Stations::Poses(poses, interpolation) => {
                Leg::new(poses.get(number)?, poses.get(next)?, interpolation)
            }
            Stations::Vectors(vectors, convention) => {
                Leg::of_vectors(vectors.get(number)?, vectors.get(next)?, convention)
            }
        })
    }

    fn check_turns(&self) -> Result<(), PathError<T>> {
        for pose in 0..self.legs() {
            let angle = self.leg(pose).map_or(T::zero(), |leg| leg.turn());
            if angle >= T::pi() * (T::one() - epsilons(HALF_TURN_EPSILONS)) {
                return Err(PathError::HalfTurn { pose, angle });
            }
        }
        Ok(())
    }
}

fn check<S, T>(stations: &[S], finite: impl Fn(&S) -> bool) -> Result<(), PathError<T>> {
    if stations.len() < 2 {
        return Err(PathError::TooFew {
            poses: stations.len(),
        });
    }
    match stations.iter().position(|station| !finite(station)) {
        Some(pose) => Err(PathError::NotFinite { pose }),
        None => Ok(()),
    }
}
