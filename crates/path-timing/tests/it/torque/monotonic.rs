//! Stronger motors, higher limits and more segments do not make a motion slower.

use path_timing::{AxisLimits, Curve, Knot, PlanError, TorqueCurve, TorqueLimits};
use proptest::prelude::*;
use scara_kin::{ArmDynamics, ArmMasses, ArmPath, Elbow, JointDrive};

use super::{alike, arm, masses};

/// By what a motion may be slower, as a part of its time.
const SLOWER: f64 = 1.01;

/// None where a motor cannot hold what it carries.
fn time_s(
    torque: &TorqueLimits<ArmDynamics>,
    path: ArmPath,
    limits: [AxisLimits; 2],
    segments: u32,
) -> Option<f64> {
    let mut knots = vec![Knot::default(); 1000];
    match torque.plan([path], limits, |_| segments, &mut knots) {
        Ok(table) => Some(table.duration_s()),
        Err(PlanError::Overload { .. }) => None,
        Err(other) => panic!("{other}"),
    }
}

fn times(limits: [AxisLimits; 2], more: f64) -> [AxisLimits; 2] {
    limits.map(|limits| AxisLimits {
        speed: limits.speed * more,
        acceleration: limits.acceleration * more,
        jerk: None,
    })
}

fn bezier(points: [[f64; 2]; 4]) -> Option<ArmPath> {
    let curve = Curve::bezier(points).ok()?;
    arm().path(curve, Elbow::Right).ok()
}

fn point() -> impl Strategy<Value = [f64; 2]> {
    (-350.0..350.0_f64, 80.0..450.0_f64).prop_map(|(x, y)| [x, y])
}

fn motor(torque: f64) -> impl Strategy<Value = TorqueCurve> {
    (1.0..8.0_f64, prop::option::of(1.0..10.0_f64)).prop_map(move |(times, corner)| match corner {
        Some(corner) => TorqueCurve::holding(torque * times, corner, 40.0).unwrap(),
        None => TorqueCurve::constant(torque * times, 40.0).unwrap(),
    })
}

fn axis() -> impl Strategy<Value = AxisLimits> {
    (1.0..30.0_f64, 1.0..3.0_f64).prop_map(|(speed, magnitude)| AxisLimits {
        speed,
        acceleration: 10.0_f64.powf(magnitude),
        jerk: None,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn more_takes_no_longer(
        points in prop::array::uniform4(point()), motors in (motor(25.0), motor(10.0)),
        payload_kg in 0.0..3.0_f64, gravity_m_s2 in prop::sample::select(vec![0.0, 9.806_65]),
        limits in (axis(), axis()), more in 1.0..2.0_f64,
        segments in prop::sample::select(vec![100, 200, 400]),
    ) {
        let masses = ArmMasses { gravity_m_s2, ..masses(payload_kg) };
        let motors = <[TorqueCurve; 2]>::from(motors);
        let torque = TorqueLimits { dynamics: arm().dynamics(1e-3, masses).unwrap(), motors };
        let stronger = motors.map(|motor| motor.scaled(more).unwrap());
        let stronger = TorqueLimits { motors: stronger, ..torque };
        let path = bezier(points);
        prop_assume!(path.is_some());
        let (path, limits) = (path.unwrap(), limits.into());
        let before_s = time_s(&torque, path, limits, segments);
        prop_assume!(before_s.is_some());
        let after = [
            ("motors", time_s(&stronger, path, limits, segments)),
            ("limits", time_s(&torque, path, times(limits, more), segments)),
            ("segments", time_s(&torque, path, limits, 2 * segments)),
        ];
        for (what, after_s) in after {
            // Where a motor cannot hold the load, it may or may not come by.
            let Some(after_s) = after_s else { continue };
            let ratio = after_s / before_s.unwrap();
            prop_assert!(ratio < SLOWER, "{} with more {}", ratio, what);
        }
    }
}

/// Where gravity helps, a slower motion asks for more: the whole was slowed by 35 % for a segment
/// that asked for 0.7 % too much.
#[test]
fn a_segment_does_not_slow_the_whole() {
    let drive = JointDrive {
        rotor_kg_m2: 0.006_573_157_772_121_375,
        viscous_nm_s: 0.284_775_402_003_177_64,
        coulomb_nm: 0.046_331_853_069_414_675,
    };
    let masses = alike(0.922_180_185_672_872_7, drive, 1.745_027_415_697_867_6);
    let motors = [(165.561, 4.820_634_297), (32.9464, 1.198_447_894)]
        .map(|(torque, corner)| TorqueCurve::holding(torque, corner, 40.0).unwrap());
    let dynamics = arm().dynamics(1e-3, masses).unwrap();
    let torque = TorqueLimits { dynamics, motors };
    let path = bezier([
        [-330.822_667_776_193_5, 286.786_619_289_506_23],
        [152.182_423_714_112_76, 238.238_320_997_144_85],
        [-121.906_727_018_481_77, 388.812_855_042_541_2],
        [-104.831_377_417_489_42, 445.802_629_004_77],
    ]);
    let limits = [
        (20.996_707_966, 917.274_501_685),
        (7.339_280_636, 218.900_117_549),
    ]
    .map(|(speed, acceleration)| AxisLimits {
        speed,
        acceleration,
        jerk: None,
    });
    let path = path.unwrap();
    let before_s = time_s(&torque, path, limits, 100).unwrap();
    let after_s = time_s(&torque, path, times(limits, 1.555_118), 100).unwrap();
    assert!(after_s < before_s * SLOWER, "{after_s} s, not {before_s} s");
}
