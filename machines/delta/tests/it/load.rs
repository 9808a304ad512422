//! A machine whose load is known: what is planned against what its simulated motors can turn, and
//! how its tool swings. The simulation gets the steps alone.

use delta::{Machine, Motion, Session, StepLog, simulate};
use machine_sim::Motor;
use serde_json::Value;
use test_support::loaded::{assert_refused_with, number, with_pull_out};

const LOADED: &str = include_str!("../../loaded.toml");
const FAST: &str = include_str!("../../inputs/fast.txt");

/// As in `loaded.toml`.
const MOTOR: Motor = Motor {
    holding_torque_nm: 0.4,
    corner_speed_hz: 2000.0,
    inertia_kg_m2: 7.4e-6,
    friction_nm: 0.03,
    damping_ratio: 0.02,
    full_steps_per_turn: 200,
    microsteps: 16,
};
/// Of rotor, arm and a third of what hangs on the arms, at the motor.
const LOAD_KG_M2: f64 = 3e-5;

fn report(machine: &str, lines: &str) -> Value {
    let machine = Machine::parse(machine).unwrap();
    let mut log = StepLog::new(Vec::new()).unwrap();
    let mut observer = |ticks, steps| log.step(ticks, steps);
    let mut session = Session::new(&machine, Motion::Rounded, &mut observer).unwrap();
    for byte in lines.bytes() {
        if let Some(answer) = session.handle_byte(byte).unwrap() {
            assert!(answer.starts_with("ok"), "{answer}");
        }
    }
    let record = session.finish().unwrap();
    let run = simulate(&machine, &record, &*log.finish().unwrap()).unwrap();
    let report = run.report();
    println!("{report}");
    let figure = run.picture().unwrap().to_string();
    assert!(figure.contains("Torque of the motors"));
    serde_json::to_value(report).unwrap()
}

fn lost_steps(report: &Value) -> f64 {
    let motors = 0..3;
    motors
        .map(|motor| number(report, &format!("/motors/{motor}/lost_steps")))
        .sum()
}

#[test]
fn a_known_load_is_carried_without_a_lost_step_and_hardly_swings() {
    let report = report(LOADED, FAST);
    assert_eq!(lost_steps(&report).to_bits(), 0);
    let (part, planned) = (
        number(&report, "/torque/part"),
        number(&report, "/torque/planned"),
    );
    assert!(part <= planned + 1e-9 && part > 0.9 * planned, "{part}");
    let [left, unshaped] =
        ["/left_mm", "/unshaped/left_mm"].map(|at| number(&report, &format!("/vibration{at}")));
    // What is left is the whole steps'.
    assert!(left < 0.02 && unshaped > 0.1, "{left} mm, {unshaped} mm");
    let off = number(&report, "/max_path_error_mm");
    assert!(off < 2.0 + 0.02, "{off} mm");
}

/// The simulated motor's own curve times a factor.
fn lost_with(factor: f64) -> f64 {
    let machine = with_pull_out(LOADED, 240.0, |hz| {
        factor * MOTOR.pull_out_nm(hz, LOAD_KG_M2)
    });
    lost_steps(&report(&machine, FAST))
}

#[test]
fn the_limit_is_tight() {
    assert_eq!(lost_with(0.95).to_bits(), 0);
    assert!(lost_with(1.1) > 0.5);
}

#[test]
fn what_no_machine_has_is_refused_by_name() {
    let changes = [
        [
            "reserve = 0.3",
            "reserve = 1.0",
            "[torque] reserve = 1 is not 0 to below 1",
        ],
        [
            "holding_torque_nm = 0.4",
            "holding_torque_nm = 0.0",
            "[torque] holding_torque_nm = 0 is not above zero",
        ],
        [
            "damping_ratio = 0.02",
            "damping_ratio = nan",
            "[torque] damping_ratio = NaN is not zero or above",
        ],
        [
            "damping_ratio = 0.02",
            "damping_ratio = 2.0",
            "[torque] the motor has nothing left at",
        ],
        [
            "reserve = 0.3",
            "reserve = 0.3\npull_out = [[0.0, 0.3], [50.0, -0.1]]",
            "[torque] pull_out: point 1: torque of",
        ],
        [
            "reserve = 0.3",
            "reserve = 0.3\npull_out = [[0.0, 0.3], [3000.0, 0.1]]",
            "[torque] pull_out ends at 3000 Hz, not above the 3333 Hz of the largest speed",
        ],
        [
            "rods_kg = 0.04",
            "rods_kg = -0.04",
            "[load]: mass of the rods is -0.04",
        ],
        ["rods_kg = 0.04", "", "missing field `rods_kg`"],
        ["[load]", "[lode]", "unknown field `lode`"],
        ["hz = 40.0", "hz = 0.0", "[mode] hz = 0, damping = 0.03: "],
        ["\"zvd\"", "\"zv2\"", "[mode] shaper = \"zv2\" is none of"],
    ];
    assert_refused_with(LOADED, &changes, |machine| {
        Some(format!("{:#}", Machine::parse(machine).err()?))
    });
}
