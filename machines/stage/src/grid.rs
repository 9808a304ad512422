//! The steps of the stage in mm, the ticks of its clock in seconds.

use kurbo::Point;

/// Of the screws.
pub(crate) const PITCH_MM: f64 = 4.0;
/// 1.8 degrees a step.
pub(crate) const FULL_STEPS_PER_TURN: u32 = 200;
/// Half steps.
pub(crate) const MICROSTEPS: u32 = 2;
/// Of these motors on these screws.
pub(crate) const STEPS_PER_MM: f64 = 100.0;

/// Ticks of the clock in a second: microseconds.
pub(crate) const TICKS_PER_S: u32 = 1_000_000;

/// The nearest grid point, in steps.
pub(crate) fn to_steps(at: Point) -> [i32; 2] {
    // Coordinates are bounded by the parser, far below 2^31 steps.
    #[expect(clippy::cast_possible_truncation, reason = "rounded, and saturates")]
    [at.x, at.y].map(|mm| (mm * STEPS_PER_MM).round() as i32)
}

/// Where the stage is after these steps.
pub(crate) fn to_mm([x, y]: [i32; 2]) -> Point {
    Point::new(f64::from(x) / STEPS_PER_MM, f64::from(y) / STEPS_PER_MM)
}

/// Ticks of the clock in seconds.
pub(crate) fn seconds(ticks: u64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "microseconds far below 2^52")]
    let ticks = ticks as f64;
    ticks / f64::from(TICKS_PER_S)
}
