//! What rows ask of the axes.

use path_timing::{AxisLimits, Cubic, Row};

/// Of what is recomputed from rounded rows.
pub(crate) const ROUNDING: f64 = 1.0 + 1e-9;

/// Speeds and accelerations of all cubics are within their limits; velocities jump by at most the
/// start-stop speeds, or nowhere.
pub(crate) fn check_limits<const N: usize>(
    limits: &[AxisLimits; N],
    start_stop: Option<&[f64; N]>,
    rows: &[Row<[f64; N]>],
) {
    for pair in rows.windows(2) {
        let [from, to] = pair else { unreachable!() };
        if to.duration_s == 0.0 {
            let bits = |row: &Row<[f64; N]>| row.position.map(f64::to_bits);
            assert_eq!(bits(from), bits(to));
            let start_stop = start_stop.expect("a corner");
            for ((v0, v1), jump) in from.velocity.iter().zip(to.velocity).zip(start_stop) {
                assert!((v1 - v0).abs() <= *jump, "{v0} to {v1}, not {jump}");
            }
            continue;
        }
        for (cubic, limits) in Cubic::between(from, to).zip(limits) {
            assert!(cubic.peak_speed() <= limits.speed * ROUNDING, "{cubic:?}");
            for acceleration in cubic.accelerations() {
                let ratio = acceleration.abs() / limits.acceleration;
                assert!(ratio <= ROUNDING, "{ratio}: {cubic:?}");
            }
        }
    }
}
