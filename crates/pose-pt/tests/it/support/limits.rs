//! The limits of what a controller runs, computed again from the points that it gets.

use pose_pt::Platform;
use pose_pt::nalgebra::Vector3;

use super::cubic::between;
use super::table::Point;

/// Times and positions of some metres rounded off, in limits that a reader recomputes.
pub(crate) const LIMIT: f64 = 1.0 + 1e-9;

/// The largest fractions of the limits of speed, acceleration and jerk: none is passed.
pub(crate) fn check_limits<const N: usize>(
    platform: &Platform<N>,
    points: &[Point<N>],
) -> [f64; 3] {
    let mut fractions = [0.0_f64; 3];
    let mut before = [Vector3::<f64>::zeros(); N];
    let mut before_s = 0.0;
    for pair in points.windows(2) {
        let [from, to] = pair else { unreachable!() };
        let [_, _, starts, jerks] = between(from, to, 0.0);
        let mean_s = (before_s + to.segment_s) / 2.0;
        for (number, locator) in platform.locators().iter().enumerate() {
            for (axis, limits) in locator.limits.iter().enumerate() {
                for place in 0..=16 {
                    let [_, speeds, accelerations, _] = between(from, to, f64::from(place) / 16.0);
                    fractions[0] = fractions[0].max(speeds[number][axis].abs() / limits.speed);
                    let acceleration = accelerations[number][axis].abs();
                    fractions[1] = fractions[1].max(acceleration / limits.acceleration);
                }
                if let Some(limit) = limits.jerk {
                    let step = (starts[number][axis] - before[number][axis]).abs() / mean_s;
                    fractions[2] = fractions[2].max(step / limit);
                    fractions[2] = fractions[2].max(jerks[number][axis].abs() / limit);
                }
            }
        }
        before = between(from, to, 1.0)[2];
        before_s = to.segment_s;
    }
    // And at the end, where all stands still.
    for (locator, before) in platform.locators().iter().zip(&before) {
        for (limits, before) in locator.limits.iter().zip(before.iter()) {
            if let Some(limit) = limits.jerk {
                fractions[2] = fractions[2].max(before.abs() / (before_s / 2.0) / limit);
            }
        }
    }
    let are_kept = fractions.iter().all(|share| *share < LIMIT);
    assert!(are_kept, "{fractions:?}");
    fractions
}
