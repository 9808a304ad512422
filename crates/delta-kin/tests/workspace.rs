//! The workspace: clearances, solids, outlines; and paths that are refused.
#![cfg(test)]

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Delta, FollowError, InverseError, JointRange, Pace, Path, PathError, Workspace, ZAxis,
};

fn delta() -> Delta {
    Delta::new(42.0, 18.0, 120.0, 243.0).unwrap()
}

fn limited() -> Delta {
    delta()
        .with_range(JointRange::new(-0.3, 2.0).unwrap())
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
    let stiff = delta().with_ball_joints(0.3).unwrap();
    for delta in [delta(), limited(), stiff] {
        let workspace = delta.workspace();
        let mut seen = 0;
        for k in 0..400u32 {
            let (sin, cos) = (f64::from(k) * 2.4).sin_cos();
            let radius = 9.0 * f64::from(k).sqrt();
            let z = -140.0 - f64::from(k * 37 % 230);
            let point = Point3::new(radius * cos, radius * sin, z);
            let clearance = workspace.clearance(point);
            assert_eq!(clearance > 0.0, workspace.contains(point));
            let hangs = delta.inverse(point).is_ok_and(|angles| {
                let lower = delta.forward(angles).unwrap();
                (lower - point).norm() < 1e-9
            });
            assert_eq!(hangs, workspace.contains(point), "{point}");
            seen += u32::from(clearance > 1.0);
            for direction in directions() {
                let inside = point + direction * (clearance * 0.999);
                assert!(
                    clearance == 0.0 || delta.inverse(inside).is_ok(),
                    "{inside}"
                );
            }
        }
        assert!(seen > 50, "{seen}");
    }
}

#[test]
fn solids_are_as_large_as_may_be() {
    let heights = [-290.0, -230.0];
    for workspace in [delta().workspace(), limited().workspace()] {
        let resolution = 0.25;
        let radius = workspace.largest_cylinder(heights, resolution).unwrap();
        let half_side = workspace.largest_box(heights, resolution).unwrap();
        assert!(half_side < radius && half_side * 2f64.sqrt() > radius * 0.9);
        let leaves = |radius: f64| {
            (0..720).any(|k| {
                let (sin, cos) = (f64::from(k) * 0.5f64.to_radians()).sin_cos();
                heights
                    .iter()
                    .any(|z| !workspace.contains(Point3::new(radius * cos, radius * sin, *z)))
            })
        };
        assert!(!leaves(radius));
        assert!(leaves(radius + 4.0 * resolution), "{radius}");
        assert!(workspace.covers_cylinder(radius, heights, resolution));
        assert!(workspace.covers_box(half_side, heights, resolution));
        assert!(!workspace.covers_box(radius, heights, resolution));
    }
    assert_eq!(delta().workspace().largest_box([-400.0, -380.0], 1.0), None);
    assert_eq!(
        delta().workspace().largest_box([f64::NAN, -380.0], 1.0),
        None
    );
}

#[test]
fn outlines_are_on_the_edge() {
    let near = 1e-6 * delta().span();
    for workspace in [delta().workspace(), limited().workspace()] {
        let edge = |point: Point3<f64>| {
            let out = (point - Point3::new(0.0, 0.0, -260.0)).normalize();
            // The ray may meet the edge at a flat angle.
            let is_near = workspace.clearance(point) <= near;
            workspace.contains(point)
                && (is_near || !workspace.contains(point + out * (3.0 * near)))
        };
        let flat = workspace.horizontal_slice(-260.0, 90);
        assert_eq!(flat.len(), 90);
        let flat: Vec<_> = flat.collect();
        let upright: Vec<_> = workspace.vertical_slice(0.5, -260.0, 90).collect();
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
        assert_eq!(workspace.horizontal_slice(-500.0, 90).count(), 0);
    }
}

/// Just inside the edge it is the arm that fails just outside.
#[test]
fn the_tightest_arm_is_the_first_to_fail() {
    let near = 1e-6 * delta().span();
    for delta in [delta(), limited()] {
        let workspace = delta.workspace();
        let outline = workspace.horizontal_slice(-260.0, 90);
        let named = outline.filter(|point| {
            let outside = point + point.coords.xy().normalize().to_homogeneous() * (2.0 * near);
            let arm = match delta.inverse(outside) {
                Err(
                    InverseError::TooFar { arm, .. }
                    | InverseError::TooNear { arm, .. }
                    | InverseError::BallJoint { arm, .. }
                    | InverseError::JointLimit { arm, .. },
                ) => arm,
                other => panic!("{other:?}"),
            };
            workspace.tightest_arm(*point) == arm
        });
        // Two may fail at once in the corners.
        assert!(named.count() >= 84);
    }
}

/// Above the knees there are angles, but not in the assembly in which the machine hangs.
#[test]
fn the_upper_assembly_is_not_in_the_workspace() {
    let above = Point3::new(0.0, 0.0, 250.0);
    assert!(delta().inverse(above).is_ok());
    assert!(!delta().workspace().contains(above));
    let down = delta().with_z(ZAxis::Down).workspace();
    assert!(down.contains(above));
    let same = |a: Workspace, b: Workspace| {
        let point = Point3::new(40.0, -30.0, 280.0);
        let mirrored = Point3::new(40.0, -30.0, -280.0);
        assert!((a.clearance(point) - b.clearance(mirrored)).abs() < 1e-9);
        assert_eq!(a.tightest_arm(point), b.tightest_arm(mirrored));
    };
    same(down, delta().workspace());
}

fn pace() -> Pace {
    Pace::new(100.0, [5.0; 3]).unwrap()
}

#[test]
fn paths_are_where_they_were_asked() {
    let (from, to) = (Point3::new(1.0, -2.0, 3.0), Point3::new(9.0, 6.0, -13.0));
    let line = Path::line(from, to).unwrap();
    for share in [0.0, 0.125, 0.375, 0.5, 0.625, 0.75, 1.0] {
        assert_eq!(line.point_at(share), from + (to - from) * share);
    }
    assert!((line.length() - 384f64.sqrt()).abs() < 1e-14);
    // A quarter from X over -Y: clockwise from above.
    let arc = Path::arc(from, from - Vector3::x() * 5.0, Vector3::z() * 2.0, -1.5).unwrap();
    for share in [0.0, 0.3, 0.8, 1.0_f64] {
        let (sin, cos) = (-1.5 * share).sin_cos();
        let wanted = Point3::new(-4.0 + 5.0 * cos, -2.0 + 5.0 * sin, 3.0);
        assert!((arc.point_at(share) - wanted).norm() < 1e-14);
    }
    assert!((arc.length() - 7.5).abs() < 1e-14);
}

#[test]
fn paths_end_at_the_first_place_out_of_reach() {
    let line = Path::line(
        Point3::new(0.0, 0.0, -300.0),
        Point3::new(400.0, 0.0, -300.0),
    );
    match delta().follow(line.unwrap(), 0.01, pace()) {
        Err(FollowError::Unreachable {
            fraction,
            point,
            reason: InverseError::TooFar { .. },
        }) => {
            let before = Point3::new(400.0 * (fraction - 1e-6), 0.0, -300.0);
            assert!(delta().inverse(point).is_err() && delta().inverse(before).is_ok());
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_path_through_a_singularity_is_refused() {
    // Rods level with the platform at z = 0, where the two assemblies meet.
    let flat = Delta::new(60.0, 20.0, 120.0, 159.0).unwrap();
    let line = Path::line(Point3::new(0.0, 0.0, -30.0), Point3::new(0.0, 0.0, 30.0)).unwrap();
    assert!(matches!(
        flat.follow(line, 0.01, pace()),
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
    assert_eq!(Path::line(a, nan), Err(PathError::NotFinite));
    assert_eq!(Path::arc(a, a, Vector3::z(), 1.0), Err(PathError::NoRadius));
    assert_eq!(
        Path::arc(a, b, Vector3::zeros(), 1.0),
        Err(PathError::NoRadius)
    );
    assert_eq!(Path::arc(a, b, Vector3::x(), 1.0), Err(PathError::Helix));
    assert_eq!(
        Path::arc(a, b, Vector3::z(), f64::NAN),
        Err(PathError::NotFinite)
    );
    for (feed, rate) in [
        (0.0, 1.0),
        (1.0, -1.0),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
    ] {
        assert!(matches!(
            Pace::new(feed, [rate; 3]),
            Err(FollowError::Pace { .. })
        ));
    }
    let line = Path::line(a, b).unwrap();
    for tolerance in [0.0, -1.0, f64::NAN, delta().tolerance()] {
        assert!(matches!(
            delta().follow(line, tolerance, pace()),
            Err(FollowError::Tolerance { .. })
        ));
    }
    // A path without length has one waypoint.
    let still = Path::line(a, a).unwrap();
    assert_eq!(delta().follow(still, 0.01, pace()).unwrap().count(), 1);
}
