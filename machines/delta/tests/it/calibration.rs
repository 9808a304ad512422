//! Calibration from measured points, as text in and text out.

use delta::{Fit, MACHINE, Machine};

const MEASURED: &str = include_str!("../../inputs/measured.txt");

/// The noise of the measured points is 0.01 mm of each coordinate: 0.017 mm of a point.
const NOISE_MM: f64 = 0.02;

fn machine() -> Machine {
    Machine::parse(MACHINE).unwrap()
}

/// The numbers of a key in a machine file, in the order of the arms.
fn numbers(file: &str, key: &str) -> Vec<f64> {
    let arms = file.split_once("\n[[arm]]\n").unwrap().1;
    let lines = arms.lines().filter_map(|line| line.split_once(" = "));
    let values = lines.filter(|(name, _)| *name == key);
    values.map(|(_, value)| value.parse().unwrap()).collect()
}

#[test]
fn what_the_points_were_made_with_is_found() {
    let found = machine().calibrate(MEASURED, Fit::Lower).unwrap();
    let file = found.machine_file(MACHINE).unwrap();
    for (key, wanted, tolerance) in [
        ("home_deg", [0.3, -0.2, 0.0], 0.02),
        ("lower_mm", [0.0, 0.0, 0.15], 0.05),
    ] {
        for (found, wanted) in numbers(&file, key).into_iter().zip(wanted) {
            assert!((found - wanted).abs() < tolerance, "{key}: {file}");
        }
    }
    let text = found.to_string();
    let rms: f64 = text.split(' ').nth(2).unwrap().parse().unwrap();
    assert!(rms < NOISE_MM, "{text}");
    assert!(text.starts_with("24 points: "), "{text}");
}

/// Once more with what was found, next to nothing changes, and tables are not doubled.
#[test]
fn a_calibrated_machine_needs_no_more() {
    let first = machine().calibrate(MEASURED, Fit::All).unwrap();
    let file = first.machine_file(MACHINE).unwrap();
    let again = Machine::parse(&file).unwrap();
    let again = again.calibrate(MEASURED, Fit::All).unwrap();
    // TOML takes spaces within the brackets.
    let spaced = file.replacen("[[arm]]", "[[ arm ]]", 1);
    let second = again.machine_file(&spaced).unwrap();
    assert_eq!(second.matches("\n[[arm]]\n").count(), 3);
    for key in ["home_deg", "lower_mm", "upper_mm", "base_mm", "azimuth_deg"] {
        let pairs = numbers(&file, key).into_iter().zip(numbers(&second, key));
        for (first, second) in pairs {
            assert!((first - second).abs() < 1e-3, "{key}: {second}");
        }
    }
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    for (text, wanted) in [
        (
            "# nothing\n1 2 3 4 5\n",
            "line 2: 5 numbers in \"1 2 3 4 5\", `a b c x y z` is needed",
        ),
        ("0 0 0 0 0 x\n", "line 1: \"x\" is not a number"),
        ("0 0.5 0 0 0 -200\n", "line 1: 0.5 is no count of steps"),
        ("\n0 0 0 0 0 200\n", "line 2: measured point 0: "),
        (
            "",
            "0 measured points are too few for 3 parameters: 1 at least",
        ),
    ] {
        let error = machine().calibrate(text, Fit::Homes).unwrap_err();
        let said = format!("{error:#}");
        assert!(said.starts_with(wanted), "{said}");
    }
}

#[test]
fn a_file_with_its_arms_in_another_form_is_refused() {
    let text = format!("arm = [{{}}, {{}}, {{}}]\n{MACHINE}");
    let machine = Machine::parse(&text).unwrap();
    let found = machine.calibrate(MEASURED, Fit::Homes).unwrap();
    let error = format!("{:#}", found.machine_file(&text).unwrap_err());
    assert!(
        error.starts_with("with a table [[arm]] for each of the three arms: line "),
        "{error}"
    );
}
