//! The geometry and the homes of a machine from measured points.

use core::fmt::{self, Write as _};
use core::str::FromStr;

use anyhow::{Context, Error, Result, bail, ensure};
use commissioning::{Fitted, Unit, read_columns};
use delta_kin::{Arm, CalibrationError, Measured, Parameter, Quantity};
use nalgebra::{Point3, Vector3};

use crate::command;
use crate::machine::{Deviation, Machine};

/// Which numbers of each arm a calibration may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Fit {
    /// Where the arms are at home.
    #[default]
    Homes,
    /// Homes, and the lengths of the lower arms.
    Lower,
    /// Homes, lower and upper arms, radii of the base, azimuths.
    All,
}

impl FromStr for Fit {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Ok(match name {
            "homes" => Self::Homes,
            "lower" => Self::Lower,
            "all" => Self::All,
            _ => bail!("calibrations fit homes, lower or all"),
        })
    }
}

/// What a calibration has found; displayed, a summary in lines.
#[derive(Debug, Clone)]
pub struct Calibrated {
    fitted: Fitted,
    deviations: [Deviation; 3],
}

/// The lines of measured points, and the points.
type Points = (Vec<u64>, Vec<Measured>);

impl Machine {
    /// The machine that fits measured points best: a line for each, `a b c x y z`, the motors'
    /// steps from home and where the platform's centre was found in mm, or a CSV file with the
    /// columns `a`, `b`, `c`, `x_mm`, `y_mm`, `z_mm`; `#` begins a comment.
    ///
    /// # Errors
    /// A line that cannot be read, or a point where the machine cannot be, with the line's number;
    /// too few points; points that no such machine fits.
    pub fn calibrate(&self, measured: &str, fit: Fit) -> Result<Calibrated> {
        use Quantity::{Azimuth, Base, Lower, Upper, Zero};
        let points = self.measured(measured)?;
        match fit {
            Fit::Homes => self.fit(Arm::ALL.map(|arm| Parameter::of(Zero, arm)), &points),
            Fit::Lower => self.fit::<6>(parameters([Zero, Lower])?, &points),
            Fit::All => {
                let all = parameters([Zero, Lower, Upper, Base, Azimuth])?;
                self.fit::<15>(all, &points)
            }
        }
    }

    fn measured(&self, text: &str) -> Result<Points> {
        let lines = (1..).zip(text.lines());
        let lines = lines.map(|(number, line)| (number, command::without_comment(line)));
        let first = lines.clone().find(|(_, words)| !words.is_empty());
        let is_csv = first.is_some_and(|(_, words)| words.contains([',', ';', '\t']));
        let rows = if is_csv {
            read_columns(text, ["a", "b", "c", "x_mm", "y_mm", "z_mm"])?
        } else {
            let rows = lines.filter(|(_, words)| !words.is_empty());
            let rows = rows.map(|(number, words)| {
                let numbers = six(words).with_context(|| format!("line {number}"))?;
                Ok((number, numbers))
            });
            rows.collect::<Result<_>>()?
        };
        let mut found = Points::default();
        for (number, numbers) in rows {
            let point = self.measured_point(numbers);
            found
                .1
                .push(point.with_context(|| format!("line {number}"))?);
            found.0.push(number);
        }
        Ok(found)
    }

    fn measured_point(&self, [a, b, c, x, y, z]: [f64; 6]) -> Result<Measured> {
        for steps in [a, b, c] {
            let is_count = steps.fract() == 0.0 && steps.abs() <= f64::from(i32::MAX);
            ensure!(is_count, "{steps} is no count of steps");
        }
        Ok(Measured {
            angles: Vector3::new(a, b, c) * self.rad_per_step,
            point: Point3::new(x, y, z),
        })
    }

    fn fit<const N: usize>(
        &self,
        parameters: [Parameter; N],
        (lines, points): &Points,
    ) -> Result<Calibrated> {
        let found = self.delta.calibrate(parameters, points);
        let found = found.map_err(|error| match error {
            CalibrationError::NotFinite { index }
            | CalibrationError::OtherAssembly { index, .. }
            | CalibrationError::Impossible { index, .. } => {
                let error = Error::new(error);
                match lines.get(index) {
                    Some(line) => error.context(format!("line {line}")),
                    None => error,
                }
            }
            other => other.into(),
        })?;
        let mut deviations = self.deviations;
        for (parameter, change) in parameters.into_iter().zip(found.changes()) {
            for (arm, deviation) in Arm::ALL.into_iter().zip(&mut deviations) {
                if parameter.arm == Some(arm) {
                    *of(deviation, parameter.quantity) += change * unit(parameter).scale();
                }
            }
        }
        Ok(Calibrated {
            fitted: Fitted::new(&found, points.len(), unit),
            deviations,
        })
    }
}

/// The numbers of a line.
fn six(words: &str) -> Result<[f64; 6]> {
    let numbers = command::numbers(words)?;
    let count = numbers.len();
    numbers
        .try_into()
        .ok()
        .with_context(|| format!("{count} numbers in {words:?}, `a b c x y z` is needed"))
}

/// Quantities of each arm.
fn parameters<const Q: usize, const N: usize>(quantities: [Quantity; Q]) -> Result<[Parameter; N]> {
    let each = quantities.into_iter();
    let all = each.flat_map(|quantity| Arm::ALL.map(|arm| Parameter::of(quantity, arm)));
    let all: Vec<_> = all.collect();
    <[Parameter; N]>::try_from(all)
        .ok()
        .context("three parameters for each quantity")
}

const fn unit(parameter: Parameter) -> Unit {
    match parameter.quantity {
        Quantity::Azimuth | Quantity::Zero => Unit::Deg,
        Quantity::Base | Quantity::Platform | Quantity::Upper | Quantity::Lower => Unit::Mm,
    }
}

/// The number of a machine file for a quantity.
const fn of(deviation: &mut Deviation, quantity: Quantity) -> &mut f64 {
    match quantity {
        Quantity::Azimuth => &mut deviation.azimuth_deg,
        Quantity::Base => &mut deviation.base_mm,
        Quantity::Platform => &mut deviation.platform_mm,
        Quantity::Upper => &mut deviation.upper_mm,
        Quantity::Lower => &mut deviation.lower_mm,
        Quantity::Zero => &mut deviation.home_deg,
    }
}

impl Calibrated {
    /// A machine file with what was found in place of its tables `[[arm]]`.
    ///
    /// # Errors
    /// Its arms are written in another form, or no machine is like this.
    pub fn machine_file(&self, text: &str) -> Result<String> {
        let mut is_arm = false;
        let mut file = String::new();
        for line in text.lines() {
            let header: String = line.split_whitespace().collect();
            if header.starts_with('[') {
                is_arm = header.starts_with("[[arm]]");
            }
            if !is_arm {
                file.push_str(line);
                file.push('\n');
            }
        }
        for it in &self.deviations {
            // A string takes everything.
            let _ = write!(
                file,
                "\n[[arm]]\nazimuth_deg = {:.6}\nbase_mm = {:.6}\nplatform_mm = {:.6}\n\
                 upper_mm = {:.6}\nlower_mm = {:.6}\nhome_deg = {:.6}\n",
                it.azimuth_deg, it.base_mm, it.platform_mm, it.upper_mm, it.lower_mm, it.home_deg
            );
        }
        Machine::parse(&file).context("with a table [[arm]] for each of the three arms")?;
        Ok(file)
    }
}

impl fmt::Display for Calibrated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.fitted.fmt(f)
    }
}
