//! The workspace: clearances, solids, outlines; and paths that are refused.

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    ArmRange, Delta, Dimensions, FollowError, InverseError, PlatformPath, PlatformPathError,
    SpeedLimits, WorkspaceError,
};

use crate::common::thesis::thesis;

fn limited() -> Delta {
    thesis()
        .with_range(ArmRange::new(-0.3, 2.0).unwrap())
        .with_ball_joints(0.6)
        .unwrap()
}

/// Directions spread over a sphere.
fn directions() -> impl Iterator<Item = Vector3<f64>> {
    (0..60).map(|k| {
        let up = (f64::from(k) + 0.5) / 30.0 - 1.0;
        let (sin, cos) = (f64::from(k) * 2.4).sin_cos();
        let flat = (1.0 - up * up).sqrt();
        Vector3::new(flat * cos, flat * sin, up)
    })
}

#[test]
fn the_ball_of_a_clearance_is_reached() {
    let stiff = thesis().with_ball_joints(0.3).unwrap();
    for delta in [thesis(), limited(), stiff] {
        let mut seen = 0;
        for k in 0..400u32 {
            let (sin, cos) = (f64::from(k) * 2.4).sin_cos();
            let radius = 9.0 * f64::from(k).sqrt();
            let z = -140.0 - f64::from(k * 37 % 230);
            let point = Point3::new(radius * cos, radius * sin, z);
            let clearance = delta.clearance(point);
            assert_eq!(clearance > 0.0, delta.is_reachable(point));
            let hangs = delta.inverse(point).is_ok_and(|angles| {
                let lower = delta.forward(angles).unwrap();
                (lower - point).norm() < 1e-9
            });
            assert_eq!(hangs, delta.is_reachable(point), "{point}");
            seen += u32::from(clearance > 1.0);
            for direction in directions() {
                let inside = point + direction * (clearance * 0.999);
                assert!(clearance == 0.0 || delta.is_reachable(inside), "{inside}");
            }
        }
        assert!(seen > 50, "{seen}");
    }
}

#[test]
fn solids_are_as_large_as_may_be() {
    let heights = [-290.0, -230.0];
    for delta in [thesis(), limited()] {
        let resolution = 0.25;
        let radius = delta.largest_cylinder(heights, resolution).unwrap();
        let leaves = |radius: f64| {
            (0..720).any(|k| {
                let (sin, cos) = (f64::from(k) * 0.5f64.to_radians()).sin_cos();
                heights
                    .iter()
                    .any(|z| !delta.is_reachable(Point3::new(radius * cos, radius * sin, *z)))
            })
        };
        assert!(!leaves(radius));
        assert!(leaves(radius + 4.0 * resolution), "{radius}");
    }
    let delta = thesis();
    assert_eq!(
        delta.largest_cylinder([-400.0, -380.0], 1.0),
        Err(WorkspaceError::NoCylinder { resolution: 1.0 })
    );
    for z in [f64::NAN, f64::NEG_INFINITY, -500.0] {
        assert!(matches!(
            delta.largest_cylinder([z, -380.0], 1.0),
            Err(WorkspaceError::Height { .. })
        ));
    }
    for resolution in [f64::NAN, 0.0, -1.0, 0.1, 500.0] {
        assert!(matches!(
            delta.largest_cylinder([-290.0, -230.0], resolution),
            Err(WorkspaceError::Resolution { .. })
        ));
    }
}

#[test]
fn outlines_are_on_the_edge() {
    let near = 1e-6 * thesis().span();
    for delta in [thesis(), limited()] {
        let edge = |point: Point3<f64>| {
            let out = (point - Point3::new(0.0, 0.0, -260.0)).normalize();
            // The ray may meet the edge at a flat angle.
            let is_near = delta.clearance(point) <= near;
            delta.is_reachable(point)
                && (is_near || !delta.is_reachable(point + out * (3.0 * near)))
        };
        let flat = delta.horizontal_slice(-260.0, 90).unwrap();
        assert_eq!(flat.len(), 90);
        let flat: Vec<_> = flat.collect();
        let upright: Vec<_> = delta.vertical_slice(0.5, -260.0, 90).unwrap().collect();
        assert_eq!((flat.len(), upright.len()), (90, 90));
        for (k, (flat, upright)) in (0..90).zip(flat.into_iter().zip(upright)) {
            // Where the rays of 4 degrees to one another lead.
            let (up, along) = (f64::from(k) * 4.0).to_radians().sin_cos();
            let off_ray = (flat - Point3::new(0.0, 0.0, -260.0))
                .cross(&Vector3::new(along, up, 0.0))
                .norm();
            assert!(off_ray < 1e-9 && flat.x * along + flat.y * up > 0.0, "{k}");
            assert!(edge(flat), "{k}");
            let across = Vector3::new(along * 0.5f64.cos(), along * 0.5f64.sin(), up);
            let way = upright - Point3::new(0.0, 0.0, -260.0);
            assert!(
                way.cross(&across).norm() < 1e-9 && way.dot(&across) > 0.0,
                "{k}"
            );
            assert!(edge(upright), "{upright}");
        }
        assert!(matches!(
            delta.horizontal_slice(-500.0, 90),
            Err(WorkspaceError::Outside { .. })
        ));
        assert!(matches!(
            delta.vertical_slice(f64::NAN, -260.0, 90),
            Err(WorkspaceError::Azimuth { .. })
        ));
    }
}

fn limits() -> SpeedLimits {
    SpeedLimits::new(100.0, [5.0; 3]).unwrap()
}

#[test]
fn paths_are_where_they_were_asked() {
    let (from, to) = (Point3::new(1.0, -2.0, 3.0), Point3::new(9.0, 6.0, -13.0));
    let line = PlatformPath::line(from, to).unwrap();
    for share in [0.0, 0.125, 0.375, 0.5, 0.625, 0.75, 1.0] {
        assert_eq!(line.point_at(share).unwrap(), from + (to - from) * share);
    }
    assert!((line.length() - 384f64.sqrt()).abs() < 1e-14);
    // A quarter from X over -Y: clockwise from above.
    let arc = PlatformPath::arc(from, from - Vector3::x() * 5.0, Vector3::z() * 2.0, -1.5).unwrap();
    for share in [0.0, 0.3, 0.8, 1.0_f64] {
        let (sin, cos) = (-1.5 * share).sin_cos();
        let wanted = Point3::new(-4.0 + 5.0 * cos, -2.0 + 5.0 * sin, 3.0);
        assert!((arc.point_at(share).unwrap() - wanted).norm() < 1e-14);
    }
    assert!((arc.length() - 7.5).abs() < 1e-14);
    for outside in [f64::NAN, -1e-300, 1.0 + f64::EPSILON, f64::INFINITY] {
        assert_eq!(line.point_at(outside), None);
    }
}

#[test]
fn paths_end_at_the_first_place_out_of_reach() {
    let line = PlatformPath::line(
        Point3::new(0.0, 0.0, -300.0),
        Point3::new(400.0, 0.0, -300.0),
    );
    match thesis().follow(line.unwrap(), 0.01, limits()) {
        Err(FollowError::Unreachable {
            fraction,
            point,
            reason: InverseError::TooFar { .. },
        }) => {
            let before = Point3::new(400.0 * (fraction - 1e-6), 0.0, -300.0);
            assert!(thesis().inverse(point).is_err() && thesis().inverse(before).is_ok());
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_path_through_a_singularity_is_refused() {
    // Rods level with the platform at z = 0, where the two assemblies meet.
    let flat = Delta::new(Dimensions {
        base: 60.0,
        platform: 20.0,
        upper: 120.0,
        lower: 159.0,
    })
    .unwrap();
    let line =
        PlatformPath::line(Point3::new(0.0, 0.0, -30.0), Point3::new(0.0, 0.0, 30.0)).unwrap();
    assert!(matches!(
        flat.follow(line, 0.01, limits()),
        Err(FollowError::Singular { .. } | FollowError::Unreachable { .. })
    ));
}

#[test]
fn paths_and_paces_are_checked() {
    let (a, b) = (
        Point3::new(10.0, 0.0, -250.0),
        Point3::new(0.0, 0.0, -250.0),
    );
    let nan = Point3::new(f64::NAN, 0.0, 0.0);
    let out_of_range = |path: Result<PlatformPath, PlatformPathError>, name: &str| {
        assert!(
            matches!(path, Err(PlatformPathError::OutOfRange { name: given, .. }) if given == name)
        );
    };
    out_of_range(PlatformPath::line(a, nan), "coordinate");
    out_of_range(
        PlatformPath::line(a, Point3::new(1e80, 0.0, 0.0)),
        "coordinate",
    );
    out_of_range(PlatformPath::arc(a, nan, Vector3::z(), 1.0), "coordinate");
    out_of_range(PlatformPath::arc(a, b, nan.coords, 1.0), "axis component");
    out_of_range(PlatformPath::arc(a, b, Vector3::z(), f64::NAN), "angle");
    out_of_range(PlatformPath::arc(a, b, Vector3::z(), 1e9), "angle");
    assert_eq!(
        PlatformPath::arc(a, a, Vector3::z(), 1.0),
        Err(PlatformPathError::NoRadius)
    );
    assert_eq!(
        PlatformPath::arc(a, b, Vector3::zeros(), 1.0),
        Err(PlatformPathError::NoAxis)
    );
    assert!(matches!(
        PlatformPath::arc(a, b, Vector3::x(), 1.0),
        Err(PlatformPathError::Helix { .. })
    ));
    // Squares that are below the least number.
    let tiny = PlatformPath::arc(a * 1e-200, Point3::origin(), Vector3::x() * 1e-200, 1.0);
    assert!(matches!(tiny, Err(PlatformPathError::Helix { .. })));
    let tiny = PlatformPath::arc(
        Point3::new(1e-200, 0.0, 0.0),
        Point3::origin(),
        Vector3::z() * 1e-200,
        2.0,
    );
    let length: f64 = tiny.unwrap().length();
    assert!((length - 2e-200).abs() < 1e-214);
    for (feed, rate) in [
        (0.0, 1.0),
        (1.0, -1.0),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
    ] {
        assert!(matches!(
            SpeedLimits::new(feed, [rate; 3]),
            Err(FollowError::SpeedLimits { .. })
        ));
    }
    let line = PlatformPath::line(a, b).unwrap();
    for tolerance in [0.0, -1.0, f64::NAN, 64.0 * thesis().tolerance()] {
        assert!(matches!(
            thesis().follow(line, tolerance, limits()),
            Err(FollowError::Tolerance { .. })
        ));
    }
    // A path without length has one waypoint.
    let still = PlatformPath::line(a, a).unwrap();
    assert_eq!(thesis().follow(still, 0.01, limits()).unwrap().count(), 1);
}
