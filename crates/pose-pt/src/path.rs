//! The path of a body through poses.

mod blend;
pub(crate) mod leg;

use core::f64::consts::PI;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

pub use blend::Blend;
pub use leg::Leg;

use crate::number::{epsilons, first_beyond, largest, largest_angle};
use crate::short::short;
use crate::{Convention, Platform, PoseVector};

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
pub enum PosePathError {
    /// A path has at least a first and a last pose.
    #[error("{poses} poses do not make a path, at least 2 do")]
    TooFew {
        /// The number of poses.
        poses: usize,
    },
    /// A coordinate is not finite, or beyond the range of the crate.
    #[error("coordinate {} of pose {pose} is not within ±{}", short(.value), short(.max))]
    Coordinate {
        /// The pose, from 0.
        pose: usize,
        /// Its coordinate.
        value: f64,
        /// Largest coordinate.
        max: f64,
    },
    /// An angle of a pose vector is not finite, or so large that its rounding counts.
    #[error("angle {} of pose {pose} is not within ±{} rad", short(.value), short(.max))]
    Angle {
        /// The pose, from 0.
        pose: usize,
        /// Its angle, in radians.
        value: f64,
        /// Largest angle, in radians.
        max: f64,
    },
    /// The quaternion of a pose is no rotation.
    #[error("the rotation of pose {pose} is a quaternion of length {}, not 1", short(.length))]
    Rotation {
        /// The pose, from 0.
        pose: usize,
        /// Length of its quaternion.
        length: f64,
    },
    /// The turn between two poses is half a turn: both directions are as short.
    #[error(
        "the turn from pose {pose} to the next is {} rad, half a turn: name a pose between",
        short(.angle)
    )]
    HalfTurn {
        /// The first of the two poses, from 0.
        pose: usize,
        /// The angle between them, in radians.
        angle: f64,
    },
    /// Not one blend for each pose between the first and the last.
    #[error("{given} blends for {poses} poses between the first and the last")]
    Blends {
        /// Blends given.
        given: usize,
        /// Poses between the first and the last.
        poses: usize,
    },
    /// A tolerance of a blend is negative or not finite.
    #[error("tolerance {} of the blend at pose {pose} is not a number from 0", short(.value))]
    Blend {
        /// The pose, from 0.
        pose: usize,
        /// The tolerance given.
        value: f64,
    },
    /// Screw motions have no blends.
    #[error("screw motions have no blends")]
    ScrewBlend,
}

/// Lengths of a quaternion that is a rotation, errors of scale aside: they do no harm.
const ROTATION_LENGTH: [f64; 2] = [0.5, 2.0];

/// How near to half a turn its direction is lost, in machine epsilons.
const HALF_TURN_EPSILONS: f64 = 64.0;

/// Poses that the caller keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
enum PathPoses<'a> {
    Poses(&'a [Isometry3<f64>], Interpolation),
    Vectors(&'a [PoseVector], Convention),
}

/// A checked path: a first pose, any number of poses between, a last pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosePath<'a> {
    poses: PathPoses<'a>,
    /// For each pose between the first and the last, or none for stops.
    blends: &'a [Blend],
}

impl<'a> PosePath<'a> {
    /// A path through poses, each leg by the same `interpolation`.
    ///
    /// # Errors
    /// [`PosePathError`].
    pub fn new(
        poses: &'a [Isometry3<f64>],
        interpolation: Interpolation,
    ) -> Result<Self, PosePathError> {
        check(poses, |number, pose| {
            check_position(number, &pose.translation.vector)?;
            check_rotation(number, &pose.rotation)
        })?;
        let path = Self {
            poses: PathPoses::Poses(poses, interpolation),
            blends: &[],
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
    /// [`PosePathError`].
    pub fn of_vectors(
        vectors: &'a [PoseVector],
        convention: Convention,
    ) -> Result<Self, PosePathError> {
        check(vectors, |number, vector| {
            check_position(number, &vector.position())?;
            check_angles(number, &vector.angles())
        })?;
        Ok(Self {
            poses: PathPoses::Vectors(vectors, convention),
            blends: &[],
        })
    }

    /// The path rounded at the poses between the first and the last, one tolerance for each: timed
    /// by `path-timing` the body passes them without a stop. A [`PtTable`](crate::PtTable) and
    /// [`leg`](Self::leg) stay unrounded.
    ///
    /// # Errors
    /// [`PosePathError::Blends`], [`PosePathError::Blend`], [`PosePathError::ScrewBlend`].
    pub fn with_blends(self, blends: &'a [Blend]) -> Result<Self, PosePathError> {
        let poses = self.legs().saturating_sub(1);
        if blends.len() != poses {
            let given = blends.len();
            return Err(PosePathError::Blends { given, poses });
        }
        if matches!(self.poses, PathPoses::Poses(_, Interpolation::Screw)) {
            return Err(PosePathError::ScrewBlend);
        }
        for (number, blend) in blends.iter().enumerate() {
            for value in [blend.distance, blend.rotation_rad] {
                if !(value >= 0.0 && value.is_finite()) {
                    let pose = number.saturating_add(1);
                    return Err(PosePathError::Blend { pose, value });
                }
            }
        }
        Ok(Self { blends, ..self })
    }

    /// How far each pose between the first and the last is rounded; empty where all are stops.
    #[must_use]
    pub const fn blends(&self) -> &'a [Blend] {
        self.blends
    }

    /// The number of legs: one fewer than poses.
    #[must_use]
    pub const fn legs(&self) -> usize {
        let poses = match self.poses {
            PathPoses::Poses(poses, _) => poses.len(),
            PathPoses::Vectors(vectors, _) => vectors.len(),
        };
        poses.saturating_sub(1)
    }

    /// The leg from pose `number` to the next; `None` past the last.
    #[must_use]
    pub fn leg(&self, number: usize) -> Option<Leg> {
        let next = number.checked_add(1)?;
        Some(match self.poses {
            PathPoses::Poses(poses, interpolation) => {
                Leg::new(poses.get(number)?, poses.get(next)?, interpolation)
            }
            PathPoses::Vectors(vectors, convention) => {
                Leg::of_vectors(vectors.get(number)?, vectors.get(next)?, convention)
            }
        })
    }

    /// All legs with their numbers, from 0.
    pub(crate) fn numbered_legs(&self) -> impl Iterator<Item = (usize, Leg)> {
        (0..self.legs()).filter_map(|number| Some((number, self.leg(number)?)))
    }

    /// Where the axes are at pose `number`; `None` past the last.
    pub(crate) fn axes<const N: usize>(
        &self,
        platform: &Platform<N>,
        number: usize,
    ) -> Option<[Vector3<f64>; N]> {
        Some(match self.poses {
            PathPoses::Poses(poses, _) => platform.axes(poses.get(number)?),
            PathPoses::Vectors(vectors, convention) => {
                let vector = vectors.get(number)?;
                platform.axes_at(&vector.to_rotation(convention), &vector.position())
            }
        })
    }

    fn check_turns(&self) -> Result<(), PosePathError> {
        for (pose, leg) in self.numbered_legs() {
            let angle = leg.turn();
            if angle >= PI * (1.0 - epsilons::<f64>(HALF_TURN_EPSILONS)) {
                return Err(PosePathError::HalfTurn { pose, angle });
            }
        }
        Ok(())
    }
}

fn check<S>(
    poses: &[S],
    check: impl Fn(usize, &S) -> Result<(), PosePathError>,
) -> Result<(), PosePathError> {
    if poses.len() < 2 {
        return Err(PosePathError::TooFew { poses: poses.len() });
    }
    let mut numbered = poses.iter().enumerate();
    numbered.try_for_each(|(number, pose)| check(number, pose))
}

fn check_position(pose: usize, position: &Vector3<f64>) -> Result<(), PosePathError> {
    let max = largest();
    first_beyond(position, max).map_or(Ok(()), |value| {
        Err(PosePathError::Coordinate { pose, value, max })
    })
}

fn check_angles(pose: usize, angles: &Vector3<f64>) -> Result<(), PosePathError> {
    let max = largest_angle();
    first_beyond(angles, max).map_or(Ok(()), |value| {
        Err(PosePathError::Angle { pose, value, max })
    })
}

fn check_rotation(pose: usize, rotation: &UnitQuaternion<f64>) -> Result<(), PosePathError> {
    let length = rotation.as_vector().norm();
    let [min, max] = ROTATION_LENGTH;
    if length >= min && length <= max {
        return Ok(());
    }
    Err(PosePathError::Rotation { pose, length })
}
