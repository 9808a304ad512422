//! The geometry and the homes of a machine from measured points.

use core::fmt;
use core::str::FromStr;

use anyhow::{Context, Error, Result, bail, ensure};
use commissioning::{Fitted, Unit, read_columns};
use nalgebra::Point2;
use scara_kin::{CalibrationError, DriveAngles, DrivenArm, Drives, Joints, Measured, Parameter};
use toml_edit::{DocumentMut, Item, Value};

use crate::machine::Machine;

/// Which numbers a calibration may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Fit {
    /// Where both joints are at home.
    #[default]
    Homes,
    /// Homes, and the lengths of both links.
    Links,
    /// Homes, links, the elbow's gear, and where the arm's axis is.
    All,
}

impl FromStr for Fit {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Ok(match name {
            "homes" => Self::Homes,
            "links" => Self::Links,
            "all" => Self::All,
            _ => bail!("calibrations fit homes, links or all"),
        })
    }
}

/// What a calibration has found; displayed, a summary in lines.
#[derive(Debug, Clone)]
pub struct Calibrated {
    fitted: Fitted,
    /// Table, key and value of each number in a machine file.
    numbers: Vec<(&'static str, &'static str, f64)>,
}

impl Machine {
    /// The machine that fits measured points best: a CSV file with the columns `shoulder`, `elbow`,
    /// pulses from home, and `x_mm`, `y_mm`, where the tool was found.
    ///
    /// # Errors
    /// A cell that cannot be read, with its line; too few points; points that no such machine fits.
    pub fn calibrate(&self, measured: &str, fit: Fit) -> Result<Calibrated> {
        use Parameter::{BaseX, BaseY, ElbowRatio, ElbowZero, Fore, ShoulderZero, Upper};
        let rows = read_columns(measured, ["shoulder", "elbow", "x_mm", "y_mm"])?;
        let points = rows.iter().map(|(line, numbers)| {
            self.measured_point(*numbers)
                .with_context(|| format!("line {line}"))
        });
        let points: Vec<_> = points.collect::<Result<_>>()?;
        let home = Joints::new(self.shoulder.home_rad, self.elbow.home_rad);
        let start = DrivenArm {
            arm: self.arm,
            drives: Drives::default().with_zero(home)?,
        };
        let found = match fit {
            Fit::Homes => self.fit(start, [ShoulderZero, ElbowZero], &points),
            Fit::Links => self.fit(start, [ShoulderZero, ElbowZero, Upper, Fore], &points),
            Fit::All => {
                let all = [
                    ShoulderZero,
                    ElbowZero,
                    Upper,
                    Fore,
                    ElbowRatio,
                    BaseX,
                    BaseY,
                ];
                self.fit(start, all, &points)
            }
        };
        found.map_err(|error| {
            let line = match error {
                CalibrationError::NotFinite { index } => rows.get(index),
                _ => None,
            };
            match line {
                Some((line, _)) => Error::new(error).context(format!("line {line}")),
                None => error.into(),
            }
        })
    }

    fn measured_point(&self, [shoulder, elbow, x, y]: [f64; 4]) -> Result<Measured> {
        for pulses in [shoulder, elbow] {
            let is_count = pulses.fract() == 0.0 && pulses.abs() <= f64::from(i32::MAX);
            ensure!(is_count, "{pulses} is no count of pulses");
        }
        Ok(Measured {
            drives: DriveAngles {
                shoulder: shoulder * self.shoulder.rad_per_pulse,
                elbow: elbow * self.elbow.rad_per_pulse,
            },
            point: Point2::new(x, y),
        })
    }

    fn fit<const N: usize>(
        &self,
        start: DrivenArm,
        parameters: [Parameter; N],
        points: &[Measured],
    ) -> Result<Calibrated, CalibrationError> {
        let found = start.calibrate(parameters, points)?;
        let DrivenArm { arm, drives } = found.machine();
        let base = arm.base().translation;
        let numbers = vec![
            ("arm", "upper_mm", arm.upper()),
            ("arm", "fore_mm", arm.fore()),
            ("arm", "base_x_mm", base.x),
            ("arm", "base_y_mm", base.y),
            ("shoulder", "home_deg", drives.zero().shoulder.to_degrees()),
            ("elbow", "home_deg", drives.zero().elbow.to_degrees()),
            (
                "elbow",
                "gear_ratio",
                self.elbow.gear_ratio / drives.ratios()[1],
            ),
        ];
        Ok(Calibrated {
            fitted: Fitted::new(&found, points.len(), unit),
            numbers,
        })
    }
}

const fn unit(parameter: Parameter) -> Unit {
    match parameter {
        Parameter::Upper | Parameter::Fore | Parameter::BaseX | Parameter::BaseY => Unit::Mm,
        Parameter::ShoulderZero | Parameter::ElbowZero | Parameter::BaseAngle => Unit::Deg,
        Parameter::ShoulderRatio | Parameter::ElbowRatio | Parameter::Coupling => Unit::One,
    }
}

impl Calibrated {
    /// A machine file with what was found in it, all else and its comments kept.
    ///
    /// # Errors
    /// It is no TOML, or no machine is like this.
    pub fn machine_file(&self, text: &str) -> Result<String> {
        /// Of mm and degrees: a hundredth of what is ever measured.
        const DIGITS: f64 = 1e6;
        let mut file: DocumentMut = text.parse()?;
        for (name, key, found) in &self.numbers {
            let mut number = Value::from((found * DIGITS).round() / DIGITS);
            let table = file.get_mut(name).and_then(Item::as_table_like_mut);
            let item = table
                .with_context(|| format!("no table [{name}]"))?
                .entry(key)
                .or_insert(Item::None);
            if let Some(before) = item.as_value() {
                *number.decor_mut() = before.decor().clone();
            }
            *item = number.into();
        }
        let file = file.to_string();
        Machine::parse(&file).context("with what was found")?;
        Ok(file)
    }
}

impl fmt::Display for Calibrated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.fitted.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEASURED: &str = include_str!("../inputs/measured.csv");

    /// What the points were made with is in their file's head.
    #[test]
    fn what_the_points_were_made_with_is_found() {
        let machine = Machine::parse(crate::MACHINE).unwrap();
        let found = machine.calibrate(MEASURED, Fit::All).unwrap();
        for ((table, key, found), (wanted, tolerance)) in found.numbers.iter().zip([
            (132.35, 0.05),
            (131.7, 0.05),
            (0.6, 0.05),
            (-0.5, 0.05),
            (20.4, 0.02),
            (109.4, 0.03),
            (13.052, 0.005),
        ]) {
            assert!((found - wanted).abs() < tolerance, "{table}.{key}: {found}");
        }
        let file = found.machine_file(crate::MACHINE).unwrap();
        // Comments are where they were.
        assert!(
            file.contains("keep_out_mm = 40.0        # nothing is engraved"),
            "{file}"
        );
        let again = Machine::parse(&file).unwrap();
        let again = again.calibrate(MEASURED, Fit::All).unwrap();
        for (first, second) in found.numbers.iter().zip(&again.numbers) {
            assert!((first.2 - second.2).abs() < 1e-5, "{first:?} {second:?}");
        }
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let head = "shoulder,elbow,x_mm,y_mm\n";
        for (rows, wanted) in [
            ("0,0,1,2\n1,0.5,1,2\n", "line 3: 0.5 is no count of pulses"),
            ("0,0,1\n", "CSV error: record 1"),
            (
                "0,0,1,1e200\n0,0,1,2\n",
                "line 2: measured point 0 is not finite",
            ),
            (
                "",
                "0 measured points are too few for 4 parameters: 2 at least",
            ),
        ] {
            let machine = Machine::parse(crate::MACHINE).unwrap();
            let error = machine.calibrate(&format!("{head}{rows}"), Fit::Links);
            let said = format!("{:#}", error.unwrap_err());
            assert!(said.starts_with(wanted), "{said}");
        }
    }
}
