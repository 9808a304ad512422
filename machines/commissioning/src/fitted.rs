//! What a calibration has found, for a person.

use core::fmt;

use marquardt::Calibration;

/// What a parameter is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unit {
    /// A length in mm.
    Mm,
    /// An angle, shown in degrees.
    Deg,
    /// A ratio.
    One,
}

impl Unit {
    /// What one of the calibration's unit is in this one.
    #[must_use]
    pub const fn scale(self) -> f64 {
        match self {
            Self::Deg => 180.0 / core::f64::consts::PI,
            Self::Mm | Self::One => 1.0,
        }
    }

    /// Of a tenth of a micrometre, some seconds of arc, a millionth.
    const fn decimals(self) -> usize {
        match self {
            Self::Mm | Self::Deg => 4,
            Self::One => 6,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Mm => " mm",
            Self::Deg => " deg",
            Self::One => "",
        }
    }
}

/// What a calibration has found; displayed, a summary in lines.
#[derive(Debug, Clone)]
pub struct Fitted {
    points: usize,
    rms_mm: f64,
    largest_mm: f64,
    changes: Vec<Change>,
}

#[derive(Debug, Clone)]
struct Change {
    name: String,
    /// In the unit, as its standard deviation, which is none where the points do not tell.
    change: f64,
    deviation: Option<f64>,
    unit: Unit,
}

impl Fitted {
    /// Of a calibration by so many points in mm, and what each of its parameters is measured in.
    pub fn new<M, P: Copy + fmt::Display, const N: usize>(
        found: &Calibration<M, P, N>,
        points: usize,
        unit: impl Fn(P) -> Unit,
    ) -> Self {
        let all = found.parameters().iter().zip(found.changes());
        let changes = all.zip(found.deviations());
        let changes = changes.map(|((parameter, change), deviation)| {
            let unit = unit(*parameter);
            Change {
                name: parameter.to_string(),
                change: change * unit.scale(),
                deviation: deviation.map(|it| it * unit.scale()),
                unit,
            }
        });
        Self {
            points,
            rms_mm: found.rms(),
            largest_mm: found.largest(),
            changes: changes.collect(),
        }
    }
}

impl fmt::Display for Fitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} points: {:.4} mm rms are left, {:.4} mm at most",
            self.points, self.rms_mm, self.largest_mm
        )?;
        for Change {
            name,
            change,
            deviation,
            unit,
        } in &self.changes
        {
            let (unit, decimals) = (unit.name(), unit.decimals());
            write!(f, "{name}: {change:+.decimals$}{unit}")?;
            match deviation {
                Some(deviation) => writeln!(f, " ± {deviation:.decimals$}{unit}")?,
                None => writeln!(f, ", which the points do not determine")?,
            }
        }
        Ok(())
    }
}
