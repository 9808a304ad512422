//! Geometry and zeros from measured points: Levenberg-Marquardt on a stated set of parameters.

mod least_squares;
mod parameter;
mod rank;

use nalgebra::{Point3, RealField, Vector3};

use crate::limits::max_value;
use crate::{Delta, ForwardError};
use least_squares::LeastSquares;
pub use parameter::{Parameter, Quantity};
use rank::Rank;

/// A measured point: where the platform's centre was found with given angles.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: RealField + serde::Serialize",
        deserialize = "T: RealField + serde::Deserialize<'de>"
    ))
)]
#[expect(clippy::exhaustive_structs, reason = "a measurement is just this")]
pub struct Measured<T: RealField = f64> {
    /// The angles as they read, in radians.
    pub angles: Vector3<T>,
    /// The platform's centre, in the machine's frame.
    pub point: Point3<T>,
}

/// Why a calibration is refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CalibrationError<T = f64> {
    /// There are fewer measured coordinates than parameters.
    #[error("{points} measured points are too few for {parameters} parameters: {least} at least")]
    TooFew {
        /// Points given.
        points: usize,
        /// Parameters asked for.
        parameters: usize,
        /// Least number of points.
        least: usize,
    },
    /// A measured coordinate is infinite, not a number, or too far away for squares to be summed.
    #[error("measured point {index} is not finite, or too far away")]
    NotFinite {
        /// Place in the list, counted from 0.
        index: usize,
    },
    /// The machine that is to be calibrated cannot have the measured angles.
    #[error("measured point {index}: {reason}")]
    Impossible {
        /// Place in the list, counted from 0.
        index: usize,
        /// Why.
        reason: ForwardError<T>,
    },
    /// The residuals still shrink after the most iterations that are made, or the rods of a
    /// measured pose lie in a plane, where no change of a parameter tells how the platform moves.
    #[error("not converged after {iterations} iterations, rms {rms}")]
    NotConverged {
        /// Iterations made.
        iterations: u32,
        /// Root mean square of the distances so far, in the unit of length.
        rms: T,
    },
}

/// A calibrated machine, how well it fits, and what the points do not tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration<const N: usize, T: RealField = f64> {
    delta: Delta<T>,
    parameters: [Parameter; N],
    changes: [T; N],
    rms: T,
    largest: T,
    iterations: u32,
    rank: Rank<N, T>,
}

const MOST_ITERATIONS: u32 = 200;

impl<T: RealField + Copy> Delta<T> {
    /// The machine whose `parameters` fit measured points best, all others kept.
    ///
    /// ```text
    /// Σ |forward(angles; parameters) - point|² → min
    /// ```
    ///
    /// by Levenberg-Marquardt with Marquardt's scaling and an analytic Jacobian, from this
    /// machine's values. The Jacobian is triangularised point by point with Givens rotations, so
    /// that digits are not lost to its square and memory (three N × N matrices) does not grow with
    /// the points. Parameters that the points do not determine stay near their values and are
    /// reported. Noise can make a parameter look determined that the points hardly see, as the
    /// azimuths of points on the z axis: [`Calibration::conditioning`] and the size of the changes
    /// show it.
    ///
    /// # Errors
    /// [`CalibrationError`].
    pub fn calibrate<const N: usize>(
        &self,
        parameters: [Parameter; N],
        measured: &[Measured<T>],
    ) -> Result<Calibration<N, T>, CalibrationError<T>> {
        let least = N.div_ceil(3);
        if measured.len() < least {
            return Err(CalibrationError::TooFew {
                points: measured.len(),
                parameters: N,
                least,
            });
        }
        let mut sum = T::zero();
        for (index, m) in measured.iter().enumerate() {
            let found = self
                .forward(m.angles)
                .map_err(|reason| CalibrationError::Impossible { index, reason })?;
            sum += (found - m.point).norm_squared();
            // Deviations multiply the sum further.
            if !sum.is_finite() || sum > max_value::<T>().sqrt() {
                return Err(CalibrationError::NotFinite { index });
            }
        }
        let problem = Problem {
            start: *self,
            parameters,
            measured,
        };
        let fit = least_squares::minimise(&problem, MOST_ITERATIONS);
        let delta = fit.delta;
        let (rms, largest) = problem.residuals(&delta);
        if !fit.is_converged {
            return Err(CalibrationError::NotConverged {
                iterations: fit.iterations,
                rms,
            });
        }
        Ok(Calibration {
            delta,
            parameters,
            changes: fit.changes,
            rms,
            largest,
            iterations: fit.iterations,
            rank: Rank::new(&fit.system, fit.sum, measured.len().saturating_mul(3)),
        })
    }
}

impl<const N: usize, T: RealField + Copy> Calibration<N, T> {
    /// The calibrated machine.
    #[must_use]
    pub const fn delta(&self) -> Delta<T> {
        self.delta
    }

    /// The parameters, in the order of all arrays here.
    #[must_use]
    pub const fn parameters(&self) -> &[Parameter; N] {
        &self.parameters
    }

    /// What was added to each parameter, in the unit of length or in radians.
    #[must_use]
    pub const fn changes(&self) -> &[T; N] {
        &self.changes
    }

    /// The standard deviation of each parameter, in the unit of length or in radians, from the
    /// residuals; `None` for those that the points do not determine.
    #[must_use]
    pub fn deviations(&self) -> [Option<T>; N] {
        self.rank.deviations()
    }

    /// Root mean square of the distances that are left, in the unit of length.
    #[must_use]
    pub const fn rms(&self) -> T {
        self.rms
    }

    /// The largest distance that is left, in the unit of length.
    #[must_use]
    pub const fn largest(&self) -> T {
        self.largest
    }

    /// Iterations made.
    #[must_use]
    pub const fn iterations(&self) -> u32 {
        self.iterations
    }

    /// How many independent combinations of the parameters the points determine; N is all.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.rank.rank()
    }

    /// Least over greatest singular value of the scaled Jacobian: how well the worst
    /// combination is determined. Zero within rounding where the rank is less than N.
    #[must_use]
    pub fn conditioning(&self) -> T {
        self.rank.conditioning()
    }

    /// The parameters that the points do not determine, alone or together with others.
    pub fn undetermined(&self) -> impl Iterator<Item = Parameter> + use<N, T> {
        let free = self.rank.free();
        self.parameters
            .into_iter()
            .zip(free)
            .filter_map(|(parameter, free)| free.then_some(parameter))
    }

    /// Changes of the parameters that, to first order, move none of the measured points: a basis
    /// of the null space, in the unit of length and in radians.
    pub fn null_space(&self) -> impl Iterator<Item = [T; N]> + use<N, T> {
        self.rank.null_space()
    }
}

/// The residuals of measured points as a function of the parameters' changes.
struct Problem<'a, const N: usize, T: RealField> {
    start: Delta<T>,
    parameters: [Parameter; N],
    measured: &'a [Measured<T>],
}

impl<const N: usize, T: RealField + Copy> Problem<'_, N, T> {
    fn machine(&self, changes: &[T; N]) -> Option<Delta<T>> {
        let mut arms = *self.start.arms();
        for (parameter, change) in self.parameters.iter().zip(changes) {
            parameter.add(&mut arms, *change);
        }
        self.start.with_arms(arms).ok()
    }

    /// Sum of the squares; `None` where the machine cannot have the angles.
    fn sum(&self, delta: &Delta<T>) -> Option<T> {
        self.measured.iter().try_fold(T::zero(), |sum, measured| {
            let found = delta.forward(measured.angles).ok()?;
            Some(sum + (found - measured.point).norm_squared())
        })
    }

    /// The triangularised Jacobian with the residuals.
    fn system(&self, delta: &Delta<T>) -> Option<LeastSquares<N, T>> {
        let mut system = LeastSquares::new();
        for measured in self.measured {
            let pose = delta.pose_of(measured.angles).ok()?;
            let inverse = pose.rod_inverse().ok()?;
            let missing = measured.point - pose.point();
            let columns = self
                .parameters
                .map(|parameter| parameter.influence(delta, &pose, &inverse));
            for (axis, missing) in missing.iter().enumerate() {
                let row = columns.map(|column| column.get(axis).copied().unwrap_or(T::zero()));
                system.add(row, *missing);
            }
        }
        Some(system)
    }

    /// Root mean square and greatest distance.
    fn residuals(&self, delta: &Delta<T>) -> (T, T) {
        let (mut sum, mut largest, mut count) = (T::zero(), T::zero(), T::zero());
        for measured in self.measured {
            if let Ok(found) = delta.forward(measured.angles) {
                let off = (found - measured.point).norm();
                sum += off * off;
                largest = largest.max(off);
                count += T::one();
            }
        }
        ((sum / count.max(T::one())).sqrt(), largest)
    }
}
