//! A machine whose load is known: what is planned against what its simulated motors can turn, and
//! how its tool swings. The simulation gets the edges alone.

use engraver::{Drawing, Engraving, LOADED, Machine, MotorController, Plan, PlanSettings};
use machine_sim::Motor;
use serde_json::Value;
use test_support::loaded::{assert_refused_with, number, with_pull_out};

/// Lines that begin and end at rest, and curves.
const LINES: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><path fill="none"
stroke="black" d="M5 50 95 55 10 20 90 95 50 5 60 95M50 5C90 5 90 60 50 60S10 5 50 5"/></svg>"#;

/// As in `loaded.toml`.
const MOTOR: Motor = Motor {
    holding_torque_nm: 0.4,
    corner_speed_hz: 1000.0,
    inertia_kg_m2: 7.4e-6,
    friction_nm: 0.03,
    damping_ratio: 0.02,
    full_steps_per_turn: 240,
    microsteps: 16,
};
/// Of rotor and arm about the shoulder with the elbow at a right angle, at the motor.
const LOAD_KG_M2: f64 = 1.2e-3;

fn report(machine: &str) -> Value {
    let machine = Machine::parse(machine).unwrap();
    let (drawing, settings) = (Drawing::parse(LINES).unwrap(), PlanSettings::default());
    let plan = Plan::new(&machine, &drawing, &settings, |_, _| ()).unwrap();
    let engraving = Engraving::run(
        &machine,
        &drawing,
        &settings,
        &plan,
        MotorController::Timed,
        &mut (),
        |_, _| (),
    )
    .unwrap();
    assert!(engraving.is_within_bound());
    let figure = engraving.shown().picture().to_string();
    assert!(figure.contains("Torque of the motors"));
    let report = engraving.report(&machine, &drawing, &plan);
    println!("{report}");
    serde_json::to_value(report).unwrap()
}

fn lost_steps(report: &Value) -> f64 {
    let motors = ["shoulder", "elbow", "disc", "vertical"].into_iter();
    motors
        .map(|motor| number(report, &format!("/timed/motors/{motor}/lost_steps")))
        .sum()
}

#[test]
fn a_known_load_is_carried_without_a_lost_step_and_the_tool_swings_less() {
    let report = report(LOADED);
    assert_eq!(lost_steps(&report).to_bits(), 0);
    let [part, planned] =
        ["part", "planned"].map(|name| number(&report, &format!("/timed/torque/{name}")));
    assert!(part <= planned + 1e-9 && part > 0.9 * planned, "{part}");
    let [off, unshaped] =
        ["", "/unshaped"].map(|of| number(&report, &format!("/timed/vibration{of}/left_mm")));
    // What is left is that of whole steps, 0.04 to 0.09 mm each.
    assert!(off < 0.1 && unshaped > 2.5 * off, "{off} mm, {unshaped} mm");
}

/// The simulated motor's own curve times a factor, at any feed, with so much damping.
fn lost_with(factor: f64, damping_ratio: f64) -> f64 {
    let motor = Motor {
        damping_ratio,
        ..MOTOR
    };
    let machine = with_pull_out(LOADED, 40.0, |hz| {
        factor * motor.pull_out_nm(hz, LOAD_KG_M2)
    });
    let machine = machine.replace("feed_mm_s = 150.0", "feed_mm_s = 2000.0");
    let machine = machine.replace("max_hz = 6400.0", "max_hz = 9000.0");
    let damping = format!("damping_ratio = {damping_ratio}");
    lost_steps(&report(&machine.replace("damping_ratio = 0.02", &damping)))
}

/// With the arm's inertia the rotor of 0.02 has a damping of 0.0016: what a change of load makes it
/// swing is there at the next ones, so that above 79 % of its pull-out torque the time between them
/// decides. With five times as much the torque alone does.
#[test]
fn the_limit_is_tight() {
    assert_eq!(lost_with(0.78, MOTOR.damping_ratio).to_bits(), 0);
    assert_eq!(lost_with(0.95, 0.1).to_bits(), 0);
    assert!(lost_with(1.1, 0.1) > 0.5);
}

#[test]
fn what_no_machine_has_is_refused_by_name() {
    let changes = [
        [
            "reserve = 0.3",
            "reserve = 1.0",
            "[torque] reserve = 1 is not 0 to below 1",
        ],
        ["tool_kg = 0.5", "tool_kg = -0.5", "[load]: payload is -0.5"],
        [
            "disc_kg_m2 = 2e-6",
            "disc_kg_m2 = nan",
            "[load] disc_kg_m2 = NaN is not zero or above",
        ],
        ["fore_kg = 0.4", "", "missing field `fore_kg`"],
        [
            "joint_accel_hz_per_s = 1000000.0",
            "joint_accel_hz_per_s = 0.0",
            "[timed]: joint_accel_hz_per_s = 0 is not above zero",
        ],
        ["hz = 40.0", "hz = 0.0", "[mode] hz = 0, damping = 0.03: "],
        ["\"zvd\"", "\"zv2\"", "[mode] shaper = \"zv2\" is none of"],
    ];
    assert_refused_with(LOADED, &changes, |machine| {
        Some(format!("{:#}", Machine::parse(machine).err()?))
    });
}
