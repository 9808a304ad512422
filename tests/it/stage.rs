//! The example `stage` from outside: its files, checked by other code than its own.

mod dialogue;
mod programs;
mod refused_programs;
mod run;
mod timed;

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use run::{ROUNDING_MM, Run, STEP_MM};

use crate::tools::artefacts::{assert_all_or_none, assert_refused};

const DRAWINGS: [&str; 3] = ["test", "rosette", "link"];

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("machines/stage/drawings")
        .join(name)
        .with_extension("gcode")
}

#[test]
fn shipped_drawings_end_where_they_are_programmed_to() {
    let ends = [[20.0, 20.0], [60.0, 50.0], [15.0, 20.0]];
    for (drawing, end) in DRAWINGS.into_iter().zip(ends) {
        for (steps, most_mm) in [
            // The tolerance, and half a step of each axis.
            ("timed", 0.0171),
            ("published", 0.02),
            ("nearest", 0.015),
            ("bresenham", 0.015),
        ] {
            let file = shipped(drawing);
            let run = Run::of(&["--gcode", file.to_str().unwrap(), "--steps", steps]);
            let path = run.path();
            let last = path.last().unwrap();
            for (at, end) in last.1.iter().zip(end) {
                assert!((at - end).abs() < ROUNDING_MM, "{drawing}: {last:?}");
            }
            assert!(path.is_sorted_by(|a, b| a.0 <= b.0));
            assert!((last.0 - run.number("/duration_s")).abs() < 1e-5);
            let worst = run.number("/max_deviation_mm");
            assert!(worst <= most_mm, "{drawing}, {steps}: {worst}");
            assert!(run.number("/closing_error_mm") < ROUNDING_MM);
            assert!(run.number("/lost_steps") + run.number("/corrected_steps") < 0.5);
            let svg = fs::read(run.folder.path().join("stage.svg")).unwrap();
            assert!(svg.ends_with(b"</svg>\n"));
        }
    }
}

/// The circle of the test path by its own definition, and its speed.
#[test]
fn a_circle_is_a_circle_at_its_feed() {
    let gcode = "G21 G90\nG0 X80 Y50\nG3 I-20 F600\n";
    for (steps, most_steps) in [
        ("timed", 0.7072),
        ("published", 1.0),
        ("nearest", 0.7072),
        ("bresenham", 0.5),
    ] {
        let run = Run::of_text(gcode, &["--steps", steps]);
        let path = run.path();
        let begin = path
            .iter()
            .position(|(_, [x, y])| (x - 80.0).abs() + (y - 50.0).abs() < ROUNDING_MM)
            .unwrap();
        let circle = &path[begin..];
        let off = circle
            .iter()
            .map(|(_, [x, y])| ((x - 60.0).hypot(y - 50.0) - 20.0).abs())
            .fold(0.0, f64::max);
        assert!(off <= most_steps * STEP_MM + ROUNDING_MM, "{steps}: {off}");
        assert!(
            (off - run.number("/max_deviation_mm")).abs() < 0.004,
            "{steps}"
        );
        let mut quarters = [false; 4];
        for (_, [x, y]) in circle {
            quarters[usize::from(*x > 60.0) + 2 * usize::from(*y > 50.0)] = true;
        }
        assert_eq!(quarters, [true; 4]);
        let taken = circle.last().unwrap().0 - circle[0].0;
        let wanted = core::f64::consts::TAU * 20.0 / 10.0;
        assert!((taken / wanted - 1.0).abs() < 0.01, "{steps}: {taken} s");
    }
}

#[test]
fn steps_are_counted() {
    let exactly = ["--tolerance", "0"];
    let run = Run::of_text("G0 X3 Y-0.5\nG91\nX-1 Y0.25\nG20 G1 X0.1 F20", &exactly);
    let last = run.path().last().unwrap().1;
    assert!((last[0] - 4.54).abs() < ROUNDING_MM && (last[1] + 0.25).abs() < ROUNDING_MM);
    assert!((run.number("/steps_x") - 654.0).abs() < ROUNDING_MM);
    assert!((run.number("/steps_y") - 75.0).abs() < ROUNDING_MM);
    assert!((run.number("/end_steps/0") - 454.0).abs() < ROUNDING_MM);
}

/// Arcs by R: the shorter way, the longer, both ways around.
#[test]
fn arcs_by_radius_go_the_right_way() {
    // About (20, 20), radius 10, from (30, 20) to (20, 30) or its mirror about the chord.
    for (arc, length) in [
        ("G3 X20 Y30 R10", 0.25),
        ("G3 X20 Y30 R-10", 0.75),
        ("G2 X20 Y30 R10", 0.25),
        ("G2 X20 Y30 I-10", 0.75),
        ("G3 X20 Y30 I-10", 0.25),
    ] {
        let run = Run::of_text(&format!("G0 X30 Y20\n{arc} F600"), &[]);
        let begin = Run::of_text("G0 X30 Y20", &[]).number("/duration_s");
        let taken = run.number("/duration_s") - begin;
        let wanted = core::f64::consts::TAU * length;
        // From nearly at rest to 10 mm/s and back.
        assert!((taken / wanted - 1.0).abs() < 0.04, "{arc}: {taken} s");
    }
}

/// Ends that change places when they are rounded make no full circle of a dot, no dot of a circle.
#[test]
fn arcs_of_less_than_a_step_and_of_nearly_a_turn() {
    let dot = Run::of_text("G0 X30 Y20\nG3 X29.99999 Y20.003 I-10 F600", &[]);
    assert!(dot.path().len() < 6000);
    let turn = Run::of_text("G0 X30 Y20\nG2 X29.99999 Y20.003 I-10 F600", &[]);
    assert!(turn.path().len() > 10_000);
    assert!(turn.number("/max_deviation_mm") < 0.02);
    // Below a step altogether.
    let tiny = Run::of_text("G0 X1\nG3 I0.004 F600", &[]);
    assert!(tiny.number("/max_deviation_mm") < 0.02);
}

/// Arcs of a few steps are arcs, and none is too small.
#[test]
fn arcs_of_a_few_steps() {
    for (arc, steps, most_mm) in [
        // About (0, -2), in steps: three quarters, one, all.
        ("G3 X0.02 Y-0.02 J-0.02 F600", 12, 0.0071),
        ("G2 X0.02 Y-0.02 J-0.02 F600", 4, 0.0071),
        ("G3 J-0.02 F600", 16, 0.0071),
        // Start and centre nearest to one grid point.
        ("G3 I0.0049 J0.0049 F600", 8, 0.0145),
        ("G0 X0.0049 Y0.0049\nG3 I-0.0098 F600", 8, 0.0145),
    ] {
        let run = Run::of_text(arc, &["--steps", "nearest"]);
        assert_eq!(run.path().len(), steps, "{arc}");
        let worst = run.number("/max_deviation_mm");
        assert!(worst < most_mm, "{arc}: {worst} mm");
    }
}

/// Start, end and centre between the points of the grid, rounded in opposite ways.
#[test]
fn arcs_off_the_grid_stay_as_close() {
    for arc in [
        "G0 X10.0149 Y10.0149\nG3 X20.0191 Y20.0191 I5.0002 J5.0002 F600",
        "G0 X10.0051 Y10.0051\nG3 X19.9949 Y19.9949 I4.9998 J4.9998 F600",
        "G0 X10.0049 Y10.0049\nG3 X20.0051 Y20.0051 I5.0001 J5.0001 F600",
    ] {
        let run = Run::of_text(arc, &["--steps", "nearest"]);
        let worst = run.number("/max_deviation_mm");
        assert!(worst < 0.0155, "{arc}: {worst} mm");
    }
}

#[test]
fn lost_steps_are_corrected() {
    for drawing in DRAWINGS {
        for seed in ["1", "2", "77"] {
            let file = shipped(drawing);
            let file = file.to_str().unwrap();
            let run = Run::of(&["--gcode", file, "--lose-steps", "0.001", "--seed", seed]);
            let lost = run.number("/lost_steps");
            assert!((40.0..200.0).contains(&lost), "{drawing}: {lost}");
            assert!((lost - run.number("/corrected_steps")).abs() < 3.5);
            assert!(run.number("/closing_error_mm") <= 0.02);
            assert!(run.number("/max_deviation_mm") <= 0.05);
            // Without corrections, the same losses: one of both is off for certain.
            let open = run.number("/open_loop/max_deviation_mm");
            assert!(open > 0.02, "{drawing}, {seed}: {open}");
        }
    }
}

#[test]
fn losses_follow_their_seed() {
    let lost = |seed: &str| {
        let run = Run::of(&["--lose-steps", "0.1%", "--seed", seed]);
        (
            run.report.to_string(),
            fs::read(run.folder.path().join("stage.svg")).unwrap(),
        )
    };
    assert_eq!(lost("5"), lost("5"));
    assert_ne!(lost("5"), lost("6"));
}

#[test]
fn bad_input_is_one_line_and_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("bad.gcode");
    let cases = [
        (
            "G1 X10 F600\nG1 X20 Y\n",
            "line 2: column 8: Y without a number",
        ),
        (
            "G1 X10 F600\n\nhello\n",
            "line 3: column 1: H without a number",
        ),
        ("G1 X1 X2", "line 1: X2: a second X"),
        ("G0 G1 X3", "line 1: G1: a second motion"),
        ("X3", "line 1: no G0, G1, G2 or G3 before"),
        (
            "G0 X1\nG99999999999 X3",
            "line 2: G99999999999: no code of this stage",
        ),
        ("G1 X3 (Y2", "line 1: \"(Y2\": never closed"),
        ("G1 X3 R2", "line 1: R on a straight motion"),
        ("G1 F0 X3", "line 1: F0: 0 mm/min, not within 0.1..=6000.0"),
        (
            "G1 X1e9",
            "line 1: column 4: X1e9: a number has no exponent",
        ),
        ("G1 X1234567890", "X1234567890: above 100000"),
        ("G2 X3", "line 1: an arc without I, J or R"),
        (
            "G0 X30\nG3 X10 Y20.1 I-10 F60",
            "line 2: the end (10.000, 20.100) is 12.450 mm outside",
        ),
        (
            "G0 X30\nG3 X20 Y10.021 I-10 F60",
            "0.021 mm outside the circle of radius 10.000 mm",
        ),
        (
            "G0 X30\nG3 X10 R9 F60",
            "line 2: R9.000 is too short: start and end are 20.000 mm apart",
        ),
        (
            "G0 X30\nG3 R9 F60",
            "line 2: a full circle by R: its centre can be anywhere",
        ),
        (
            "G0 X30\nG3 X10 R0 F60",
            "line 2: R0.000 is too short: start and end are 20.000 mm apart",
        ),
        ("(nothing)\n", "bad.gcode: nothing moves"),
        (
            "G0 X10\nG1 X130 Y5 F600\nX0",
            "line 2: on the way to (130.000, 5.000) mm: X: the upper limit switch is closed at 12100 steps",
        ),
        (
            "G1 Y-2 F600",
            "line 1: on the way to (0.000, -2.000) mm: Y: the lower limit switch is closed at -100 steps",
        ),
    ];
    for (text, wanted) in cases {
        fs::write(&file, text).unwrap();
        assert_refused("stage", &["--gcode", file.to_str().unwrap()], wanted);
    }
    fs::write(&file, b"G0 X3\nG1 X\xFF\n").unwrap();
    assert_refused(
        "stage",
        &["--gcode", file.to_str().unwrap()],
        "bad.gcode: line 2: column 5: no UTF-8 text",
    );
    for (arguments, wanted) in [
        (
            &["--gcode", "nowhere.gcode"][..],
            "nowhere.gcode: No such file",
        ),
        (&["--lose-steps", "1.5"], "not a fraction within 0..=1"),
        (
            &["--lose-steps", "1"],
            "homing X: the switch has not closed within 15000 steps",
        ),
        (&["--steps", "best"], "invalid value 'best'"),
        (
            &["--tolerance", "-1"],
            "a tolerance of -1 mm, not within 0..=1",
        ),
        (&["--port", "/dev/nowhere"], "/dev/nowhere: "),
    ] {
        assert_refused("stage", arguments, wanted);
    }
    assert_all_or_none("stage", &[], &["steps.csv", "stage.svg", "report.json"]);
}
