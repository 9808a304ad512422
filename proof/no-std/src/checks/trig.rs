//! trig-kernels.

use core::hint::black_box;

use trig_kernels::{atan2, sin_cos};

use super::holds;

/// An angle in the common range and one beyond, there and back.
pub fn angles() -> Option<()> {
    let (sin, cos) = sin_cos(black_box(0.75_f32));
    holds(atan2(sin, cos) == 0.75)?;
    let (sin, cos) = sin_cos(black_box(1e22_f64));
    // sin 10²² = -0.8522008497671888018, cos 10²² = 0.5232147853951389455
    holds((sin + 0.852_200_849_767_188_8).abs() < f64::EPSILON)?;
    holds((cos - 0.523_214_785_395_139).abs() < f64::EPSILON)?;
    holds(atan2(black_box(0.0), -1.0) == core::f64::consts::PI)
}
