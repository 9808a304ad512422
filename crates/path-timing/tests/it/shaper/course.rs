//! The course along a path, shaped: the tool stays on it.

use core::f64::consts::TAU;

use path_timing::{
    AxisLimits, Curve, Knot, Mode, Path, Promise, Row, Shaped, Shaper, Table, Verifier,
};
use scara_kin::{Arm, ArmPath, Elbow};

const MODE: Mode = Mode {
    hz: 40.0,
    damping: 0.02,
};

/// By how much limits are planned lower, for the slopes that change within the delay.
const LOWER: f64 = 0.9;

/// The rows of a path whose course is shaped, planned with limits that are lower.
fn shaped<P: Path<Axes = [f64; 2], Error: core::fmt::Debug> + Clone>(
    path: &P,
    limits: [AxisLimits; 2],
    shaper: Shaper,
) -> Vec<Row<[f64; 2]>> {
    let lower = limits.map(|axis| AxisLimits {
        acceleration: axis.acceleration * LOWER,
        speed: axis.speed * LOWER,
        ..axis
    });
    let mut knots = vec![Knot::default(); 301];
    let table = Table::plan([path], lower, |_| 300, &mut knots).unwrap();
    let mut memory = vec![Row::default(); 400];
    let course = table.rows().map(|row| row.course(path));
    let rows = Shaped::new(course, [shaper], &mut memory);
    rows.map(|row| row.unwrap_or_else(|_| panic!()).on(path).unwrap())
        .collect()
}

#[test]
fn the_tool_stays_on_its_path_within_the_limits() {
    let promise = |limits| Promise {
        limits,
        start_stop: [0.0; 2],
        max_departure: 1e-3,
        max_slowness: f64::INFINITY,
        tool_feed: None,
    };
    let shaper = Shaper::zvd(MODE).unwrap();
    let arc = Curve::arc([40.0, 0.0], [0.0, 0.0], [0.0, 1.0], 4.0).unwrap();
    let linear = AxisLimits {
        speed: 300.0,
        acceleration: 5000.0,
        jerk: None,
    };
    let mut verifier = Verifier::new(promise([linear; 2]));
    for row in shaped(&arc, [linear; 2], shaper) {
        verifier.add(&row, |_| Some(arc), Curve::departure).unwrap();
    }
    let joint = AxisLimits {
        speed: 3.0,
        acceleration: 30.0,
        jerk: None,
    };
    let arm = Arm::new(132.0, 132.0).unwrap();
    let line = arm
        .path(
            Curve::line([-80.0, 120.0], [80.0, 120.0]).unwrap(),
            Elbow::Right,
        )
        .unwrap();
    let mut verifier = Verifier::new(promise([joint; 2]));
    for row in shaped(&line, [joint; 2], shaper) {
        verifier
            .add(&row, |_| Some(line), ArmPath::departure)
            .unwrap();
    }
}

/// What a mode in x is left with when the course along an arc is shaped, driven by the cubics
/// themselves.
#[test]
fn little_of_a_vibration_is_left() {
    let arc = Curve::arc([40.0, 0.0], [0.0, 0.0], [0.0, 1.0], 4.0).unwrap();
    let linear = AxisLimits {
        speed: 300.0,
        acceleration: 5000.0,
        jerk: None,
    };
    let left = |shaper| {
        let rows = shaped(&arc, [linear; 2], shaper);
        let (omega, end_s) = (TAU * MODE.hz, rows[rows.len() - 1].time_s);
        // The response to each acceleration at the end: ∫ x" exp((ζω + iω_d)(t - end)) dt / ω
        let damped = omega * (1.0 - MODE.damping * MODE.damping).sqrt();
        let mut sum = [0.0; 2];
        for pair in rows.windows(2) {
            const PARTS: u32 = 16;
            let cubic = path_timing::Cubic::between(&pair[0], &pair[1])
                .next()
                .unwrap();
            let [a0, a1] = cubic.accelerations();
            for part in 0..PARTS {
                let fraction = (f64::from(part) + 0.5) / f64::from(PARTS);
                let since_s = pair[0].time_s + cubic.duration_s * fraction - end_s;
                let size = (a0 + (a1 - a0) * fraction) * cubic.duration_s / f64::from(PARTS);
                let size = size * (MODE.damping * omega * since_s).exp() / damped;
                let (sin, cos) = (damped * since_s).sin_cos();
                sum = [sum[0] + size * cos, sum[1] + size * sin];
            }
        }
        sum[0].hypot(sum[1])
    };
    let (unshaped, shaped) = (left(Shaper::none()), left(Shaper::zvd(MODE).unwrap()));
    println!("{unshaped:.4} mm unshaped, {shaped:.4} mm with the course shaped");
    assert!(shaped < 0.1 * unshaped);
}
