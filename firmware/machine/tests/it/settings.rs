//! Settings that are refused, and what is said of them.

use board_machine::{Machine, Settings};

use crate::rig::{SETTINGS, TICK_HZ};

type Spoil = fn(&mut Settings);

#[test]
fn what_is_wrong_is_named_with_its_value() {
    let cases: [(Spoil, &str); 7] = [
        (
            |settings| settings.home_deg[1] = 19.0,
            "joint 1: home at 19 degrees is out of its range",
        ),
        (
            |settings| settings.speed_deg_s[0] = 4000.0,
            "joint 0: 177778 steps a second at the largest speed, 142857 are possible",
        ),
        (
            |settings| settings.speed_deg_s[0] = f64::NAN,
            "joint 0: NaN steps a second at the largest speed, 142857 are possible",
        ),
        (
            |settings| settings.homing_fast_hz = 0,
            "homing at 0 steps a second",
        ),
        (
            |settings| settings.homing_slow_hz = 200_000,
            "homing at 200000 steps a second",
        ),
        (
            |settings| settings.tolerance_mm = f64::NAN,
            "a tolerance of NaN mm",
        ),
        (
            |settings| settings.tolerance_mm = -0.1,
            "a tolerance of -0.1 mm",
        ),
    ];
    for (spoil, message) in cases {
        let mut settings = SETTINGS;
        spoil(&mut settings);
        let refused = Machine::new(&settings, TICK_HZ).map_err(|error| error.to_string());
        assert_eq!(refused.err().as_deref(), Some(message));
    }
    assert!(Machine::new(&SETTINGS, 0).is_err());
}
