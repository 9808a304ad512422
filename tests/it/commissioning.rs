//! What is done once when a machine is set up: `calibrate` and `resonance`.

use std::fs;
use std::process::Output;

use tempfile::TempDir;

use crate::tools::example::example;

fn run(name: &str, arguments: &[&str], folder: &TempDir) -> Output {
    let mut command = example(name);
    command.args(arguments).arg("--out").arg(folder.path());
    command.output().unwrap()
}

#[test]
fn both_arms_are_calibrated_from_csv() {
    for (kind, found) in [
        ("engraver", "gear_ratio = 13.05"),
        ("delta", "lower_mm = 0.17"),
    ] {
        let folder = TempDir::new().unwrap();
        let output = run("calibrate", &[kind], &folder);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.starts_with("24 points: 0.0"), "{said}");
        let file = fs::read_to_string(folder.path().join("machine.toml")).unwrap();
        assert!(file.contains(found), "{file}");
    }
}

#[test]
fn points_that_cannot_be_read_leave_nothing_behind() {
    let folder = TempDir::new().unwrap();
    let points = folder.path().join("points.csv");
    fs::write(&points, "shoulder,elbow,x_mm,y_mm\n1,2,3,x\n").unwrap();
    let output = run(
        "calibrate",
        &["engraver", "--points", points.to_str().unwrap()],
        &folder,
    );
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.ends_with("points.csv: line 2, y_mm: \"x\" is not a number\n"),
        "{said}"
    );
    assert!(!folder.path().join("machine.toml").exists());
}

/// The log was made with modes of 38.5 and 71 Hz and dampings of 0.045 and 0.03.
#[test]
fn modes_and_the_best_shaper_are_found_in_a_log() {
    let folder = TempDir::new().unwrap();
    let output = run("resonance", &[], &folder);
    let said = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<_> = said.lines().collect();
    let starts = |line: usize, with| assert!(lines[line].starts_with(with), "{said}");
    starts(0, "38.49 Hz ± 0.01, damping 0.0449 ");
    starts(1, "70.96 Hz ± 0.02, damping 0.0302 ");
    starts(2, "3-hump EI at 67.3 Hz: 4.9 % left at worst");
    assert!(
        fs::read_to_string(folder.path().join("resonance.svg"))
            .unwrap()
            .starts_with("<svg")
    );
    let output = run("resonance", &["--column", "accel_z"], &folder);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
}
