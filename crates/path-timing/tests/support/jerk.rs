//! What rows ask of axes with a limit of jerk.

use path_timing::{AxisLimits, Cubic, Row};

use crate::limited::check_limits;

/// Of what is recomputed from rounded rows.
const ROUNDING: f64 = 1.0 + 1e-9;

/// The jerk inside of each cubic, and the steps of the acceleration at rows over the time between
/// the middles of their segments; at rest the acceleration is zero.
pub(crate) fn check_jerk<const N: usize>(limits: &[AxisLimits; N], rows: &[Row<[f64; N]>]) {
    check_limits(limits, None, rows);
    for (axis, limits) in limits.iter().enumerate() {
        let jerk = limits.jerk.unwrap() * ROUNDING;
        let (mut before, mut before_s) = (0.0_f64, 0.0);
        for pair in rows.windows(2) {
            let cubic = Cubic::between(&pair[0], &pair[1]).nth(axis).unwrap();
            let [a0, a1] = cubic.accelerations();
            let time_s = cubic.duration_s;
            if pair[0].velocity.iter().all(|v| *v == 0.0) {
                assert!(before.abs() <= jerk * before_s * 0.5, "to rest: {before}");
                (before, before_s) = (0.0, 0.0);
            }
            assert!((a1 - a0).abs() <= jerk * time_s, "{cubic:?}");
            let step = (a0 - before).abs() / ((time_s + before_s) * 0.5);
            assert!(step <= jerk, "{} at {}", step / jerk, pair[0].time_s);
            (before, before_s) = (a1, time_s);
        }
        assert!(
            before.abs() <= jerk * before_s * 0.5,
            "to the end: {before}"
        );
    }
}
