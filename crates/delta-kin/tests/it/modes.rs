//! Working and assembly modes: nothing is answered, followed, calibrated or counted as reached in
//! another mode than the machine's.

use core::f64::consts::FRAC_PI_2;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Arm, ArmRange, AssemblyMode, CalibrationError, Delta, Dimensions, ElbowSide, FollowError,
    InverseError, Measured, Parameter, PlatformPath, Positive, Quantity, SpeedLimits,
    WorkspaceError, ZAxis,
};

use crate::common::thesis::thesis;

fn limits() -> SpeedLimits {
    SpeedLimits::new(100.0, [5.0; 3]).unwrap()
}

/// Who works with z down and does not say so is told, and not driven to a place 460 mm away.
#[test]
fn a_point_above_the_base_is_refused_with_the_likely_cause() {
    let above = Point3::new(30.0, 20.0, 300.0);
    let refused = thesis().inverse(above).unwrap_err();
    assert_eq!(
        refused,
        InverseError::OtherAssembly {
            assembly_mode: AssemblyMode::Upper,
            z: Some(ZAxis::Down),
        }
    );
    assert_eq!(
        refused.to_string(),
        "the point lies above the base plane, where only the upper assembly mode reaches it; \
         ZAxis::Down would put it where the machine works"
    );
    let down = thesis().with_z(ZAxis::Down);
    let angles = down.inverse(above).unwrap();
    assert!((down.forward(angles).unwrap() - above).norm() < 1e-12);
    // The other way round.
    assert!(matches!(
        down.inverse(Point3::new(30.0, 20.0, -300.0)),
        Err(InverseError::OtherAssembly {
            z: Some(ZAxis::Up),
            ..
        })
    ));
    // Joint ranges do not hide the cause.
    let ranged = thesis().with_range(ArmRange::new(-0.3, 2.0).unwrap());
    assert_eq!(ranged.inverse(above), Err(refused));
    assert!(thesis().pose_at(above).is_err());
}

/// By name it is reached, and nothing below is.
#[test]
fn the_other_assembly_mode_is_asked_for_by_name() {
    let upper = thesis().with_assembly_mode(AssemblyMode::Upper);
    let above = Point3::new(30.0, 20.0, 300.0);
    let angles = upper.inverse(above).unwrap();
    assert!((upper.forward(angles).unwrap() - above).norm() < 1e-12);
    let elsewhere = thesis().forward(angles).unwrap();
    assert!((elsewhere - above).norm() > 450.0, "{elsewhere}");
    let refused = upper.inverse(Point3::new(30.0, 20.0, -300.0)).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "the point lies below the base plane, where only the lower assembly mode reaches it; \
         ZAxis::Down would put it where the machine works"
    );
    let (line, cylinder) = (
        PlatformPath::line(above, Point3::new(-30.0, 20.0, 300.0)).unwrap(),
        [230.0, 290.0],
    );
    assert!(upper.follow(line, 0.01, limits()).unwrap().count() > 2);
    assert!(upper.largest_cylinder(cylinder, 1.0).is_ok());
}

/// Rods that can come level with the platform: the singular surface lies below the base plane.
#[test]
fn a_point_beyond_the_singular_surface_is_refused() {
    let flat = Delta::new(Dimensions {
        base: 60.0,
        platform: 20.0,
        upper: 120.0,
        lower: 130.0,
    })
    .unwrap();
    // On the axis the elbows are above the platform or below it.
    let reached = |z: f64| flat.inverse(Point3::new(0.0, 0.0, z));
    let height = |z: f64| {
        let upper = flat.with_assembly_mode(AssemblyMode::Upper);
        let angle = reached(z)
            .or_else(|_| upper.inverse(Point3::new(0.0, 0.0, z)))
            .unwrap()
            .x;
        -120.0 * angle.cos() - z
    };
    let (mut inside, mut beyond) = (-150.0, 150.0);
    assert!(height(inside) > 0.0 && height(beyond) < 0.0);
    for _ in 0..60 {
        let middle = f64::midpoint(inside, beyond);
        if height(middle) > 0.0 {
            inside = middle;
        } else {
            beyond = middle;
        }
    }
    // Within rounding of the surface both modes are one.
    assert!(reached(inside - 1e-4).is_ok() && reached(inside + 1e-4).is_err());
    assert!(reached(inside).is_ok() && reached(inside + 1e-9).is_ok());
    let refused = reached(inside + 1.0).unwrap_err();
    let words = if inside + 1.0 > 0.0 {
        "the point lies above the base plane"
    } else {
        "the point is the higher of the two"
    };
    assert!(refused.to_string().starts_with(words), "{refused}");
}

/// Arms that swing inward beyond the axis change the order of their elbows: a mode named by that
/// order had the platform 108 mm above the base.
#[test]
fn the_lower_mode_is_below_also_where_arms_hang_inward() {
    let delta = thesis();
    let angles = Vector3::new(-0.3, 0.0, -0.2);
    let lower = delta.forward(angles).unwrap();
    assert!(lower.z < -100.0, "{lower}");
    let upper = delta.with_assembly_mode(AssemblyMode::Upper);
    assert!(upper.forward(angles).unwrap().z > lower.z + 100.0);
    // Elbows 1 and 3 were pushed in.
    let elbows = <[f64; 3]>::from(delta.pose_of(angles).unwrap().levers());
    let elbows = elbows.map(|lever| {
        if lever > 0.0 {
            ElbowSide::In
        } else {
            ElbowSide::Out
        }
    });
    assert_eq!(elbows, [ElbowSide::In, ElbowSide::Out, ElbowSide::In]);
    let bent = delta.with_working_mode(elbows);
    assert!((bent.inverse(lower).unwrap() - angles).amax() < 1e-12);
}

/// For all angles of all machines: `Lower` is the one of both points with the smaller z.
#[test]
fn lower_is_lower() {
    let mut both = 0;
    for k in 0..20_000u32 {
        let at = |n: u32| (f64::from(k) * f64::from(n).sqrt()).fract();
        let machine = Delta::new(Dimensions {
            base: 100.0 * at(2),
            platform: 80.0 * at(3),
            upper: 40.0 + 160.0 * at(5),
            lower: 250.0,
        })
        .unwrap();
        let angles = Vector3::new(at(7), at(11), at(13)) * 5.0 - Vector3::repeat(2.0);
        let upper = machine.with_assembly_mode(AssemblyMode::Upper);
        let points = [machine, upper].map(|machine| machine.forward(angles));
        if let [Ok(lower), Ok(upper)] = points {
            assert!(lower.z < upper.z, "{lower} {upper}");
            let flipped = machine.with_z(ZAxis::Down).forward(angles).unwrap();
            assert!((flipped.z + lower.z).abs() < 1e-9);
            both += 1;
        }
    }
    assert!(both > 10_000, "{both}");
}

/// Far out the plane of the elbows turns past upright. There the platform is the higher of its two
/// points, no path goes there from below, and where the plane is upright there is no mode.
#[test]
fn a_plane_of_elbows_past_upright_is_the_other_mode() {
    let delta = thesis();
    let upper = delta.with_assembly_mode(AssemblyMode::Upper);
    let (corner, far) = (
        Point3::new(-95.0, 185.0, -164.0),
        Point3::new(2.0, 257.0, 62.0),
    );
    assert!(matches!(
        delta.inverse(far),
        Err(InverseError::OtherAssembly { .. })
    ));
    let angles = upper.inverse(far).unwrap();
    assert!((upper.forward(angles).unwrap() - far).norm() < 1e-11);
    let lower = delta.forward(angles).unwrap();
    assert!(lower.z < far.z && (lower - far).norm() > 1.0);
    let line = PlatformPath::line(corner, far).unwrap();
    let refused = delta.follow(line, 0.1, limits()).unwrap_err();
    let FollowError::Singular { fraction, .. } = refused else {
        panic!("{refused:?}");
    };
    assert!(fraction > 0.0 && fraction < 1.0, "{fraction}");
    // To the place where the plane is upright, by bisection.
    let (mut inside, mut beyond) = (corner, far);
    while (beyond - inside).norm() > 1e-13 {
        let middle = middle_of(inside, beyond);
        match delta.inverse(middle) {
            Ok(_) => inside = middle,
            Err(InverseError::Upright) => {
                let angles = delta.pose_at(inside).unwrap().angles();
                assert!((delta.forward(angles).unwrap() - inside).norm() < 1e-9);
                return;
            }
            Err(_) => beyond = middle,
        }
        if middle == inside && middle == beyond {
            break;
        }
    }
    panic!("{inside} {beyond}");
}

fn middle_of(a: Point3<f64>, b: Point3<f64>) -> Point3<f64> {
    a + (b - a) * 0.5
}

#[test]
fn a_path_in_the_other_mode_is_refused() {
    let at = |x: f64, z: f64| Point3::new(x, 20.0, z);
    let above = PlatformPath::line(at(30.0, 300.0), at(-30.0, 300.0)).unwrap();
    match thesis().follow(above, 0.01, limits()) {
        Err(FollowError::Unreachable {
            fraction, reason, ..
        }) => {
            assert!(fraction == 0.0 && thesis().inverse(at(30.0, 300.0)) == Err(reason));
        }
        other => panic!("{other:?}"),
    }
}

/// A machine file that does not say that z points down: every point would be hundreds of
/// millimetres off, and the best fit nonsense.
#[test]
fn measurements_of_the_other_mode_are_refused() {
    let real = thesis().with_z(ZAxis::Down);
    let measured: Vec<Measured> = [(30.0, 250.0), (-60.0, 300.0), (10.0, 280.0)]
        .map(|(x, z)| {
            let point = Point3::new(x, 20.0, z);
            let angles = real.inverse(point).unwrap();
            Measured { angles, point }
        })
        .to_vec();
    let parameters = [Parameter::common(Quantity::Lower)];
    let refused = thesis().calibrate(parameters, &measured).unwrap_err();
    assert_eq!(
        refused,
        CalibrationError::OtherAssembly {
            index: 0,
            assembly_mode: AssemblyMode::Upper,
            z: Some(ZAxis::Down),
        }
    );
    assert!(
        refused
            .to_string()
            .starts_with("measured point 0: the point lies above the base plane")
    );
    let found = real.calibrate(parameters, &measured).unwrap();
    assert!(found.largest() < 1e-9);
    assert_eq!(found.machine().z(), ZAxis::Down);
}

/// The workspace is that of the modes named. Mirrored in the base plane, an elbow that was out
/// counts as in: it turns the other way.
#[test]
fn the_workspace_is_that_of_the_modes() {
    let above = Point3::new(0.0, 0.0, 250.0);
    let upper = thesis()
        .with_assembly_mode(AssemblyMode::Upper)
        .with_working_mode([ElbowSide::In; 3]);
    let (lower, upper) = (thesis(), upper);
    let mirrored = upper.largest_cylinder([230.0, 290.0], 1.0);
    assert_eq!(lower.largest_cylinder([-290.0, -230.0], 1.0), mirrored);
    assert!(!lower.is_reachable(above) && upper.is_reachable(above));
    assert!(lower.clearance(above) == 0.0 && upper.clearance(above) > 10.0);
    assert!(matches!(
        lower.horizontal_slice(250.0, 8),
        Err(WorkspaceError::Outside {
            reason: InverseError::OtherAssembly { .. },
            ..
        })
    ));
    let down = thesis().with_z(ZAxis::Down);
    let point = Point3::new(40.0, -30.0, -280.0);
    let mirrored = Point3::new(40.0, -30.0, 280.0);
    for same in [down, upper] {
        assert!(same.is_reachable(above));
        assert!((same.clearance(mirrored) - lower.clearance(point)).abs() < 1e-9);
    }
}

/// The working mode holds for everything that goes from points to angles, and limits with it.
#[test]
fn the_working_mode_is_asked_for_by_name() {
    let point = Point3::new(20.0, -10.0, -280.0);
    for elbows in [
        [ElbowSide::Out, ElbowSide::In, ElbowSide::Out],
        [ElbowSide::In, ElbowSide::In, ElbowSide::Out],
        [ElbowSide::In; 3],
    ] {
        let bent = thesis().with_working_mode(elbows);
        let [lower, upper] =
            [AssemblyMode::Lower, AssemblyMode::Upper].map(|mode| bent.with_assembly_mode(mode));
        let bent = if lower.inverse(point).is_ok() {
            lower
        } else {
            upper
        };
        let pose = bent.pose_at(point).unwrap();
        for (lever, elbow) in pose.levers().iter().zip(elbows) {
            assert_eq!(*lever > 0.0, elbow == ElbowSide::In);
        }
        assert!((bent.forward(pose.angles()).unwrap() - point).norm() < 1e-11);
        assert_eq!(bent.working_mode(), elbows);
        // Inward angles have the other sign, and the same elbows.
        let inward = bent.with_positive(Positive::Inward);
        assert!((inward.inverse(point).unwrap() + pose.angles()).amax() < 1e-15);
        // A range that holds the angles holds the ball of the clearance.
        let [low, high] = [pose.angles().min() - 0.05, pose.angles().max() + 0.05];
        let ranged = bent.with_range(ArmRange::new(low, high).unwrap());
        let clearance = ranged.clearance(point);
        assert!(clearance > 0.5, "{clearance}");
        for k in 0..100 {
            let (sin, cos) = (f64::from(k) * 2.4).sin_cos();
            let up = f64::from(k) / 50.0 - 1.0;
            let flat = (1.0 - up * up).sqrt();
            let out = Vector3::new(flat * cos, flat * sin, up) * (clearance * 0.999);
            assert!(ranged.is_reachable(point + out), "{elbows:?}");
        }
    }
}

/// An end of a range that is the arm's angle with the elbow on the other side is no rounding of the
/// angle in its working mode.
#[test]
fn the_other_elbow_s_angle_is_no_end_of_a_range() {
    let delta = Delta::new(Dimensions {
        base: 0.42,
        platform: 0.18,
        upper: 1.2,
        lower: 2.43,
    })
    .unwrap()
    .with_assembly_mode(AssemblyMode::Upper);
    let point = Point3::new(0.05, -0.04, 1.27);
    let out = delta.inverse(point).unwrap();
    let inner = delta
        .with_working_mode([ElbowSide::In; 3])
        .inverse(point)
        .unwrap();
    for (arm, angle) in out.iter().copied().enumerate() {
        assert!(f64::abs(angle - inner[arm]) < FRAC_PI_2);
        let mut ranges = [ArmRange::unlimited(); 3];
        ranges[arm] = ArmRange::new(inner[arm], inner[arm] + 1.0).unwrap();
        let [min, max] = [ranges[arm].min(), ranges[arm].max()];
        let refused = InverseError::JointLimit {
            arm: Arm::ALL[arm],
            angle,
            min,
            max,
        };
        assert_eq!(delta.with_ranges(ranges).inverse(point), Err(refused));
        ranges[arm] = ArmRange::new(angle, inner[arm]).unwrap();
        assert_eq!(delta.with_ranges(ranges).inverse(point), Ok(out));
    }
}
