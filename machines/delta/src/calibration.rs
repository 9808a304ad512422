//! The geometry and the homes of a machine from measured points.

use core::fmt::{self, Write as _};
use core::str::FromStr;

use anyhow::{Context, Error, Result, bail, ensure};
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
    points: usize,
    rms_mm: f64,
    largest_mm: f64,
    changes: Vec<Change>,
    deviations: [Deviation; 3],
}

#[derive(Debug, Clone)]
struct Change {
    parameter: Parameter,
    /// In mm or degrees, as its standard deviation, which is none where the points do not tell.
    change: f64,
    deviation: Option<f64>,
    unit: &'static str,
}

/// The lines of measured points, and the points.
type Points = (Vec<usize>, Vec<Measured>);

impl Machine {
    /// The machine that fits measured points best: a line for each, `a b c x y z`, the motors' steps
    /// from home and where the platform's centre was found in mm; `#` begins a comment.
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
        let mut found = Points::default();
        for (number, line) in (1..).zip(text.lines()) {
            let words = command::without_comment(line);
            if words.is_empty() {
                continue;
            }
            let point = self.measured_point(words);
            found
                .1
                .push(point.with_context(|| format!("line {number}"))?);
            found.0.push(number);
        }
        Ok(found)
    }

    fn measured_point(&self, words: &str) -> Result<Measured> {
        let numbers = command::numbers(words)?;
        let count = numbers.len();
        let Ok([a, b, c, x, y, z]) = <[f64; 6]>::try_from(numbers) else {
            bail!("{count} numbers in {words:?}, `a b c x y z` is needed");
        };
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
        let all = parameters.into_iter().zip(*found.changes());
        let changes = all.zip(found.deviations());
        let changes = changes
            .map(|((parameter, change), deviation)| Change::new(parameter, change, deviation));
        let changes: Vec<_> = changes.collect();
        let mut deviations = self.deviations;
        for change in &changes {
            for (arm, deviation) in Arm::ALL.into_iter().zip(&mut deviations) {
                if change.parameter.arm == Some(arm) {
                    *of(deviation, change.parameter.quantity) += change.change;
                }
            }
        }
        Ok(Calibrated {
            points: points.len(),
            rms_mm: found.rms(),
            largest_mm: found.largest(),
            changes,
            deviations,
        })
    }
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

impl Change {
    fn new(parameter: Parameter, change: f64, deviation: Option<f64>) -> Self {
        let (unit, scale) = match parameter.quantity {
            Quantity::Azimuth | Quantity::Zero => ("deg", 1_f64.to_degrees()),
            _ => ("mm", 1.0),
        };
        Self {
            parameter,
            change: change * scale,
            deviation: deviation.map(|it| it * scale),
            unit,
        }
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
        writeln!(
            f,
            "{} points: {:.4} mm rms are left, {:.4} mm at most",
            self.points, self.rms_mm, self.largest_mm
        )?;
        for Change {
            parameter,
            change,
            deviation,
            unit,
        } in &self.changes
        {
            write!(f, "{parameter}: {change:+.4} {unit}")?;
            match deviation {
                Some(deviation) => writeln!(f, " ± {deviation:.4} {unit}")?,
                None => writeln!(f, ", which the points do not determine")?,
            }
        }
        Ok(())
    }
}
