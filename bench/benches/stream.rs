//! What planning takes of real time: 10,000 points streamed along circles by an arm and a Delta.
//!
//! Points of a circle of 40 mm with three decimals at 200 mm/s, smoothed within 0.01 mm; the path
//! of each curve, looked at whole; as many segments as keep the joints' proven departure within
//! 0.01 mm at any speeds; look-ahead and rows. Printed is the time of the fastest of some rounds
//! over that of the motion.

use core::hint::black_box;
use std::time::Instant;

use delta_kin::{Delta, DeltaPath};
use path_timing::{
    AxisLimits, Curve, Knot, LookAhead, Path, Row, Smoothed, ToolLimits, Vertex, Waypoint,
    segments_within,
};
use scara_kin::{Arm, ArmPath, Elbow, Joints};

const POINTS: u32 = 10_000;
const ROUNDS: u32 = 5;
const RADIUS_MM: f64 = 40.0;
const TOLERANCE_MM: f64 = 0.01;
const TOOL: ToolLimits = ToolLimits {
    feed: 200.0,
    acceleration: Some(3000.0),
};

/// Of a joint, in rad and s.
const JOINT: AxisLimits = AxisLimits {
    speed: 6.0,
    acceleration: 100.0,
    jerk: None,
};

/// So far apart, round a centre.
fn points<const D: usize>(step_mm: f64, centre: [f64; D]) -> Vec<[f64; D]> {
    let point = |n| {
        let (sin, cos) = (f64::from(n) * step_mm / RADIUS_MM).sin_cos();
        let mut point = centre;
        for (value, unit) in point.iter_mut().zip([cos, sin]) {
            *value += (unit * RADIUS_MM * 1000.0).round() / 1000.0;
        }
        point
    };
    (0..POINTS).map(point).collect()
}

fn smoothed<'a, const D: usize>(
    points: &'a [[f64; D]],
    vertices: &'a mut [Vertex<D>],
) -> impl Iterator<Item = Curve<D>> + 'a {
    let points = points.iter().copied().map(Waypoint::from);
    let curves = Smoothed::new(points, TOLERANCE_MM, vertices).expect("a tolerance");
    curves.map(|curve| curve.expect("a curve").with_tool(TOOL))
}

/// Seconds from the start to the last row.
fn seconds<A: path_timing::Axes, E: core::fmt::Debug>(
    rows: impl Iterator<Item = Result<Row<A>, E>>,
) -> f64 {
    let last = rows.last().expect("a row");
    last.expect("within limits").time_s
}

fn arm(arm: &Arm, points: &[[f64; 2]]) -> f64 {
    let (mut vertices, mut window) = ([Vertex::default(); 24], [Knot::default(); 64]);
    let mut joints = None;
    let paths = smoothed(points, &mut vertices).map(|curve| {
        let path = match joints {
            Some(joints) => arm.path_from(curve, Elbow::Right, joints),
            None => arm.path(curve, Elbow::Right),
        };
        let path = path.expect("in reach");
        let end = path.point(path.length()).expect("in reach");
        let [shoulder, elbow] = end.position;
        joints = Some(Joints::new(shoulder, elbow));
        path
    });
    let segments = |path: &ArmPath| segments_within(path, 1, TOLERANCE_MM, ArmPath::departure);
    let rows = LookAhead::new(paths, [JOINT; 2], segments, &mut window);
    seconds(rows.expect("limits"))
}

fn delta(delta: &Delta, points: &[[f64; 3]]) -> f64 {
    let (mut vertices, mut window) = ([Vertex::default(); 24], [Knot::default(); 64]);
    let paths = smoothed(points, &mut vertices);
    let paths = paths.map(|curve| delta.path(curve).expect("in reach"));
    let segments = |path: &DeltaPath| segments_within(path, 1, TOLERANCE_MM, DeltaPath::departure);
    let rows = LookAhead::new(paths, [JOINT; 3], segments, &mut window);
    seconds(rows.expect("limits"))
}

fn report(name: &str, step_mm: f64, mut plan: impl FnMut() -> f64) {
    let (mut motion_s, mut fastest_s) = (0.0, f64::INFINITY);
    for _ in 0..ROUNDS {
        let start = Instant::now();
        motion_s = black_box(plan());
        fastest_s = start.elapsed().as_secs_f64().min(fastest_s);
    }
    let share = fastest_s / motion_s;
    println!(
        "{name}, {step_mm} mm apart: {motion_s:.1} s of motion planned in {fastest_s:.3} s, {share:.4} of it"
    );
}

fn main() {
    let two_links = pose2pulse_bench::arm();
    let three_arms = pose2pulse_bench::delta();
    for step_mm in [0.2, 1.0] {
        let plane = points(step_mm, [0.0, 150.0]);
        report("arm", step_mm, || arm(&two_links, black_box(&plane)));
        let space = points(step_mm, [0.0, 0.0, -300.0]);
        report("Delta", step_mm, || delta(&three_arms, black_box(&space)));
    }
}
