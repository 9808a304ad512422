//! Geometry and zeros from measured points: Levenberg-Marquardt on a stated set of parameters.

mod parameter;

use marquardt::{Jacobian, NotConverged, Problem};
use nalgebra::{Point3, Vector3};

use crate::inverse::Across;
use crate::range::{is_within, largest_coordinate};
use crate::rounded::Rounded;
use crate::{AssemblyMode, Delta, ForwardError, ZAxis};
pub use parameter::{Parameter, Quantity};

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

/// A calibrated Delta, how well it fits, and what the points do not determine.
pub type Calibration<const N: usize> = marquardt::Calibration<Delta, Parameter, N>;

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
    /// azimuths of points on the z axis: [`conditioning`](marquardt::LeastSquares::conditioning)
    /// and the size of the changes show it.
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
        let problem = Poses {
            start: *self,
            parameters,
            measured,
        };
        let span = self.span();
        let units = parameters.map(|parameter| parameter.unit(span));
        let (delta, fit) =
            marquardt::fit(&problem, span, units).map_err(|NotConverged { iterations, rms }| {
                CalibrationError::NotConverged { iterations, rms }
            })?;
        Ok(Calibration::new(delta, parameters, fit))
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

/// Measured points as a function of the parameters' changes.
struct Poses<'a, const N: usize> {
    start: Delta,
    parameters: [Parameter; N],
    measured: &'a [Measured],
}

impl<const N: usize> Problem<N> for Poses<'_, N> {
    type Model = Delta;

    fn model(&self, changes: [f64; N]) -> Option<Delta> {
        let mut arms = *self.start.arms();
        for (parameter, change) in self.parameters.iter().zip(changes) {
            parameter.add(&mut arms, change);
        }
        self.start.with_arms(arms).ok()
    }

    fn squares(&self, delta: &Delta) -> impl Iterator<Item = Option<f64>> {
        self.measured.iter().map(|measured| {
            let found = delta.forward(measured.angles).ok()?;
            Some((measured.point - found).norm_squared())
        })
    }

    fn add_rows(&self, delta: &Delta, jacobian: &mut Jacobian<N>) -> Option<()> {
        for measured in self.measured {
            let pose = delta.pose_of(measured.angles).ok()?;
            let inverse = pose.rod_inverse().ok()?;
            let missing = measured.point - pose.point();
            let columns = self
                .parameters
                .map(|parameter| parameter.influence(delta, &pose, &inverse));
            jacobian.add(columns.map(|column| column.x), missing.x);
            jacobian.add(columns.map(|column| column.y), missing.y);
            jacobian.add(columns.map(|column| column.z), missing.z);
        }
        Some(())
    }
}
