//! Paths and tables in single precision, against those in double.

use path_timing::{AxisLimits, Cubic, Curve, Knot, Path, Promise, Table, Verifier};
use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, ArmPathF32, Elbow, JointRange, Joints, Limits};
use test_support::Random;

const JOINT: AxisLimits = AxisLimits {
    speed: 3.0,
    acceleration: 30.0,
    jerk: None,
};
/// The most by which a table in single precision may take longer: what its docs say.
const SLOWER: f64 = 1.01;
/// Of the reach: what `f32` rounds off in a point.
const ROUNDING: f64 = 2e-6;
/// Of slopes, where the arm is not near its edges.
const SLOPES: f64 = 1e-4;

fn arm() -> Arm {
    let turn = JointRange::new(-3.0, 3.0).unwrap();
    let limits = Limits {
        shoulder: turn,
        elbow: turn,
    };
    Arm::new(132.0, 132.0).unwrap().with_limits(limits)
}

/// Lines and arcs within the workspace.
fn paths() -> Vec<ArmPathF32> {
    let mut random = Random::new(7);
    let mut made = Vec::new();
    for number in 0..90 {
        let [from, to] = [(); 2].map(|()| {
            let (sin, cos) = random.within(-1.5, 1.5).sin_cos();
            let radius = random.within(60.0, 250.0);
            [radius * cos, radius * sin]
        });
        let curve = if number % 3 == 0 {
            let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
            Curve::arc(from, middle, [to[1] - from[1], from[0] - to[0]], 2.0)
        } else {
            Curve::line(from, to)
        };
        let elbow = [Elbow::Right, Elbow::Left][number % 2];
        let path = curve.ok().and_then(|curve| arm().path(curve, elbow).ok());
        made.extend(path.map(|path| path.in_f32().unwrap()));
    }
    assert!(made.len() > 30, "{}", made.len());
    made
}

fn tool([shoulder, elbow]: [f64; 2]) -> Point2<f64> {
    arm().forward(Joints::new(shoulder, elbow))
}

#[test]
fn points_and_slopes_are_those_of_double_within_rounding() {
    for path in paths() {
        for part in 0..=10 {
            let s = path.length() * f64::from(part) / 10.0;
            let (single, exact) = (path.point(s).unwrap(), path.exact().point(s).unwrap());
            let off = (tool(single.position) - tool(exact.position)).norm();
            assert!(off <= ROUNDING * arm().reach(), "{off}");
            for (single, exact) in single.slope.into_iter().zip(exact.slope) {
                let off = (single - exact).abs();
                assert!(off <= SLOPES * (exact.abs() + 0.01), "{single} {exact}");
            }
        }
    }
}

/// The limits are proven by a verifier in double, the departure by dense sampling.
#[test]
fn tables_keep_limits_and_departure_and_take_no_longer() {
    let mut slowest = 0.0_f64;
    for path in paths() {
        let (mut knots, mut others) = ([Knot::default(); 101], [Knot::default(); 101]);
        let table = Table::plan_in_f32([path], [JOINT; 2], |_| 100, &mut knots).unwrap();
        let exact = Table::plan([*path.exact()], [JOINT; 2], |_| 100, &mut others).unwrap();
        slowest = slowest.max(table.duration_s() / exact.duration_s());
        let mut verifier = Verifier::new(Promise {
            limits: [JOINT; 2],
            start_stop: [0.0; 2],
            max_departure: f64::INFINITY,
            max_slowness: f64::INFINITY,
            tool_feed: Some(1.0),
        });
        for row in table.rows() {
            let proven = verifier.add(&row, |_| Some(path), ArmPathF32::departure);
            proven.unwrap();
        }
        for span in table.spans() {
            let bound = path.departure(&span);
            let cubics: Vec<_> = Cubic::between(&span.rows[0], &span.rows[1]).collect();
            for part in 0..=16 {
                let tau = f64::from(part) / 16.0;
                let tool = tool([cubics[0].position(tau), cubics[1].position(tau)]);
                let off = distance(path.exact().curve(), span.s, tool);
                assert!(off <= bound, "{off} {bound}");
            }
        }
    }
    println!("at most {slowest} of the time in double");
    assert!(slowest <= SLOWER, "{slowest}");
}

/// From a curve, near the places `s`.
fn distance(curve: &Curve<2>, s: [f64; 2], tool: Point2<f64>) -> f64 {
    let mut at = (s[0] + s[1]) * 0.5;
    let mut off = f64::INFINITY;
    for _ in 0..8 {
        let there = curve.at(at);
        let apart = tool - Point2::from(there.point);
        off = apart.norm();
        let ahead = apart.x * there.tangent[0] + apart.y * there.tangent[1];
        at = (at + ahead).clamp(0.0, curve.length());
    }
    off
}
