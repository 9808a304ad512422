//! Settings from a file.

use pvt_steps::RampLimits;
use test_support::stored;

#[test]
fn settings_come_back() {
    stored(&RampLimits {
        start_millihertz: 1,
        max_millihertz: 2,
        accel_steps_per_s2: 3,
    });
}
