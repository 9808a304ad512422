//! Geometry, zeros and ratios from measured points: Levenberg-Marquardt on a stated set of
//! parameters.

mod parameter;

use core::fmt::{Display, Formatter};

use marquardt::{Jacobian, NotConverged, Problem};
use nalgebra::Point2;

use crate::digits::Digits;
use crate::range::{is_angle, largest_ratio};
use crate::{Arm, DriveAngles, Drives};
pub use parameter::Parameter;

/// An arm with its drives: from what the drives read to where the tool is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_structs, reason = "an arm has drives and no more")]
pub struct DrivenArm {
    /// The arm.
    pub arm: Arm,
    /// How its drives sit on the joints.
    pub drives: Drives,
}

/// A measured point: where the tool was found with given angles of the drives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_structs, reason = "a measurement is just this")]
pub struct Measured {
    /// The drives' angles as they read, in radians.
    pub drives: DriveAngles,
    /// The tool, in the frame in which the arm's base is given.
    pub point: Point2<f64>,
}

/// A calibrated arm, how well it fits, and what the points do not tell.
pub type Calibration<const N: usize> = marquardt::Calibration<DrivenArm, Parameter, N>;

/// Why a calibration is refused.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CalibrationError {
    /// There are fewer measured coordinates than parameters.
    TooFew {
        /// Points given.
        points: usize,
        /// Parameters asked for.
        parameters: usize,
        /// Smallest number of points.
        min: usize,
    },
    /// A measured angle or coordinate is infinite, not a number, an angle beyond ±6.7e7 rad, or a
    /// coordinate beyond ±7e13 shorter links.
    NotFinite {
        /// Index in the list, counted from 0.
        index: usize,
    },
    /// The residuals still shrink after the largest number of iterations.
    NotConverged {
        /// Iterations made.
        iterations: u32,
        /// Root mean square of the distances so far, in the unit of length.
        rms: f64,
    },
}

impl Display for CalibrationError {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match *self {
            Self::TooFew {
                points,
                parameters,
                min,
            } => write!(
                f,
                "{points} measured points are too few for {parameters} parameters: {min} at least"
            ),
            Self::NotFinite { index } => {
                write!(f, "measured point {index} is not finite, or too far away")
            }
            Self::NotConverged { iterations, rms } => write!(
                f,
                "not converged after {iterations} iterations, rms {}",
                Digits(rms)
            ),
        }
    }
}

impl core::error::Error for CalibrationError {}

impl DrivenArm {
    /// Position of the tool where the drives read `drives`.
    #[must_use]
    pub fn forward(&self, drives: DriveAngles) -> Point2<f64> {
        self.arm.forward(self.drives.to_joints(drives))
    }

    /// The arm whose `parameters` fit measured points best, all others kept.
    ///
    /// ```text
    /// Σ |forward(drives; parameters) - point|² → min
    /// ```
    ///
    /// by Levenberg-Marquardt with an analytic Jacobian, from this arm's values, in three N × N
    /// matrices for any number of points. Points taken with both elbows tell the most. Parameters
    /// that the points do not determine stay near their values and are reported: the shoulder's
    /// zero and the base's angle, for one, are the same thing. Noise can make a parameter look
    /// determined that the points hardly see:
    /// [`conditioning`](marquardt::LeastSquares::conditioning) and the size of the changes show it.
    /// Joint limits are not looked at.
    ///
    /// # Errors
    /// [`CalibrationError`].
    pub fn calibrate<const N: usize>(
        &self,
        parameters: [Parameter; N],
        measured: &[Measured],
    ) -> Result<Calibration<N>, CalibrationError> {
        let points = measured.len();
        let min = N.div_ceil(2);
        if points < min {
            return Err(CalibrationError::TooFew {
                points,
                parameters: N,
                min,
            });
        }
        let farthest = self.arm.upper().min(self.arm.fore()) * largest_ratio::<f64>();
        let is_point = |measured: &Measured| {
            let coordinates = measured.point.iter();
            is_angle(measured.drives.shoulder)
                && is_angle(measured.drives.elbow)
                && coordinates.into_iter().all(|value| value.abs() <= farthest)
        };
        if let Some(index) = measured.iter().position(|measured| !is_point(measured)) {
            return Err(CalibrationError::NotFinite { index });
        }
        let problem = Points {
            start: *self,
            parameters,
            measured,
        };
        let span = self.arm.reach();
        let units = parameters.map(|parameter| parameter.unit(span));
        let (machine, fit) =
            marquardt::fit(&problem, span, units).map_err(|NotConverged { iterations, rms }| {
                CalibrationError::NotConverged { iterations, rms }
            })?;
        Ok(Calibration::new(machine, parameters, fit))
    }
}

/// Measured points as a function of the parameters' changes.
struct Points<'a, const N: usize> {
    start: DrivenArm,
    parameters: [Parameter; N],
    measured: &'a [Measured],
}

impl<const N: usize> Problem<N> for Points<'_, N> {
    type Model = DrivenArm;

    fn model(&self, changes: [f64; N]) -> Option<DrivenArm> {
        Parameter::changed(&self.start, self.parameters.into_iter().zip(changes)).ok()
    }

    fn squares(&self, machine: &DrivenArm) -> impl Iterator<Item = Option<f64>> {
        self.measured.iter().map(|measured| {
            let found = machine.forward(measured.drives);
            Some((measured.point - found).norm_squared())
        })
    }

    fn add_rows(&self, machine: &DrivenArm, jacobian: &mut Jacobian<N>) -> Option<()> {
        for measured in self.measured {
            let missing = measured.point - machine.forward(measured.drives);
            let columns = self
                .parameters
                .map(|parameter| parameter.influence(machine, measured.drives));
            jacobian.add(columns.map(|column| column.x), missing.x);
            jacobian.add(columns.map(|column| column.y), missing.y);
        }
        Some(())
    }
}
