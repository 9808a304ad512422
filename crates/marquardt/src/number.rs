//! Roots of `core` alone.

use nalgebra::ComplexField;

pub(crate) fn sqrt(x: f64) -> f64 {
    ComplexField::sqrt(x)
}

/// √(x² + y²).
pub(crate) fn hypot(x: f64, y: f64) -> f64 {
    ComplexField::hypot(x, y)
}
