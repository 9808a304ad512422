//! A machine whose load is known: what is planned against what its simulated motors can turn, and
//! how its tables swing. The simulation gets the steps alone.

use std::fs;
use std::path::Path;

use machine_sim::Motor;
use serde_json::Value;
use stage::{Machine, Program, Settings, run};
use test_support::loaded::{assert_refused_with, number, with_pull_out};

const LOADED: &str = include_str!("../../loaded.toml");
const FAST: &str = include_str!("../../drawings/fast.gcode");

/// As in `loaded.toml`, with all that the motor of X turns.
const MOTOR: Motor = Motor {
    holding_torque_nm: 0.4,
    corner_speed_hz: 1000.0,
    inertia_kg_m2: 10.6e-6,
    friction_nm: 0.03,
    damping_ratio: 0.02,
    full_steps_per_turn: 200,
    microsteps: 2,
};

fn report(machine: &str, program: &Program, tolerance_mm: f64) -> Value {
    let settings = Settings {
        tolerance_mm,
        ..Settings::default()
    };
    let machine = Machine::parse(machine).unwrap();
    let run = run(&machine, program, &settings, &mut |_, _| Ok(())).unwrap();
    let report = run.report();
    println!("{report}");
    let figure = run.picture().to_string();
    assert!(figure.contains("Torque of the motors"));
    serde_json::to_value(report).unwrap()
}

fn fast() -> Program {
    Program::parse(FAST).unwrap()
}

fn lost_steps(report: &Value) -> f64 {
    let axes = ["x", "y"];
    axes.map(|axis| number(report, &format!("/motors/{axis}/lost_steps")))
        .iter()
        .sum()
}

#[test]
fn a_known_load_is_carried_without_a_lost_step_and_hardly_swings() {
    for (tolerance_mm, least) in [(0.01, 0.0), (0.1, 0.6), (0.5, 0.95)] {
        let report = report(LOADED, &fast(), tolerance_mm);
        assert_eq!(lost_steps(&report).to_bits(), 0);
        let [part, planned] =
            ["part", "planned"].map(|name| number(&report, &format!("/torque/{name}")));
        assert!(part <= planned + 1e-9 && part > least * planned, "{part}");
        // Within the tolerance, half of it for shaping, but for whole steps.
        let bound = number(&report, "/shaped_bound_mm");
        assert!(bound <= tolerance_mm / 2.0 + 1e-12, "{bound} mm");
        let off = number(&report, "/max_deviation_mm");
        assert!(off < tolerance_mm + 0.0081, "{off} mm");
        for table in ["x", "y"] {
            let [left, unshaped] = ["/left_mm", "/unshaped/left_mm"]
                .map(|at| number(&report, &format!("/vibration/{table}{at}")));
            // What is left is that of whole steps, 0.01 mm each.
            assert!(left < 0.01 && unshaped > 0.04, "{left} mm, {unshaped} mm");
        }
    }
}

#[test]
fn no_step_is_lost_on_the_programs_of_other_tools() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/stage/gcode");
    let mut programs = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|it| it != "nc") {
            continue;
        }
        let program = Program::from_bytes(&fs::read(&path).unwrap()).unwrap();
        let program = program.fit().unwrap();
        for tolerance_mm in [0.01, 0.5] {
            let report = report(LOADED, &program, tolerance_mm);
            assert_eq!(lost_steps(&report).to_bits(), 0, "{}", path.display());
        }
        programs += 1;
    }
    assert!(programs >= 6, "{programs}");
}

/// There and back, by 0.1 to 2 mm of both axes, one right after the other: so far each time that the
/// motors are asked for all of their torque either way, and in step with their swings at some.
fn there_and_back() -> Program {
    let mut text = String::from("G21 G90 F6000\n");
    for count in 2..60 {
        let far = f64::from(count) / 30.0;
        text += &format!("G1 X{far} Y{far}\nG1 X0 Y0\n").repeat(2);
    }
    Program::parse(&text).unwrap()
}

/// The simulated motor's own curve times a factor.
fn lost_with(factor: f64) -> f64 {
    let inertia = MOTOR.inertia_kg_m2;
    let machine = with_pull_out(LOADED, 205.0, |hz| factor * MOTOR.pull_out_nm(hz, inertia));
    lost_steps(&report(&machine, &there_and_back(), 0.01))
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
            "reserve = 0.3",
            "reserve = 0.3\npull_out = [[0.0, 0.2], [3000.0, 0.1]]",
            "[torque] pull_out ends at 3000 Hz, not above the 3000 Hz of the largest speed by 1 %",
        ],
        [
            "max_speed_mm_s = 60.0",
            "max_speed_mm_s = 160.0",
            "[torque] the motor has nothing left at",
        ],
        [
            "start_stop_mm_s = 5.0",
            "start_stop_mm_s = -5.0",
            "[axis] start_stop_mm_s = -5 is not above zero",
        ],
        [
            "x_kg = 5.0",
            "x_kg = -5.0",
            "[load] x_kg = -5 is not zero or above",
        ],
        ["x_kg = 5.0", "", "missing field `x_kg`"],
        ["[axis]", "[axes]", "unknown field `axes`"],
        ["hz = 45.0", "hz = 0.0", "[mode_x] hz = 0, damping = 0.03: "],
        ["\"zv\"", "\"zv2\"", "[mode_x] shaper = \"zv2\" is none of"],
        ["[mode_y]", "[mode_z]", "unknown field `mode_z`"],
    ];
    assert_refused_with(LOADED, &changes, |machine| {
        Some(format!("{:#}", Machine::parse(machine).err()?))
    });
    let (one, _) = LOADED.split_once("[mode_y]").unwrap();
    let error = Machine::parse(one).unwrap_err().to_string();
    assert_eq!(
        error,
        "[mode_x] without [mode_y]: neither or both are needed"
    );
    let settings = Settings {
        tolerance_mm: 0.0,
        ..Settings::default()
    };
    let machine = Machine::parse(LOADED).unwrap();
    let error = run(&machine, &fast(), &settings, &mut |_, _| Ok(())).unwrap_err();
    assert!(format!("{error:#}").contains("leaves nothing for the shapers"));
}
