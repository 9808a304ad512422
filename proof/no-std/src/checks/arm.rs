//! A two-link arm.

use core::hint::black_box;

use path_timing::{Accuracy, AxisLimits, Curve, Knot, Table};
use scara_kin::nalgebra::{Point2, Vector2};
use scara_kin::{
    Arm, DiscPath, DriveAngles, DrivenArm, Drives, Elbow, Joints, Measured, Parameter,
};

use super::{CLOSE_MM, holds};
/// Inverse and forward kinematics, rates.
pub fn inverse() -> Option<()> {
    let arm = Arm::new(black_box(132.0), 132.0).ok()?;
    let point = Point2::new(black_box(150.0), 80.0);
    let solutions = arm.inverse(point).ok()?;
    for (_, joints) in solutions.iter() {
        holds((arm.forward(joints) - point).norm() < CLOSE_MM)?;
        let velocity = Vector2::new(black_box(10.0), -3.0);
        let rates = arm.joint_rates(joints, velocity).ok()?;
        holds((arm.tool_velocity(joints, rates) - velocity).norm() < CLOSE_MM)?;
    }
    holds(arm.inverse(Point2::new(black_box(264.5), 0.0)).is_err())
}

/// A line of 160 mm within 0.01 mm.
pub fn follow() -> Option<()> {
    let arm = Arm::new(black_box(132.0), 132.0).ok()?;
    let line = [
        Point2::new(-80.0, 100.0),
        Point2::new(80.0, black_box(100.0)),
    ];
    let waypoints = arm.follow(line, Elbow::Right, 0.01).ok()?;
    let mut last: Option<Joints> = None;
    for waypoint in waypoints {
        if let Some(from) = last {
            holds(arm.chord_bound(from, waypoint.joints) <= 0.01)?;
        }
        last = Some(waypoint.joints);
    }
    holds((arm.forward(last?) - line[1]).norm() < CLOSE_MM)
}

/// An arc with a disc along it, timed within 0.01 mm.
pub fn path() -> Option<()> {
    let arm = Arm::new(black_box(132.0), 132.0).ok()?;
    let arc = Curve::arc([60.0, 120.0], [0.0, 120.0], [0.0, 1.0], black_box(1.0)).ok()?;
    let path = arm.path(arc, Elbow::Right).ok()?.with_disc(0.0).ok()?;
    let joint = AxisLimits {
        speed: 3.0,
        acceleration: 30.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 129];
    let departure = DiscPath::departure;
    let accuracy = Accuracy {
        min_segments: 4,
        max_departure: 0.01,
        max_time_ratio: f64::INFINITY,
    };
    let table = Table::plan_within([path], [joint; 3], accuracy, departure, &mut knots).ok()?;
    holds(table.spans().all(|span| path.departure(&span) <= 0.01))?;
    let [shoulder, elbow, _] = table.rows().last()?.position;
    let tool = arm.forward(Joints::new(shoulder, elbow));
    holds((tool - Point2::from(arc.end())).norm() < CLOSE_MM)
}

/// A forearm that is longer than drawn, and an elbow that stands elsewhere.
pub fn calibration() -> Option<()> {
    let drawn = DrivenArm {
        arm: Arm::new(black_box(132.0), 132.0).ok()?,
        drives: Drives::default(),
    };
    let real = DrivenArm {
        arm: Arm::new(132.0, black_box(132.5)).ok()?,
        drives: Drives::default().with_zero(Joints::new(0.0, 0.01)).ok()?,
    };
    let measured = [0.5, 0.9, 1.4, -1.0, -2.0].map(|elbow| {
        let drives = DriveAngles {
            shoulder: black_box(elbow) / 2.0,
            elbow,
        };
        let point = real.forward(drives);
        Measured { drives, point }
    });
    let found = drawn
        .calibrate([Parameter::Fore, Parameter::ElbowZero], &measured)
        .ok()?;
    let [fore, zero] = *found.changes();
    holds((fore - 0.5).abs() < CLOSE_MM && (zero - 0.01).abs() < CLOSE_MM)
}
