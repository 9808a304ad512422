//! What rows ask of the axes.

use path_timing::{AxisLimits, Cubic, Row};

/// Of what is recomputed from rounded rows.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Speeds and accelerations of all cubics are within their limits.
pub(crate) fn check_limits<const N: usize>(limits: &[AxisLimits; N], rows: &[Row<[f64; N]>]) {
    for pair in rows.windows(2) {
        let [from, to] = pair else { unreachable!() };
        for (cubic, limits) in Cubic::between(from, to).zip(limits) {
            assert!(cubic.peak_speed() <= limits.speed * ROUNDING, "{cubic:?}");
            for acceleration in cubic.accelerations() {
                let share = acceleration.abs() / limits.acceleration;
                assert!(share <= ROUNDING, "{share}: {cubic:?}");
            }
        }
    }
}
