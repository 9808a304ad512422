//! Tables along paths, a stream of paths.

use core::convert::Infallible;
use core::hint::black_box;

use path_timing::{
    Accuracy, AxisLimits, Cia402Scale, Curve, FeedCeiling, Knot, LookAhead, Mode, PathFn,
    PathPoint, Row, SetPoints, Shaped, Shaper, Smoothed, Table, TorqueCurve, TorqueLimits, Vertex,
    segments_within,
};

use scara_kin::{Arm, ArmMasses, Elbow, JointDrive, LinkMass};

use super::{CLOSE_MM, holds};

/// A straight way of two axes as a trapezoid, and the same under a feed of a half.
pub fn table() -> Option<()> {
    let straight = |s: f64| {
        Ok::<_, Infallible>(PathPoint {
            position: [s, 0.5 * s],
            slope: [1.0, 0.5],
        })
    };
    let limits = AxisLimits {
        speed: black_box(10.0),
        acceleration: 20.0,
        jerk: None,
    };
    let path = PathFn::new(black_box(100.0), straight);
    let mut knots = [Knot::default(); 65];
    let table = Table::plan([&path], [limits; 2], |_| 64, &mut knots).ok()?;
    // 100 mm at 10 mm/s, and half a second for the ramps.
    holds((10.5..10.6).contains(&table.duration_s()))?;
    let last = table.rows().last()?;
    holds(last.position == [100.0, 50.0] && last.velocity == [0.0; 2])?;
    let mut ceilings = [FeedCeiling::default(); 65];
    let mut playback = table.playback(1.0, &mut ceilings).ok()?;
    playback.set_feed(0.5).ok()?;
    let last = playback.last()?;
    holds((last.time_s - 2.0 * table.duration_s()).abs() < CLOSE_MM)
}

/// Of a machine's axes, in mm and s.
const AXIS: AxisLimits = AxisLimits {
    speed: 50.0,
    acceleration: 500.0,
    jerk: None,
};
/// Allowed departures from a curve, in mm.
const ALLOWED_MM: f64 = 0.01;

/// A Bézier curve within a hundredth of a millimetre, and its bound.
pub fn curve() -> Option<()> {
    let limits = black_box([AXIS; 2]);
    let curve = Curve::bezier([[0.0, 0.0], [10.0, 0.0], [20.0, 10.0], [20.0, 20.0]]).ok()?;
    let mut knots = [Knot::default(); 65];
    let bound = Curve::departure;
    let accuracy = Accuracy {
        min_segments: 4,
        max_departure: ALLOWED_MM,
        max_time_ratio: f64::INFINITY,
    };
    let table = Table::plan_within([curve], limits, accuracy, bound, &mut knots).ok()?;
    let departures = table.spans().map(|span| curve.departure(&span));
    let departure = departures.fold(0.0, f64::max);
    holds(departure > 0.0 && departure <= ALLOWED_MM)?;
    let last = table.rows().last()?;
    holds(last.position == [20.0, 20.0] && last.velocity == [0.0; 2])
}

/// Two sides of a square with a rounded corner in a window, held on the way.
pub fn stream() -> Option<()> {
    let limits = black_box([AXIS; 2]);
    let corners = [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0]];
    let mut vertices = [Vertex::default(); 6];
    let curves = Smoothed::new(corners, ALLOWED_MM, &mut vertices).ok()?;
    let segments = |curve: &Curve<2>| segments_within(curve, 4, ALLOWED_MM, Curve::departure);
    let mut window = [Knot::default(); 16];
    let curves = curves.map_while(Result::ok);
    let mut motion = LookAhead::new(curves, limits, segments, &mut window).ok()?;
    for _ in 0..6 {
        motion.next_row().ok()??;
    }
    motion.stop();
    let held = motion.by_ref().last()?.ok()?;
    holds(held.velocity == [0.0; 2] && held.position != [20.0, 20.0])?;
    motion.set_feed(1.0).ok()?;
    let last = motion.last()?.ok()?;
    holds(last.velocity == [0.0; 2] && last.position == [20.0, 20.0])
}

/// A line whose axes are shaped for a mode each: it ends where it would, one delay later.
pub fn shaped() -> Option<()> {
    let line = Curve::line([0.0, 0.0], [20.0, 10.0]).ok()?;
    let mut knots = [Knot::default(); 33];
    let table = Table::plan([line], black_box([AXIS; 2]), |_| 32, &mut knots).ok()?;
    let mode = |hz| Mode { hz, damping: 0.05 };
    let shapers = [
        Shaper::ei(mode(40.0)).ok()?,
        Shaper::two_hump(mode(90.0)).ok()?,
    ];
    holds(
        shapers
            .iter()
            .zip([40.0, 90.0])
            .all(|(shaper, hz)| shaper.residual(mode(hz)) < 0.05),
    )?;
    let mut memory = [Row::default(); 40];
    let mut rows = Shaped::new(table.rows(), shapers, &mut memory);
    let last = rows.by_ref().last()?.ok()?;
    holds(last.position == [20.0, 10.0] && last.velocity == [0.0; 2])?;
    let late_s = last.time_s - table.duration_s();
    holds((late_s - rows.longest_delay_s()).abs() < CLOSE_S)
}

/// A line of an arm within the torque of its motors: none is asked for more than it has, one for
/// nearly all of it.
pub fn torque() -> Option<()> {
    let link = LinkMass {
        mass_kg: 2.5,
        centre_m: 0.14,
        inertia_kg_m2: 0.03,
    };
    let drive = JointDrive {
        rotor_kg_m2: 0.08,
        viscous_nm_s: 0.3,
        coulomb_nm: 0.8,
    };
    let arm = Arm::new(black_box(300.0), 300.0).ok()?;
    let masses = ArmMasses {
        upper: link,
        fore: link,
        payload_kg: 1.0,
        shoulder: drive,
        elbow: drive,
        gravity_m_s2: 0.0,
    };
    let motor = |torque| TorqueCurve::holding(torque, 3.0, 30.0);
    let limits = TorqueLimits {
        dynamics: arm.dynamics(1e-3, masses).ok()?,
        motors: [motor(30.0).ok()?, motor(12.0).ok()?],
    };
    let line = Curve::line([-200.0, 300.0], [250.0, 300.0]).ok()?;
    let path = arm.path(line, Elbow::Right).ok()?;
    let joint = AxisLimits {
        speed: 30.0,
        acceleration: 1000.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 65];
    let table = limits.plan([path], [joint; 2], |_| 64, &mut knots).ok()?;
    let used = table.spans().map(|span| limits.utilisation(&span));
    let most = used.fold(0.0, f64::max);
    holds(most <= 1.0 && most > 0.99)
}

/// A line as a servo drive takes it: each millisecond, to the last increment.
pub fn set_points() -> Option<()> {
    let line = Curve::line([0.0, 0.0], [20.0, 10.0]).ok()?;
    let mut knots = [Knot::default(); 33];
    let table = Table::plan([line], black_box([AXIS; 2]), |_| 32, &mut knots).ok()?;
    let scale = Cia402Scale {
        counts_per_unit: black_box(-13_107.2),
        rated_torque: 1.0,
    };
    let last = SetPoints::new(table.rows(), 0.001).last()?.ok()?;
    let x = scale.target(last.position[0], last.velocity[0], 0.2).ok()?;
    holds(x.position == -262_144 && x.velocity_offset == 0 && x.torque_offset == 200)?;
    holds(scale.target(1e6, 0.0, 0.0).is_err())
}

/// Of times, in s.
const CLOSE_S: f64 = 1e-9;
