//! Limits of torque: curves of motors, the tables of an arm against other derivations.

mod coarse;
mod monotonic;
mod streams;

use core::fmt::Write as _;
use std::io::Write as _;
use std::path::Path as File;
use std::process::{Command, Stdio};

use delta_kin::{Delta, DeltaDynamics, DeltaMasses, Dimensions};
use path_timing::{
    Accuracy, AxisLimits, Cubic, Curve, Knot, PlanError, Row, Span, Table, TorqueCurve,
    TorqueCurveError, TorqueLimits,
};
use proptest::prelude::*;
use scara_kin::{Arm, ArmDynamics, ArmMasses, ArmPath, Elbow, JointDrive, Joints, LinkMass};
use twofloat::TwoFloat;

/// Links of 0.3 m, in mm.
const LINK_MM: f64 = 300.0;

/// What no joint reaches.
const FREE: AxisLimits = AxisLimits {
    speed: 40.0,
    acceleration: 4000.0,
    jerk: None,
};

fn arm() -> Arm {
    Arm::new(LINK_MM, LINK_MM).unwrap()
}

fn masses(payload_kg: f64) -> ArmMasses {
    ArmMasses {
        upper: LinkMass {
            mass_kg: 3.0,
            centre_m: 0.15,
            inertia_kg_m2: 0.03,
        },
        fore: LinkMass {
            mass_kg: 2.0,
            centre_m: 0.12,
            inertia_kg_m2: 0.02,
        },
        payload_kg,
        shoulder: JointDrive {
            rotor_kg_m2: 0.08,
            viscous_nm_s: 0.3,
            coulomb_nm: 0.8,
        },
        elbow: JointDrive {
            rotor_kg_m2: 0.03,
            viscous_nm_s: 0.1,
            coulomb_nm: 0.4,
        },
        gravity_m_s2: 0.0,
    }
}

/// Upright, with links of one mass and joints with one drive.
fn alike(link_mass_kg: f64, drive: JointDrive, payload_kg: f64) -> ArmMasses {
    let link = LinkMass {
        mass_kg: link_mass_kg,
        centre_m: 0.14,
        inertia_kg_m2: 0.03,
    };
    ArmMasses {
        upper: link,
        fore: link,
        payload_kg,
        shoulder: drive,
        elbow: drive,
        gravity_m_s2: 9.8,
    }
}

fn limits(payload_kg: f64, motors: [TorqueCurve; 2]) -> TorqueLimits<ArmDynamics> {
    let dynamics = arm().dynamics(1e-3, masses(payload_kg)).unwrap();
    TorqueLimits { dynamics, motors }
}

fn constant() -> [TorqueCurve; 2] {
    [30.0, 12.0].map(|torque| TorqueCurve::constant(torque, 30.0).unwrap())
}

fn stepper() -> [TorqueCurve; 2] {
    [(30.0, 3.0), (12.0, 4.0)]
        .map(|(torque, corner)| TorqueCurve::holding(torque, corner, 30.0).unwrap())
}

fn line([from, to]: [[f64; 2]; 2]) -> ArmPath {
    arm()
        .path(Curve::line(from, to).unwrap(), Elbow::Right)
        .unwrap()
}

const LINES: [[[f64; 2]; 2]; 4] = [
    [[-200.0, 300.0], [250.0, 300.0]],
    [[100.0, 150.0], [420.0, 250.0]],
    [[350.0, -200.0], [350.0, 220.0]],
    [[-300.0, 120.0], [300.0, 160.0]],
];

/// The rows of a line, and their time.
fn planned(
    limits: &TorqueLimits<ArmDynamics>,
    path: ArmPath,
    segments: u32,
) -> (Vec<Row<[f64; 2]>>, f64) {
    let mut knots = vec![Knot::default(); 5000];
    let table = limits
        .plan([path], [FREE; 2], |_| segments, &mut knots)
        .unwrap();
    (table.rows().collect(), table.duration_s())
}

/// What is promised of a motor, but for rounding.
const WITHIN: f64 = 1.0 + 1e-9;

/// The torques of an arm in 32 digits by its textbook form, friction included.
fn exact_torques(
    masses: &ArmMasses,
    q: [TwoFloat; 2],
    v: [TwoFloat; 2],
    a: [TwoFloat; 2],
) -> [TwoFloat; 2] {
    let f = TwoFloat::from;
    let (l, m1, m2, load) = (0.3, masses.upper, masses.fore, masses.payload_kg);
    let k = f((m2.mass_kg * m2.centre_m + load * l) * l);
    let delta = f(m2.inertia_kg_m2 + m2.mass_kg * m2.centre_m * m2.centre_m + load * l * l);
    let own = m1.inertia_kg_m2 + m1.mass_kg * m1.centre_m * m1.centre_m;
    let alpha = delta + (own + (m2.mass_kg + load) * l * l);
    let (sin, cos) = (k * q[1].sin(), k * q[1].cos());
    let friction = |drive: JointDrive, v: TwoFloat| {
        v * drive.viscous_nm_s + drive.coulomb_nm * f64::from(v).signum()
    };
    [
        (alpha + cos * 2.0 + masses.shoulder.rotor_kg_m2) * a[0] + (delta + cos) * a[1]
            - sin * (v[0] * v[1] * 2.0 + v[1] * v[1])
            + friction(masses.shoulder, v[0]),
        (delta + cos) * a[0]
            + (delta + masses.elbow.rotor_kg_m2) * a[1]
            + sin * v[0] * v[0]
            + friction(masses.elbow, v[1]),
    ]
}

/// The largest part of a motor's torque on the cubics of rows, in many samples of 32 digits.
fn sampled(limits: &TorqueLimits<ArmDynamics>, rows: &[Row<[f64; 2]>], samples: u32) -> f64 {
    let f = TwoFloat::from;
    let mut most = 0.0_f64;
    for pair in rows.windows(2) {
        let cubics: Vec<_> = Cubic::between(&pair[0], &pair[1]).collect();
        for sample in 1..samples {
            let u = f(f64::from(sample)) / f64::from(samples);
            let at = |cubic: &Cubic| {
                let t = f(cubic.duration_s);
                let (v0, v1) = (f(cubic.v0) * t, f(cubic.v1) * t);
                let rise = f(cubic.q1) - f(cubic.q0);
                let (b, c) = (rise * 3.0 - v0 * 2.0 - v1, v0 + v1 - rise * 2.0);
                let q = f(cubic.q0) + (v0 + (b + c * u) * u) * u;
                let v = (v0 + (b * 2.0 + c * 3.0 * u) * u) / t;
                (q, v, (b * 2.0 + c * 6.0 * u) / (t * t))
            };
            let [(q1, v1, a1), (q2, v2, a2)] = [at(&cubics[0]), at(&cubics[1])];
            let torques = exact_torques(limits.dynamics.masses(), [q1, q2], [v1, v2], [a1, a2]);
            for ((torque, v), motor) in torques.into_iter().zip([v1, v2]).zip(&limits.motors) {
                most = most.max(f64::from(torque.abs()) / motor.at(f64::from(v)));
            }
        }
    }
    most
}

#[test]
fn no_cubic_takes_more_torque_than_its_motor_has() {
    for (name, motors, tight) in [
        ("constant", constant(), 0.999),
        ("stepper", stepper(), 0.998),
    ] {
        for payload_kg in [0.0, 3.0] {
            let limits = limits(payload_kg, motors);
            for (number, ends) in LINES.into_iter().enumerate() {
                let (rows, time_s) = planned(&limits, line(ends), 100);
                let used = sampled(&limits, &rows, 40);
                println!("{name}, {payload_kg} kg, line {number}: {time_s:.4} s, {used:.5} used");
                assert!(used <= WITHIN && used > tight, "{used}");
            }
        }
    }
}

/// Time above that of 4000 segments, by segments; where a motor's torque falls with its speed, it
/// is taken at the largest speed of a part of a segment.
const ABOVE: [(u32, f64, f64); 3] = [
    (100, 1.008, 1.012),
    (200, 1.004, 1.006),
    (400, 1.002, 1.003),
];

#[test]
fn segments_cost_little_time() {
    for (motors, falls) in [(constant(), false), (stepper(), true)] {
        let limits = limits(1.0, motors);
        for ends in LINES {
            let (_, fine_s) = planned(&limits, line(ends), 4000);
            for (segments, constant, falling) in ABOVE {
                let (_, time_s) = planned(&limits, line(ends), segments);
                println!(
                    "{segments} segments: {:.5} of {fine_s:.4} s",
                    time_s / fine_s
                );
                assert!(time_s <= fine_s * if falls { falling } else { constant });
            }
        }
    }
}

/// As few segments as the tool's departure and the time ask for, with the bounds of both on the
/// spans.
#[test]
fn segments_are_found_for_a_departure() {
    const RATIO: f64 = 1.02;
    let limits = limits(1.0, stepper());
    for ends in LINES {
        let (_, fine_s) = planned(&limits, line(ends), 2000);
        // Segments that are few enough for the departure are too few for the time, or not.
        for (allowed, needs_more) in [(0.1, true), (0.001, false)] {
            let accuracy = Accuracy {
                min_segments: 4,
                max_departure: allowed,
                max_time_ratio: RATIO,
            };
            let mut knots = vec![Knot::default(); 5000];
            let departure = |path: &ArmPath, span: &Span<[f64; 2]>| path.departure(span);
            let table = limits
                .plan_within([line(ends)], [FREE; 2], accuracy, departure, &mut knots)
                .unwrap();
            for span in table.spans() {
                assert!(line(ends).departure(&span) <= allowed);
                assert!(limits.utilisation(&span) <= WITHIN);
            }
            let (rows, time_s) = (table.rows().count(), table.duration_s());
            println!("{allowed} mm: {rows} rows, {time_s:.4} s, {fine_s:.4} s at best");
            assert!(time_s <= fine_s * RATIO && rows < 2000);
            let any_time = Accuracy {
                max_time_ratio: f64::INFINITY,
                ..accuracy
            };
            let table = limits
                .plan_within([line(ends)], [FREE; 2], any_time, departure, &mut knots)
                .unwrap();
            assert_eq!(table.rows().count() < rows, needs_more);
            assert!(table.rows().count() <= rows && table.duration_s() >= time_s);
            let mut few = [Knot::default(); 4];
            let error = limits
                .plan_within([line(ends)], [FREE; 2], accuracy, departure, &mut few)
                .unwrap_err();
            assert!(
                matches!(
                    error,
                    PlanError::TooCoarse { .. } | PlanError::Memory { .. }
                ),
                "{error}"
            );
        }
    }
}

/// Against the best constant accelerations that no motor is overrun by, tuned for each line: both
/// scaled down together from what each joint could do alone, and in any proportion.
#[test]
fn torque_is_faster_than_constant_limits() {
    for (payload_kg, faster) in [(0.0, 1.1), (3.0, 1.2)] {
        let limits = limits(payload_kg, constant());
        for ends in LINES {
            let (_, time_s) = planned(&limits, line(ends), 200);
            let mut best_s = f64::INFINITY;
            for proportion in [0.25, 0.5, 1.0, 2.0, 4.0] {
                let (mut low, mut high) = (0.0, 400.0);
                for _ in 0..24 {
                    let middle = (low + high) * 0.5;
                    let accelerations = [middle, middle * proportion];
                    let axes = accelerations.map(|acceleration| AxisLimits {
                        acceleration,
                        ..FREE
                    });
                    let mut knots = vec![Knot::default(); 201];
                    let table = Table::plan([line(ends)], axes, |_| 200, &mut knots).unwrap();
                    let used = table.spans().map(|span| limits.utilisation(&span));
                    if used.fold(0.0, f64::max) <= 1.0 {
                        low = middle;
                        best_s = best_s.min(table.duration_s());
                    } else {
                        high = middle;
                    }
                }
            }
            println!(
                "{payload_kg} kg: {time_s:.4} s, {:.3} times as fast",
                best_s / time_s
            );
            assert!(best_s / time_s > faster);
        }
    }
}

#[test]
fn torques_of_a_segment_are_those_of_its_ends() {
    let limits = limits(1.0, constant());
    let mut knots = [Knot::default(); 41];
    let table = limits
        .plan([line(LINES[0])], [FREE; 2], |_| 40, &mut knots)
        .unwrap();
    let mut steepest = 0.0_f64;
    for span in table.spans() {
        for (torques, (row, end)) in limits
            .torques(&span)
            .into_iter()
            .zip(span.rows.iter().zip([0, 1]))
        {
            let accelerations: Vec<_> = Cubic::between(&span.rows[0], &span.rows[1])
                .map(|cubic| cubic.accelerations()[end])
                .collect();
            let joints = Joints::new(row.position[0], row.position[1]);
            let accelerations = [accelerations[0], accelerations[1]];
            let exact = limits
                .dynamics
                .torques(joints, row.velocity.into(), accelerations.into());
            for ((torque, exact), limit) in torques.iter().zip(exact.iter()).zip([30.0, 12.0]) {
                assert!(row.is_at_rest() || (torque - exact).abs() < 1e-9);
                assert!(torque.abs() <= limit * WITHIN, "{torque}");
                steepest = steepest.max(torque.abs() / limit);
            }
        }
    }
    assert!(steepest > 0.99, "{steepest}");
}

#[test]
fn an_arm_that_cannot_hold_its_load_is_refused() {
    let upright = ArmMasses {
        gravity_m_s2: 9.806_65,
        ..masses(3.0)
    };
    let dynamics = arm().dynamics(1e-3, upright).unwrap();
    let strong = TorqueLimits {
        dynamics,
        motors: [60.0, 25.0].map(|torque| TorqueCurve::constant(torque, 20.0).unwrap()),
    };
    let (rows, _) = planned(&strong, line(LINES[1]), 200);
    assert!(rows.len() == 201);
    let weak = TorqueLimits {
        motors: [20.0, 5.0].map(|torque| TorqueCurve::constant(torque, 20.0).unwrap()),
        ..strong
    };
    let mut knots = [Knot::default(); 201];
    let error = weak
        .plan([line(LINES[1])], [FREE; 2], |_| 200, &mut knots)
        .unwrap_err();
    assert!(
        matches!(error, PlanError::Overload { leg: 0, .. }),
        "{error}"
    );
}

/// A table is slowed until inertia takes what gravity leaves, however little that is.
#[test]
fn gravity_may_take_nearly_all() {
    let masses = ArmMasses {
        gravity_m_s2: 9.806_65,
        ..masses(1.0)
    };
    let dynamics = arm().dynamics(1e-3, masses).unwrap();
    for left_nm in [10.0, 1.0, 0.2] {
        // Of the first is what the line asks for against gravity.
        let motors = [14.5 + left_nm, 6.0 + left_nm]
            .map(|torque| TorqueCurve::constant(torque, 30.0).unwrap());
        let limits = TorqueLimits { dynamics, motors };
        for segments in [20, 60, 200] {
            let path = line([[350.0, -200.0], [350.0, 220.0]]);
            let mut knots = vec![Knot::default(); 5000];
            let table = limits
                .plan([path], [FREE; 2], |_| segments, &mut knots)
                .unwrap();
            let used = table.spans().map(|span| limits.utilisation(&span));
            let most = used.fold(0.0, f64::max);
            assert!(
                most > 0.999 && most <= WITHIN,
                "{left_nm} {segments}: {most}"
            );
        }
    }
}

#[test]
fn curves_of_motors() {
    let motor = TorqueCurve::holding(2.0, 10.0, 80.0).unwrap();
    for n in 0..800 {
        let speed = f64::from(n) * 0.1;
        let exact = 2.0 * (10.0 / speed).min(1.0);
        assert!(
            motor.at(speed) <= exact && motor.at(-speed) >= exact * 0.99,
            "{speed}"
        );
    }
    assert_eq!(motor.at(80.1).to_bits(), 0);
    // A dip at a resonance is what all speeds above it have.
    let dip =
        TorqueCurve::from_points(&[[0.0, 3.0], [10.0, 1.0], [20.0, 2.0], [30.0, 0.5]]).unwrap();
    assert!((dip.at(15.0) - 1.0).abs() < 1e-12 && (dip.at(5.0) - 2.0).abs() < 1e-12);
    let refused = |points: &[[f64; 2]]| TorqueCurve::from_points(points).unwrap_err().to_string();
    assert_eq!(refused(&[]), "0 points are not within 1..=16");
    assert_eq!(
        refused(&[[1.0, 2.0]]),
        "point 0: speed of 1 is out of its range"
    );
    assert_eq!(
        refused(&[[0.0, 2.0], [0.0, 1.0]]),
        "point 1: speed of 0 is out of its range"
    );
    assert_eq!(
        refused(&[[0.0, -2.0]]),
        "point 0: torque of -2 is out of its range"
    );
    assert!(matches!(
        TorqueCurve::holding(1.0, 10.0, 5.0),
        Err(TorqueCurveError::Value { .. })
    ));
    assert!(motor.geared(0.0).is_err() && motor.scaled(f64::NAN).is_err());
}

/// The same arms as in the examples, each with a stepper behind a gear.
/// A Delta that carries 0.3 kg, in mm.
fn delta() -> (Delta, TorqueLimits<DeltaDynamics>) {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    let masses = DeltaMasses {
        arm_kg_m2: 4e-3,
        arm_kg_m: 0.012,
        rods_kg: 0.06,
        platform_kg: 0.15,
        payload_kg: 0.3,
        viscous_nm_s: 0.02,
        coulomb_nm: 0.05,
        gravity_m_s2: 9.806_65,
    };
    let dynamics = delta.dynamics(1e-3, masses).unwrap();
    let motors = [TorqueCurve::holding(4.0, 4.0, 40.0).unwrap(); 3];
    (delta, TorqueLimits { dynamics, motors })
}

#[test]
fn a_delta_keeps_the_torque_of_its_motors() {
    let (delta, limits) = delta();
    let (dynamics, motors) = (&limits.dynamics, limits.motors);
    for (from, to) in [
        ([-60.0, 20.0, -280.0], [60.0, -10.0, -280.0]),
        ([0.0, 0.0, -310.0], [0.0, 0.0, -230.0]),
        ([40.0, 60.0, -260.0], [-30.0, -50.0, -320.0]),
    ] {
        let path = delta.path(Curve::line(from, to).unwrap()).unwrap();
        let mut times = Vec::new();
        for segments in [200, 2000] {
            let mut knots = vec![Knot::default(); 2001];
            let table = limits
                .plan([path], [FREE; 3], |_| segments, &mut knots)
                .unwrap();
            times.push(table.duration_s());
            let mut most = 0.0_f64;
            for span in table.spans() {
                // Between its rows a segment is the same motion in parts.
                let [from, to] = span.rows;
                let cubics: Vec<_> = Cubic::between(&from, &to).collect();
                for sample in 0..20 {
                    let u = (f64::from(sample) + 0.5) / 20.0;
                    let each = |of: &dyn Fn(&Cubic) -> f64| {
                        core::array::from_fn::<_, 3, _>(|axis| of(&cubics[axis]))
                    };
                    let accelerations = each(&|cubic| {
                        let [a0, a1] = cubic.accelerations();
                        a0 + (a1 - a0) * u
                    });
                    let rates = each(&|cubic| {
                        let [a0, a1] = cubic.accelerations();
                        cubic.v0 + (a0 + (a1 - a0) * u * 0.5) * u * cubic.duration_s
                    });
                    let pose = delta
                        .pose_of(each(&|cubic| cubic.position(u)).into())
                        .unwrap();
                    let torques = dynamics
                        .torques(&pose, rates.into(), accelerations.into())
                        .unwrap();
                    for ((torque, rate), motor) in torques.iter().zip(rates).zip(&motors) {
                        most = most.max(torque.abs() / motor.at(rate));
                    }
                }
            }
            println!(
                "Delta, {segments} segments: {:.4} s, {most:.5} used",
                table.duration_s()
            );
            assert!(most <= WITHIN && most > 0.999, "{most}");
        }
        assert!(times[0] <= times[1] * 1.02, "{times:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// The bound of a segment is above all samples of it, for any segment.
    #[test]
    fn the_bound_of_a_segment_holds(
        rates in prop::array::uniform4(-6.0..6.0_f64),
        joints in prop::array::uniform4(-3.0..3.0_f64),
        duration_s in 0.01..1.0_f64,
        payload_kg in 0.0..4.0_f64,
    ) {
        let limits = limits(payload_kg, [1e3, 1e3].map(|torque| TorqueCurve::constant(torque, 1e3).unwrap()));
        let [a, b, c, d] = joints;
        let row = |position, velocity| Row { time_s: 0.0, duration_s, position, velocity, leg: 0, s: 0.0 };
        let rows = [row([a, b], [rates[0], rates[1]]), row([c, d], [rates[2], rates[3]])];
        let span = Span { s: [0.0, 1.0], rows };
        let bound = limits.utilisation(&span);
        prop_assert!(sampled(&limits, &rows, 60) <= bound * WITHIN);
    }
}

/// toppra with the torques of the same arm without friction, where it is installed: as in `toppra`.
#[test]
fn time_above_that_of_toppra() {
    let mut python = Command::new("python3");
    let status = python
        .args(["-c", "import toppra"])
        .stderr(Stdio::null())
        .status();
    if !status.is_ok_and(|status| status.success()) {
        let is_required = std::env::var_os("PATH_TIMING_REQUIRE_TOPPRA").is_some();
        assert!(!is_required, "python3 has no toppra");
        return;
    }
    let mut python = Command::new("python3")
        .arg(File::new(env!("CARGO_MANIFEST_DIR")).join("tests/toppra/torque.py"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = String::new();
    for payload_kg in [0.0, 3.0] {
        for [[x0, y0], [x1, y1]] in LINES {
            writeln!(input, "{x0} {y0} {x1} {y1} {payload_kg}").unwrap();
        }
    }
    let mut stdin = python.stdin.take().unwrap();
    stdin.write_all(input.as_bytes()).unwrap();
    drop(stdin);
    let output = python.wait_with_output().unwrap();
    assert!(output.status.success());
    let output = String::from_utf8(output.stdout).unwrap();
    let mut shortest = output.lines().map(|line| line.parse::<f64>().unwrap());
    for payload_kg in [0.0, 3.0] {
        let rotor = |rotor_kg_m2| JointDrive {
            rotor_kg_m2,
            ..JointDrive::default()
        };
        let masses = ArmMasses {
            shoulder: rotor(0.08),
            elbow: rotor(0.03),
            ..masses(payload_kg)
        };
        let dynamics = arm().dynamics(1e-3, masses).unwrap();
        let limits = TorqueLimits {
            dynamics,
            motors: constant(),
        };
        for ends in LINES {
            let shortest_s = shortest.next().unwrap();
            let (_, time_s) = planned(&limits, line(ends), 400);
            println!(
                "{payload_kg} kg: {:.5} of {shortest_s:.4} s",
                time_s / shortest_s
            );
            assert!((0.999..1.005).contains(&(time_s / shortest_s)));
        }
    }
}
