//! Geometry and zeros from measured points: Levenberg-Marquardt on a stated set of parameters.

mod least_squares;
mod parameter;
mod rank;

use nalgebra::{Point3, SVector, Vector3};

use crate::inverse::Across;
use crate::range::{is_within, largest_coordinate, sqrt};
use crate::rounded::Rounded;
use crate::{AssemblyMode, Delta, ForwardError, ZAxis};
use least_squares::LeastSquares;
pub use parameter::{Parameter, Quantity};
use rank::Rank;

/// A measured point: where the platform's centre was found with given angles.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_structs, reason = "a measurement is just this")]
pub struct Measured {
    /// The angles as they read, in radians.
    pub angles: Vector3<f64>,
    /// The platform's centre, in the machine's frame.
    pub point: Point3<f64>,
}

/// Why a calibration is refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CalibrationError {
    /// There are fewer measured coordinates than parameters.
    #[error("{points} measured points are too few for {parameters} parameters: {min} at least")]
    TooFew {
        /// Points given.
        points: usize,
        /// Parameters asked for.
        parameters: usize,
        /// Smallest number of points.
        min: usize,
    },
    /// A measured coordinate is infinite, not a number, or beyond ±4 h, h the fourth root of the
    /// largest number divided by 32 (f64: ±1.4e76, f32: ±5.4e8).
    #[error("measured point {index} is not finite, or too far away")]
    NotFinite {
        /// Index in the list, counted from 0.
        index: usize,
    },
    /// With its angles the platform is nearer to a measured point in the other assembly mode.
    #[error("measured point {index}: {}", Across { assembly_mode: *.assembly_mode, z: *.z })]
    OtherAssembly {
        /// Index in the list, counted from 0.
        index: usize,
        /// The assembly mode in which it is nearer.
        assembly_mode: AssemblyMode,
        /// The direction of z that was most likely meant, where the point lies on the other side
        /// of the base plane.
        z: Option<ZAxis>,
    },
    /// The machine that is to be calibrated cannot have the measured angles.
    #[error("measured point {index}: {reason}")]
    Impossible {
        /// Index in the list, counted from 0.
        index: usize,
        /// Why.
        reason: ForwardError,
    },
    /// The residuals still shrink after the largest number of iterations, or the rods of a
    /// measured pose lie in a plane, where no change of a parameter shows how the platform moves.
    #[error("not converged after {iterations} iterations, rms {}", Rounded(*.rms))]
    NotConverged {
        /// Iterations made.
        iterations: u32,
        /// Root mean square of the distances so far, in the unit of length.
        rms: f64,
    },
}

/// A calibrated machine, how well it fits, and what the points do not determine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration<const N: usize> {
    delta: Delta,
    parameters: [Parameter; N],
    changes: [f64; N],
    rms: f64,
    largest: f64,
    iterations: u32,
    rank: Rank<N>,
}

const MAX_ITERATIONS: u32 = 200;

impl Delta {
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
        measured: &[Measured],
    ) -> Result<Calibration<N>, CalibrationError> {
        let min = N.div_ceil(3);
        if measured.len() < min {
            return Err(CalibrationError::TooFew {
                points: measured.len(),
                parameters: N,
                min,
            });
        }
        for (index, measured) in measured.iter().enumerate() {
            self.check_measured(index, measured)?;
        }
        let problem = Problem {
            start: *self,
            parameters,
            measured,
        };
        let fit = least_squares::minimise(&problem, MAX_ITERATIONS);
        let (rms, largest) = problem.residuals(&fit.delta);
        if !fit.is_converged {
            return Err(CalibrationError::NotConverged {
                iterations: fit.iterations,
                rms,
            });
        }
        let rows = measured.len().saturating_mul(3);
        Ok(Calibration {
            delta: fit.delta,
            parameters,
            changes: problem.with_units(&fit.changes),
            rms,
            largest,
            iterations: fit.iterations,
            rank: Rank::new(&fit.system, fit.sum, rows, &problem.units()),
        })
    }

    /// Whether the machine can have the angles, and the point is where its assembly mode is.
    fn check_measured(&self, index: usize, measured: &Measured) -> Result<(), CalibrationError> {
        let point = measured.point;
        if !point
            .iter()
            .all(|value| is_within(*value, largest_coordinate()))
        {
            return Err(CalibrationError::NotFinite { index });
        }
        let distance = |delta: &Self| {
            let found = delta
                .forward(measured.angles)
                .map_err(|reason| CalibrationError::Impossible { index, reason })?;
            Ok((found - point).norm())
        };
        let assembly_mode = self.assembly_mode().other();
        if distance(self)? <= distance(&self.with_assembly_mode(assembly_mode))? {
            return Ok(());
        }
        let z = self.other_z(&self.flip(point.coords));
        Err(CalibrationError::OtherAssembly {
            index,
            assembly_mode,
            z,
        })
    }
}

impl<const N: usize> Calibration<N> {
    /// The calibrated machine.
    #[must_use]
    pub const fn delta(&self) -> Delta {
        self.delta
    }

    /// The parameters, in the order of all arrays here.
    #[must_use]
    pub const fn parameters(&self) -> &[Parameter; N] {
        &self.parameters
    }

    /// What was added to each parameter, in the unit of length or in radians.
    #[must_use]
    pub const fn changes(&self) -> &[f64; N] {
        &self.changes
    }

    /// The standard deviation of each parameter, in the unit of length or in radians, from the
    /// residuals; `None` for those that the points do not determine.
    #[must_use]
    pub fn deviations(&self) -> [Option<f64>; N] {
        self.rank.deviations()
    }

    /// Root mean square of the distances that are left, in the unit of length.
    #[must_use]
    pub const fn rms(&self) -> f64 {
        self.rms
    }

    /// The largest distance that is left, in the unit of length.
    #[must_use]
    pub const fn largest(&self) -> f64 {
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

    /// Smallest over largest singular value of the scaled Jacobian: how well the worst
    /// combination is determined. Zero within rounding where the rank is less than N.
    #[must_use]
    pub fn conditioning(&self) -> f64 {
        self.rank.conditioning()
    }

    /// The parameters that the points do not determine, alone or together with others.
    pub fn undetermined(&self) -> impl Iterator<Item = Parameter> + use<N> {
        let free = self.rank.free();
        self.parameters
            .into_iter()
            .zip(free)
            .filter_map(|(parameter, free)| free.then_some(parameter))
    }

    /// Changes of the parameters that, to first order, move none of the measured points: a basis
    /// of the null space, in the unit of length and in radians.
    pub fn null_space(&self) -> impl Iterator<Item = [f64; N]> + use<N> {
        self.rank.null_space()
    }
}

/// The residuals of measured points as a function of the parameters' changes. Lengths are in spans
/// of the machine, so that they compare with radians.
struct Problem<'a, const N: usize> {
    start: Delta,
    parameters: [Parameter; N],
    measured: &'a [Measured],
}

impl<const N: usize> Problem<'_, N> {
    /// What a change of 1 is, in the unit of length or in radians.
    fn units(&self) -> [f64; N] {
        self.parameters
            .map(|parameter| parameter.unit(self.start.span()))
    }

    fn with_units(&self, changes: &[f64; N]) -> [f64; N] {
        let units = SVector::from(self.units());
        SVector::from(*changes).component_mul(&units).into()
    }

    fn machine(&self, changes: &[f64; N]) -> Option<Delta> {
        let mut arms = *self.start.arms();
        for (parameter, change) in self.parameters.iter().zip(self.with_units(changes)) {
            parameter.add(&mut arms, change);
        }
        self.start.with_arms(arms).ok()
    }

    /// How far the platform is from a measured point; `None` where the machine cannot have the
    /// angles.
    fn missing(&self, delta: &Delta, measured: &Measured) -> Option<Vector3<f64>> {
        let found = delta.forward(measured.angles).ok()?;
        Some((measured.point - found) / self.start.span())
    }

    /// Sum of the squares.
    fn sum(&self, delta: &Delta) -> Option<f64> {
        let squares = self.measured.iter();
        squares
            .map(|measured| Some(self.missing(delta, measured)?.norm_squared()))
            .sum()
    }

    /// What the sum is where each point is met to a machine epsilon of the span.
    fn rounding(&self) -> f64 {
        let squares = self.measured.iter().map(|_| f64::EPSILON * f64::EPSILON);
        squares.sum()
    }

    /// The triangularised Jacobian with the residuals, and the sum of their squares.
    fn system(&self, delta: &Delta) -> Option<(LeastSquares<N>, f64)> {
        let span = self.start.span();
        let (mut system, mut sum) = (LeastSquares::new(), 0.0);
        for measured in self.measured {
            let pose = delta.pose_of(measured.angles).ok()?;
            let inverse = pose.rod_inverse().ok()?;
            let missing = (measured.point - pose.point()) / span;
            sum += missing.norm_squared();
            let columns = self.parameters.map(|parameter| {
                parameter.influence(delta, &pose, &inverse) * (parameter.unit(span) / span)
            });
            system.add(columns.map(|column| column.x), missing.x);
            system.add(columns.map(|column| column.y), missing.y);
            system.add(columns.map(|column| column.z), missing.z);
        }
        Some((system, sum))
    }

    /// Root mean square and largest distance, in the unit of length, of a machine that can have all
    /// measured angles.
    fn residuals(&self, delta: &Delta) -> (f64, f64) {
        let distances = self
            .measured
            .iter()
            .filter_map(|measured| self.missing(delta, measured))
            .map(|missing| missing.norm());
        let (sum, count, largest) = distances.fold((0.0, 0.0_f64, 0.0_f64), |total, distance| {
            let (sum, count, largest) = total;
            (
                sum + distance * distance,
                count + 1.0,
                largest.max(distance),
            )
        });
        let span = self.start.span();
        // No point at all is no residual.
        let rms = sqrt(sum / count.max(1.0));
        (rms * span, largest * span)
    }
}
