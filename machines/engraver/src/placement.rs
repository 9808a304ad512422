//! Where a drawing is placed on the machine.

use core::str::FromStr;

use anyhow::{Context, Error, Result, anyhow, ensure};
use kurbo::{Affine, Rect};
use serde::{Deserialize, Serialize};

use crate::numbers::{finite, positive};

/// The rectangle into which a drawing is fitted, in mm.
#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Bed {
    x_mm: f64,
    y_mm: f64,
    width_mm: f64,
    height_mm: f64,
}

impl Bed {
    pub(crate) fn check(self) -> Result<Self> {
        finite("x_mm", self.x_mm)?;
        finite("y_mm", self.y_mm)?;
        positive("width_mm", self.width_mm)?;
        positive("height_mm", self.height_mm)?;
        Ok(self)
    }

    /// The placement that puts `bounds`, y down, as large as possible into the middle of the bed,
    /// y up.
    pub(crate) fn fit(&self, bounds: Rect) -> Placement {
        // A drawing that is a straight line has one side only, one that is a dot none.
        let across = [
            self.width_mm / bounds.width(),
            self.height_mm / bounds.height(),
        ];
        let scale = across.into_iter().fold(f64::INFINITY, f64::min);
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let middle = (
            self.x_mm + self.width_mm / 2.0,
            self.y_mm + self.height_mm / 2.0,
        );
        Placement(
            Affine::translate(middle)
                * Affine::scale_non_uniform(scale, -scale)
                * Affine::translate(-bounds.center().to_vec2()),
        )
    }
}

/// Drawing to machine: `x' = ax + cy + e`, `y' = bx + dy + f`, in mm, with an area.
///
/// # Examples
/// ```
/// let half: engraver::Placement = "0.5,0,0,-0.5,0,100".parse()?;
/// assert!("1,0,0,0,0,0".parse::<engraver::Placement>().is_err());
/// # let _ = half;
/// # Ok::<(), anyhow::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Placement(pub(crate) Affine);

impl Placement {
    /// Length of a user unit, in mm; the mean of both directions.
    pub(crate) fn mm_per_unit(self) -> f64 {
        self.0.determinant().abs().sqrt()
    }
}

impl FromStr for Placement {
    type Err = Error;

    /// Reads `a,b,c,d,e,f`.
    fn from_str(text: &str) -> Result<Self> {
        let numbers = text
            .split(',')
            .map(|number| {
                let parsed = number.trim().parse::<f64>();
                parsed.with_context(|| format!("{number:?}"))
            })
            .collect::<Result<Vec<_>>>()?;
        let count = numbers.len();
        let numbers: [f64; 6] = numbers
            .try_into()
            .map_err(|_| anyhow!("{count} numbers, six are needed"))?;
        let affine = Affine::new(numbers);
        ensure!(affine.is_finite(), "a number is not finite");
        ensure!(affine.determinant() != 0.0, "the matrix has no area");
        Ok(Self(affine))
    }
}
