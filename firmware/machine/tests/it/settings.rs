//! Settings that are refused, and what is said of them.

use board_machine::{Kinematics, Machine, RotaryDelta, Settings, TwoLinkArm, XyStage};

use crate::rig::{ARM, DELTA, Kind, STAGE, TICK_HZ};

type Spoil<K, const N: usize> = fn(&mut Settings<K, N>);

fn refused<K: Kinematics<N>, const N: usize>(kind: Kind<K, N>, spoil: Spoil<K, N>) -> String
where
    K::Geometry: Copy,
{
    let mut settings = Settings {
        geometry: kind.settings.geometry,
        axes: kind.settings.axes,
        ..*kind.settings
    };
    spoil(&mut settings);
    let machine = Machine::new(&settings, TICK_HZ).map_err(|error| error.to_string());
    machine.err().expect("refused")
}

#[test]
fn what_is_wrong_is_named_with_its_value() {
    let cases: [(Spoil<TwoLinkArm, 2>, &str); 8] = [
        (
            |settings| settings.axes[1].home_deg = 19.0,
            "elbow: home at 19 degrees is out of its range",
        ),
        (
            |settings| settings.axes[0].speed_deg_s = 4000.0,
            "shoulder: 177778 steps a second at the largest speed, 142857 are possible",
        ),
        (
            |settings| settings.axes[0].speed_deg_s = f64::NAN,
            "shoulder: NaN steps a second at the largest speed, 142857 are possible",
        ),
        (
            |settings| settings.axes[1].range_deg = [160.0, 20.0],
            "elbow: a range of 160 to 20",
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
        assert_eq!(refused(ARM, spoil), message);
    }
    assert!(Machine::new(ARM.settings, 0).is_err());
}

#[test]
fn of_a_delta_and_a_stage_too() {
    let cases: [(Spoil<RotaryDelta, 3>, &str); 2] = [
        (
            // Arms that swing inward, past where rods can follow.
            |settings| settings.geometry.max_swivel_deg = 90.0,
            "ball joints may swivel by 1.5708 rad, which is not above 0 and below π/2",
        ),
        (
            |settings| settings.geometry.lower_mm = 50.0,
            "at home the tool is nowhere, or the axes may not be there",
        ),
    ];
    for (spoil, message) in cases {
        assert_eq!(refused(DELTA, spoil), message);
    }
    let home: Spoil<XyStage, 2> = |settings| settings.axes[1].home_mm = -1.0;
    assert_eq!(refused(STAGE, home), "y: home at -1 mm is out of its range");
    let scale: Spoil<XyStage, 2> = |settings| {
        if let Some(scale) = &mut settings.axes[1].scale {
            scale.dead_band_counts = scale.alarm_counts;
        }
    };
    assert_eq!(
        refused(STAGE, scale),
        "y: a dead band of 100 counts is not below the alarm at 100"
    );
}
