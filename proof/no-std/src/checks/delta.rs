//! A rotary Delta.

use core::hint::black_box;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{
    Delta, DeltaPath, Dimensions, Measured, Parameter, PlatformPath, Quantity, SpeedLimits,
};
use path_timing::{Accuracy, AxisLimits, Knot, Table};

use super::{CLOSE_MM, holds};
fn thesis() -> Option<Delta> {
    Delta::new(Dimensions {
        base: black_box(42.0),
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .ok()
}

/// Inverse and forward kinematics of a Delta, rates, a line, a cylinder.
pub fn delta() -> Option<()> {
    let delta = thesis()?;
    let point = Point3::new(black_box(50.0), 50.0, -300.0);
    let pose = delta.pose_at(point).ok()?;
    holds((delta.forward(pose.angles()).ok()? - point).norm() < CLOSE_MM)?;
    let velocity = Vector3::new(black_box(10.0), -3.0, 1.0);
    let rates = pose.joint_rates(velocity).ok()?;
    holds((pose.platform_velocity(rates).ok()? - velocity).norm() < CLOSE_MM)?;
    holds(
        delta
            .inverse(Point3::new(50.0, 50.0, black_box(100.0)))
            .is_err(),
    )?;
    let line = PlatformPath::line(point, Point3::new(-50.0, 50.0, -300.0)).ok()?;
    let speed_limits = SpeedLimits::new(200.0, [3.0; 3]).ok()?;
    let last = delta.follow(line, 0.01, speed_limits).ok()?.last()?;
    holds((last.point - line.point_at(1.0)?).norm() < CLOSE_MM)?;
    let radius = delta.largest_cylinder([-290.0, black_box(-260.0)], 2.0);
    holds(radius.ok()? > 60.0)?;
    holds(
        delta
            .horizontal_slice(-260.0, 8)
            .ok()?
            .all(|edge| delta.is_reachable(edge)),
    )
}

/// A lower arm that is longer than drawn.
pub fn calibration() -> Option<()> {
    let drawn = thesis()?;
    let mut arms = *drawn.arms();
    arms[1].lower += black_box(0.5);
    let real = drawn.with_arms(arms).ok()?;
    let mut measured = [Measured {
        angles: Vector3::zeros(),
        point: Point3::origin(),
    }; 5];
    for (place, z) in measured
        .iter_mut()
        .zip([-300.0, -290.0, -270.0, -260.0, -240.0])
    {
        place.point = Point3::new(z + 270.0, 20.0, z);
        place.angles = real.inverse(place.point).ok()?;
    }
    let longer = Parameter::of(Quantity::Lower, delta_kin::Arm::Second);
    let found = drawn.calibrate([longer], &measured).ok()?;
    holds((found.changes()[0] - 0.5).abs() < CLOSE_MM && found.rank() == 1)
}

/// A pick and place, timed within 0.05 mm.
pub fn path() -> Option<()> {
    let delta = thesis()?;
    let (from, to) = ([black_box(30.0), 0.0, -290.0], [-30.0, 10.0, -290.0]);
    let paths = delta.pick_and_place(from, to, -270.0, 5.0, None).ok()?;
    let arm = AxisLimits {
        speed: 3.0,
        acceleration: 30.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 257];
    let departure = DeltaPath::departure;
    let accuracy = Accuracy {
        min_segments: 4,
        max_departure: 0.05,
        max_time_ratio: f64::INFINITY,
    };
    let table = Table::plan_within(paths, [arm; 3], accuracy, departure, &mut knots).ok()?;
    for span in table.spans() {
        let [_, to] = &span.rows;
        holds(paths.get(to.leg)?.departure(&span) <= 0.05)?;
    }
    let angles = Vector3::from(table.rows().last()?.position);
    holds((delta.forward(angles).ok()? - Point3::from(to)).norm() < CLOSE_MM)
}
