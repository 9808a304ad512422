//! Forty programs, four drawings in the words of ten kinds of programs that write G-code, through
//! `stage`; and the drawings as lines through `delta`.

mod drawings;
mod writers;

use std::fs;

use tempfile::TempDir;

use drawings::drawings;
use writers::WRITERS;

use crate::tools::artefacts::run_into;
use crate::tools::report::{number, report_in};

/// Half a step of each axis, what the axes' cubics leave the curves, and half of a third decimal.
const OFF_MM: f64 = 0.01 * core::f64::consts::FRAC_1_SQRT_2 + 0.0015;

/// By which the Delta's lines are smoothed, and half a step of each arm through the mechanism.
const CORNER_MM: f64 = 1.0;
const DELTA_STEP_MM: f64 = 0.02;

fn report(example: &str, arguments: &[&str]) -> serde_json::Value {
    let folder = TempDir::new().unwrap();
    let output = run_into(folder.path(), example, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    report_in(folder.path())
}

#[test]
fn forty_programs_run_through_the_stage() {
    let folder = TempDir::new().unwrap();
    for (drawing, parts) in drawings() {
        let mut durations_s = Vec::new();
        for (writer, write) in WRITERS {
            let file = folder.path().join(format!("{writer}-{drawing}.nc"));
            fs::write(&file, write(&parts)).unwrap();
            let report = report("stage", &["--gcode", file.to_str().unwrap()]);
            let number = |of: &str| number(&report, of);
            let worst = number("/max_deviation_mm");
            let most = number("/tolerance_mm") + OFF_MM;
            assert!(worst <= most, "{writer}, {drawing}: {worst} mm");
            assert!(number("/closing_error_mm") <= OFF_MM, "{writer}, {drawing}");
            for lost in ["", "/motors/x", "/motors/y"] {
                let steps = number(&format!("{lost}/lost_steps"));
                assert!(steps.abs() < 0.5, "{writer}, {drawing}: {steps}");
            }
            durations_s.push(number("/duration_s"));
        }
        // The same motion in other words: digits, and where arcs are lines, cost little.
        let [least, most] = [f64::min, f64::max].map(|of| {
            let all = durations_s.iter().copied();
            all.reduce(of).unwrap()
        });
        println!("{drawing}: {least:.2} to {most:.2} s");
        assert!(most < 1.05 * least, "{drawing}: {durations_s:?}");
    }
}

#[test]
fn the_drawings_run_through_the_delta() {
    let folder = TempDir::new().unwrap();
    for (drawing, parts) in drawings() {
        let mut text = String::from("0 0 -300 100\n");
        let mut at = [60.0, 50.0];
        for part in &parts {
            for [x, y] in part.points(at) {
                text += &format!("{:.3} {:.3} -300 100\n", x - 60.0, y - 50.0);
            }
            at = part.to();
        }
        let file = folder.path().join(format!("{drawing}.txt"));
        fs::write(&file, text).unwrap();
        let report = report("delta", &["--input", file.to_str().unwrap()]);
        let number = |of: &str| number(&report, of);
        let worst = number("/max_path_error_mm");
        assert!(worst <= CORNER_MM + DELTA_STEP_MM, "{drawing}: {worst} mm");
        for motor in 0..3 {
            assert!(number(&format!("/motors/{motor}/lost_steps")).abs() < 0.5);
        }
        println!("{drawing}: {} s", number("/duration_s"));
    }
}
