//! Higher limits, a larger tolerance and more segments do not make a motion slower.

use path_timing::{AxisLimits, Curve, Knot, Table};
use proptest::prelude::*;

use crate::support::machine::limits;
use crate::support::polyline::{points, smoothed};

/// By what a motion may be slower, as a part of its time.
const SLOWER: f64 = 1.01;

/// The same for twice the segments where a row lasts longer than half the ramp of an acceleration at the
/// jerk's limit: a row hides what happens in it.
const HIDDEN: f64 = 1.1;

const RAMP: f64 = 0.5;

/// None where a curve turns too sharply for the segments.
fn time_s(curves: &[Curve<2>], limits: AxisLimits, segments: u32) -> Option<f64> {
    times_s(curves, limits, segments).map(|[time_s, _]| time_s)
}

/// And the time of the longest row.
fn times_s(curves: &[Curve<2>], limits: AxisLimits, segments: u32) -> Option<[f64; 2]> {
    let mut knots = vec![Knot::default(); 4000];
    let table = Table::plan(curves, [limits; 2], |_| segments, &mut knots).ok()?;
    let longest_s = table.rows().map(|row| row.duration_s).fold(0.0, f64::max);
    Some([table.duration_s(), longest_s])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn more_does_not_take_longer(
        points in points(), tolerance in 0.01..2.0_f64, segments in 16..40_u32,
        speed in 50.0..500.0_f64, acceleration in 200.0..5000.0_f64, rate in 10.0..300.0_f64,
        more in 1.0..3.0_f64,
    ) {
        let own = limits(speed, acceleration, Some(acceleration * rate));
        let curves = smoothed(&points, tolerance);
        let before_s = time_s(&curves, own, segments);
        prop_assume!(before_s.is_some());
        let before_s = before_s.unwrap();
        let jerk = own.jerk.map(|jerk| jerk * more);
        let higher = [
            AxisLimits { speed: speed * more, ..own },
            AxisLimits { acceleration: acceleration * more, ..own },
            AxisLimits { jerk, ..own },
            AxisLimits { jerk: None, ..own },
        ];
        for limits in higher {
            let after_s = time_s(&curves, limits, segments).unwrap();
            prop_assert!(after_s < before_s * SLOWER, "{} {:?}", after_s / before_s, limits);
        }
        if let Some(after_s) = time_s(&smoothed(&points, tolerance * more), own, segments) {
            prop_assert!(after_s < before_s * SLOWER, "{} within more", after_s / before_s);
        }
    }

    #[test]
    fn more_segments_do_not_take_longer(
        points in points(), tolerance in 0.01..2.0_f64, speed in 50.0..500.0_f64,
        acceleration in 200.0..5000.0_f64, rate in 10.0..300.0_f64,
    ) {
        let own = limits(speed, acceleration, Some(acceleration * rate));
        let curves = smoothed(&points, tolerance);
        for segments in [4, 8, 16, 32, 64] {
            let Some([before_s, longest_s]) = times_s(&curves, own, segments) else { continue };
            let is_shown = longest_s * rate < RAMP;
            let slower = if is_shown { SLOWER } else { HIDDEN };
            let after_s = time_s(&curves, own, 2 * segments).unwrap();
            prop_assert!(after_s < before_s * slower, "{} with {segments}", after_s / before_s);
        }
    }
}
