//! The sources' numbers, frames and zeros, and what limits refuse.

use core::f64::consts::{FRAC_PI_2, PI};

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Arm, ArmGeometry, ArmRange, Delta, Dimensions, ElbowSide, ForwardError, GeometryError,
    InverseError, PoseError, Positive, ZAxis,
};

use crate::common::thesis::thesis;

/// Printed numbers have 16 digits.
const PRINTED: f64 = 1e-14;

fn same(a: Vector3<f64>, b: [f64; 3], tolerance: f64) {
    assert!((a - Vector3::from(b)).amax() <= tolerance, "{a}");
}

#[test]
fn right_examples() {
    let delta = thesis();
    let angles = |x, y, z| delta.inverse(Point3::new(x, y, z)).unwrap();
    same(angles(0.0, 0.0, -250.0), [1.1644043382362643; 3], PRINTED);
    let printed = [
        1.003_641_169_083_117_5,
        0.6377002224484095,
        0.526_452_217_253_15,
    ];
    same(angles(50.0, 50.0, -300.0), printed, PRINTED);
    let printed = [0.7310574933528662, 1.1829103881969839, 0.7010027443803162];
    same(angles(-60.0, 40.0, -280.0), printed, PRINTED);
    same(angles(0.0, 0.0, -38313f64.sqrt()), [FRAC_PI_2; 3], PRINTED);
    same(
        angles(0.0, 0.0, -120.0 - 58473f64.sqrt()),
        [0.0; 3],
        PRINTED,
    );
}

/// The worked example of [Delta thesis] is out of the reach of arms 1 and 2.
#[test]
fn the_thesis_example_is_refused() {
    let point = Point3::new(50.0, 50.0, 100.0);
    let delta = thesis();
    let Err(InverseError::TooNear { arm, by }) = delta.inverse(point) else {
        panic!("{:?}", delta.inverse(point));
    };
    assert_eq!(arm, Arm::First);
    // The farthest place of the elbow, by hand.
    let h = 24.0 - 50.0 * (0.75f64.sqrt() + 0.5);
    let side = 50.0 * (0.75f64.sqrt() - 0.5);
    let far = (h.hypot(100.0) + 120.0).hypot(side);
    assert!((by - (243.0 - far)).abs() < 1e-12, "{by}");
    let text = delta.inverse(point).unwrap_err().to_string();
    assert!(
        text.starts_with("out of reach: arm 1 is ") && text.ends_with(" too long"),
        "{text}"
    );
}

/// Sixteenth-microsteps of a 1.8° motor through 27:1, from horizontal arms.
#[test]
fn microsteps_from_home() {
    let delta = thesis().with_zero(FRAC_PI_2).unwrap();
    let angles = delta.inverse(Point3::new(50.0, 50.0, -300.0)).unwrap();
    let per_rad = 200.0 * 16.0 * 27.0 / (2.0 * PI);
    let steps = angles.map(|angle| (angle * per_rad).round());
    same(steps, [-7799.0, -12831.0, -14361.0], 0.0);
}

#[test]
fn reachable_heights() {
    let delta = thesis();
    let reached = |z| delta.inverse(Point3::new(50.0, 50.0, z)).is_ok();
    for (inside, outside) in [
        (-350.06439513332, -350.06439513333),
        (-114.00481094389, -114.00481094388),
    ] {
        assert!(reached(inside) && !reached(outside), "{inside}");
    }
}

#[test]
fn z_may_point_down_and_angles_inward() {
    let (up, point) = (thesis(), Point3::new(50.0, 50.0, -300.0));
    let mirrored = Point3::new(50.0, 50.0, 300.0);
    let down = up.with_z(ZAxis::Down);
    assert_eq!(down.inverse(mirrored), up.inverse(point));
    let angles = up.inverse(point).unwrap();
    assert!((down.forward(angles).unwrap() - mirrored).norm() <= up.tolerance());
    let elbow = |delta: Delta| delta.pose_of(angles).unwrap().elbows()[0];
    assert!((elbow(up).z + elbow(down).z).abs() < PRINTED);

    let inward = up
        .with_zero(FRAC_PI_2)
        .unwrap()
        .with_positive(Positive::Inward);
    let read = inward.inverse(point).unwrap();
    same(read, angles.map(|theta| FRAC_PI_2 - theta).into(), PRINTED);
    assert!((inward.forward(read).unwrap() - point).norm() <= up.tolerance());
    // Gravity pulls the arms inward: to hold them, they are turned outward.
    let weight = Vector3::new(0.0, 0.0, -1.0);
    let torques = up.pose_at(point).unwrap().holding_torques(weight).unwrap();
    let mirrored = inward
        .pose_at(point)
        .unwrap()
        .holding_torques(weight)
        .unwrap();
    assert!(torques.min() > 0.0);
    same(mirrored, (-torques).into(), 1e-10);
}

#[test]
fn limits_are_told_by_arm_and_amount() {
    let point = Point3::new(50.0, 50.0, -300.0);
    let range = ArmRange::new(0.6, 2.0).unwrap();
    let delta = thesis().with_range(range);
    let theta = 0.526_452_217_253_15;
    match delta.inverse(point) {
        Err(InverseError::JointLimit {
            arm: Arm::Third,
            angle,
            min,
            max,
        }) => {
            assert!((angle - theta).abs() < PRINTED && min >= 0.6 && max <= 2.0);
        }
        other => panic!("{other:?}"),
    }

    let delta = thesis().with_ball_joints(0.2).unwrap();
    match delta.inverse(point) {
        Err(InverseError::BallJoint {
            arm: Arm::Second,
            swivel,
            max,
        }) => {
            // The wrist is beside the arm's plane by 68.3 mm.
            assert!((swivel - (68.301_270_189_221_94_f64 / 243.0).asin()).abs() < 1e-14);
            assert!((max - 0.2).abs() < 1e-14);
        }
        other => panic!("{other:?}"),
    }
    assert!(
        thesis()
            .with_ball_joints(0.29)
            .unwrap()
            .inverse(point)
            .is_ok()
    );
}

/// By radians, not by their ratio to the end of the range.
#[test]
fn of_two_arms_outside_the_farther_is_named() {
    let [first, second, third] = [0.6, 0.3, 2.0].map(|max| ArmRange::new(-1.0, max).unwrap());
    let delta = thesis().with_ranges([first, second, third]);
    let refused = delta.inverse(Point3::new(50.0, 50.0, -300.0));
    let arm = Arm::First;
    assert!(matches!(refused, Err(InverseError::JointLimit { arm: named, .. }) if named == arm));
}

/// A range above π takes the angle at the turn that lies in it.
#[test]
fn a_range_chooses_the_turn() {
    let delta = thesis();
    let bent = delta.with_working_mode([ElbowSide::In; 3]);
    let knees_in = bent.inverse(Point3::new(0.0, 0.0, -130.0)).unwrap();
    assert!(knees_in.max() < -2.0);
    let turned = bent
        .with_range(ArmRange::new(1.0, 6.0).unwrap())
        .inverse(Point3::new(0.0, 0.0, -130.0))
        .unwrap();
    same(
        turned,
        knees_in.map(|angle| angle + 2.0 * PI).into(),
        PRINTED,
    );
    // Two turns on.
    let point = Point3::new(50.0, 50.0, -300.0);
    let wound = delta.with_range(ArmRange::new(13.0, 14.0).unwrap());
    let angles = delta.inverse(point).unwrap();
    let turned = wound.inverse(point).unwrap();
    same(
        turned,
        angles.map(|angle| angle + 4.0 * PI).into(),
        2.0 * PRINTED,
    );
}

/// Elbows almost on a line: the circumcentre of their triangle alone does not hold the lengths.
#[test]
fn a_thin_triangle_of_knees_keeps_the_lengths() {
    // Far out, where the elbows have changed their order round the axis.
    let delta = Delta::<f32>::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    let point = Point3::new(198.061_14, 29.537_943, -255.231_63);
    let made = delta.forward(delta.inverse(point).unwrap()).unwrap();
    assert!(delta.inverse(made).is_ok(), "{made}");
}

#[test]
fn impossible_angles_are_refused() {
    let short = Delta::new(Dimensions {
        base: 100.0,
        platform: 20.0,
        upper: 120.0,
        lower: 150.0,
    })
    .unwrap();
    match short.forward(Vector3::repeat(FRAC_PI_2)) {
        // Elbows 200 from the axis, rods of 150.
        Err(ForwardError::Apart { arm, by }) => {
            assert!(arm == Arm::First && (by - 50.0).abs() < 1e-12);
        }
        other => panic!("{other:?}"),
    }
    // Base and platform equal, arms straight down: the three centres are one.
    let narrow = Delta::new(Dimensions {
        base: 50.0,
        platform: 50.0,
        upper: 100.0,
        lower: 200.0,
    })
    .unwrap();
    assert_eq!(
        narrow.forward(Vector3::zeros()),
        Err(ForwardError::Collinear)
    );
    for bad in [f64::NAN, f64::INFINITY] {
        match narrow.forward(Vector3::new(1.0, bad, 1.0)) {
            Err(ForwardError::Angle {
                arm: Arm::Second, ..
            }) => {}
            other => panic!("{other:?}"),
        }
        let point = Point3::new(0.0, bad, -200.0);
        assert!(matches!(
            narrow.inverse(point),
            Err(InverseError::NotFinite { .. })
        ));
    }
    // Each is an angle, their sum is too far from zero.
    let wound = narrow.with_zero(6e7).unwrap();
    assert!(matches!(
        wound.forward(Vector3::repeat(6e7)),
        Err(ForwardError::Angle { .. })
    ));
    let far = narrow.inverse(Point3::new(f64::MAX, -f64::MAX, f64::MAX));
    assert!(
        matches!(far, Err(InverseError::TooFar { by, .. }) if by.is_finite()),
        "{far:?}"
    );
}

#[test]
fn geometry_is_checked() {
    assert!(matches!(
        Delta::new(Dimensions {
            base: 42.0,
            platform: 18.0,
            upper: -120.0,
            lower: 243.0
        }),
        Err(GeometryError::Length {
            arm: Arm::First,
            name: "upper arm",
            ..
        })
    ));
    assert!(
        Delta::new(Dimensions {
            base: f64::NAN,
            platform: 18.0,
            upper: 120.0,
            lower: 243.0
        })
        .is_err()
    );
    assert!(
        Delta::new(Dimensions {
            base: 42.0,
            platform: -1.0,
            upper: 120.0,
            lower: 243.0
        })
        .is_err()
    );
    assert!(
        Delta::new(Dimensions {
            base: 42.0,
            platform: 18.0,
            upper: 120.0,
            lower: f64::INFINITY
        })
        .is_err()
    );
    let mut arms = *thesis().arms();
    arms[2].azimuth = f64::NAN;
    assert!(matches!(
        Delta::from_arms(arms),
        Err(GeometryError::Angle {
            arm: Arm::Third,
            name: "azimuth",
            ..
        })
    ));
    for (min, max) in [
        (1.0, 1.0),
        (0.0, 6.3),
        (f64::NAN, 1.0),
        (0.0, f64::INFINITY),
    ] {
        assert!(ArmRange::new(min, max).is_err());
    }
    for swivel in [0.0, -0.1, 1.6, f64::NAN] {
        assert!(thesis().with_ball_joints(swivel).is_err());
    }
    let arm = ArmGeometry::nominal(
        Arm::Third,
        Dimensions {
            base: 1.0,
            platform: 1.0,
            upper: 1.0,
            lower: 1.0,
        },
    );
    assert!((arm.azimuth - 1.5 * PI).abs() < 1e-15);
}

/// Both kinds of singularity, at hand-made places.
#[test]
fn singular_poses_are_told() {
    // Stretched straight: shoulder to wrist is Lb + La along the line through the shoulder.
    let delta = Delta::new(Dimensions {
        base: 50.0,
        platform: 40.0,
        upper: 100.0,
        lower: 200.0,
    })
    .unwrap();
    let down = -(300f64 * 300.0 - 10.0 * 10.0).sqrt();
    let stretched = delta.pose_at(Point3::new(0.0, 0.0, down)).unwrap();
    assert!(stretched.serial_distance().1 < 1e-4);
    match stretched.joint_rates(Vector3::x()) {
        Err(PoseError::Serial { lever, .. }) => assert!(lever <= delta.tolerance()),
        // Rounding may leave the lever a little above the tolerance.
        Ok(rates) => assert!(rates.amax() > 1e-3),
        other => panic!("{other:?}"),
    }
    // Rods level with the platform: La = D + Lb.
    let flat = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 144.0,
    })
    .unwrap();
    let pose = flat.pose_of(Vector3::repeat(FRAC_PI_2)).unwrap();
    assert!(pose.parallel_distance() < 1e-6);
    let force = Vector3::new(0.0, 0.0, -1.0);
    match pose.holding_torques(force) {
        Err(PoseError::Parallel { sine }) => assert!(sine < 1e-15),
        Ok(torques) => assert!(torques.amax() > 1e6),
        other => panic!("{other:?}"),
    }
    // Rods square to each other are as far from it as can be.
    let pose = thesis().pose_at(Point3::new(0.0, 0.0, -250.0)).unwrap();
    assert!(pose.parallel_distance() > 0.2 && pose.parallel_distance() <= 1.0);
}

/// The figure of `docs/book/src/performance.md`.
#[test]
fn memory_is_as_stated() {
    assert_eq!(size_of::<Delta>(), 552);
}

/// Straight above the middle each arm holds a third of the weight, by hand.
#[test]
fn torques_by_hand() {
    let delta = thesis();
    let pose = delta
        .pose_at(Point3::new(0.0, 0.0, -38313f64.sqrt()))
        .unwrap();
    // Arms horizontal, so the weight's lever is the upper arm itself.
    let torques = pose.holding_torques(Vector3::new(0.0, 0.0, -30.0)).unwrap();
    same(torques, [10.0 * 120.0; 3], 1e-9);
    let forces = pose.rod_forces(Vector3::new(0.0, 0.0, -30.0)).unwrap();
    let slope = 38313f64.sqrt() / 243.0;
    same(forces, [-10.0 / slope; 3], 1e-12);
}
