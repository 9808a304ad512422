//! What a plan is made by, besides machine and drawing.

use core::fmt;

use anyhow::{Result, ensure};

use crate::placement::Placement;

/// How far the planned path may be from the drawing, besides the motors' resolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    mm: f64,
}

impl Tolerance {
    /// A thousandth of what fine mechanics hold; the work grows without end below it.
    const MIN_MM: f64 = 1e-6;

    /// A drawing that is followed within more is another one.
    const MAX_MM: f64 = 10.0;

    /// A tolerance in mm.
    ///
    /// # Errors
    /// It is no number, below a millionth of a millimetre, or above 10 mm.
    pub fn from_mm(mm: f64) -> Result<Self> {
        ensure!(mm.is_finite() && mm > 0.0, "{mm} is not above 0 mm");
        ensure!(mm >= Self::MIN_MM, "{mm:e} is below {:e} mm", Self::MIN_MM);
        ensure!(mm <= Self::MAX_MM, "{mm:e} is above {} mm", Self::MAX_MM);
        Ok(Self { mm })
    }

    /// In mm.
    pub(crate) const fn mm(self) -> f64 {
        self.mm
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} mm", self.mm)
    }
}

/// What a plan is made by, besides machine and drawing.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "settings, set by their names")]
pub struct PlanSettings {
    /// How close the drawing is followed.
    pub tolerance: Tolerance,
    /// Where the drawing is; without it, it is fitted into the machine's bed.
    pub placement: Option<Placement>,
    /// Engraves the strokes in the order and direction of the file, not the nearest next.
    pub keep_order: bool,
}

impl Default for PlanSettings {
    /// 0.05 mm, fitted into the bed, the nearest stroke next.
    fn default() -> Self {
        Self {
            tolerance: Tolerance { mm: 0.05 },
            placement: None,
            keep_order: false,
        }
    }
}
