//! Programs as other tools write them: what is passed over is said, what would move
//! X or Y otherwise is refused.
use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::run::{ROUNDING_MM, Run, STEP_MM};
use crate::tools::report::without_file;

/// Where a path of whole steps passes a programmed point: half a step in both axes, and the
/// deviation of arcs.
const PASSED_MM: f64 = 0.02;

/// Asserts that the path has all points `x y`, in this order, and ends at the last of them.
fn assert_passes(run: &Run, points: &[&str]) {
    let path = run.path();
    let mut rest = path.iter().peekable();
    for point in points.iter().flat_map(|points| points.split(", ")) {
        let mut numbers = point.split(' ').map(|word| word.parse::<f64>().unwrap());
        let [x, y] = [(); 2].map(|()| numbers.next().unwrap());
        let found = rest.any(|(_, at)| (at[0] - x).hypot(at[1] - y) < PASSED_MM);
        assert!(found, "{point} is not passed");
    }
    let behind = f64::from(u32::try_from(rest.count()).unwrap()) * STEP_MM;
    assert!(
        behind <= 2.0 * PASSED_MM,
        "{behind} mm behind the last point"
    );
}

fn of_sample(name: &str) -> Run {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/stage/gcode");
    Run::of(&["--gcode", folder.join(name).to_str().unwrap()])
}

#[test]
fn inkscape() {
    let run = of_sample("inkscape.nc");
    let heart = "40 30, 60 60, 50 70, 40 60, 30 70, 20 60, 40 30";
    let ring = "95 40, 80 55, 65 40, 80 25, 95 40, 0 0";
    assert_passes(&run, &[heart, ring]);
    assert_eq!(
        without_file(&run.notes),
        [
            "line 4: M3, M5: passed over, there is no spindle and no laser (2 times)",
            "line 12: Z: passed over, the stage has no such axis (10 times)",
        ]
    );
    let reported = run.report["notes"].as_array().unwrap();
    let reported: Vec<_> = reported.iter().map(|note| note.as_str().unwrap()).collect();
    assert_eq!(reported, without_file(&run.notes));
}

#[test]
fn lightburn() {
    let run = of_sample("lightburn.nc");
    let cut = "10 10, 70 10, 70 50, 10 50, 10 10";
    assert_passes(&run, &[cut, "20 20, 60 20, 60 21, 20 21, 0 0"]);
    assert_eq!(
        without_file(&run.notes),
        [
            "line 3: G40: passed over, there are no tools to change or to measure (1 time)",
            "line 3: G54: passed over, the work offset is always 0 (1 time)",
            "line 5: M4, S, M5: passed over, there is no spindle and no laser (6 times)",
            "line 7: M8, M9: passed over, there is no coolant and no air (2 times)",
            "line 18: F9000: above what the motors can follow, run at 6000 mm/min (1 time)",
        ]
    );
    let run = of_sample("lightburn-relative.nc");
    assert_passes(&run, &["15 12, 45 12, 45 37, 15 37, 15 12, 0 0"]);
    assert!(without_file(&run.notes)[2].starts_with("line 4: M4, S, M5: "));
}

#[test]
fn fusion() {
    let run = of_sample("fusion.nc");
    let outline = "20 11.4, 20 12, 80 12, 87.07 14.93, 90 22, 90 60, 80 70, 20 70, 12.93 67.07";
    let bore = "60 41, 50 51, 40 41, 50 31, 60 41, 50 51, 40 41, 50 31, 60 41, 0 0";
    assert_passes(&run, &[outline, "10 60, 10 22, 20 12, 20 12.6", bore]);
    assert_eq!(
        without_file(&run.notes),
        [
            "line 2: O: a program's number, passed over (1 time)",
            "line 9: G28, Z, K: passed over, the stage has no such axis (13 times)",
            "line 13: M6, T, G43: passed over, there are no tools to change or to measure (3 times)",
            "line 14: M3, M5: passed over, there is no spindle and no laser (2 times)",
            "line 15: G54: passed over, the work offset is always 0 (1 time)",
            "line 16: M8, M9: passed over, there is no coolant and no air (2 times)",
            "line 21: G19: an arc that is a line seen from above (2 times)",
            "line 45: G53: the machine's coordinates are the drawing's (1 time)",
        ]
    );
}

#[test]
fn freecad() {
    let run = of_sample("freecad.nc");
    let circle = "30 40, 50 60, 70 40, 50 20, 30 40";
    assert_passes(&run, &[circle, "50 40, 90 40, 90 80"]);
    assert_eq!(
        without_file(&run.notes),
        [
            "line 4: G40, G49, M6, T, G43: passed over, there are no tools to change or to \
             measure (6 times)",
            "line 4: G54: passed over, the work offset is always 0 (2 times)",
            "line 7: M5, M3: passed over, there is no spindle and no laser (3 times)",
            "line 12: Z, K: passed over, the stage has no such axis (10 times)",
            "line 20: G98: passed over, they move neither X nor Y (1 time)",
            "line 21: G81: a rapid move to the hole, which is not drilled (3 times)",
        ]
    );
}

#[test]
fn slicer() {
    let run = of_sample("slicer.nc");
    let part = "40.25 40.25, 80.25 40.25, 80.25 60.25, 77.32 67.32, 70.25 70.25, 40.25 70.25";
    assert_passes(&run, &["60 0, 100 0", part, "40.25 40.25, 50 50"]);
    assert_eq!(
        without_file(&run.notes),
        [
            "line 4: M73, M201, M203, M204, M205, M107, M115, M104 and others: passed over, they \
             move neither X nor Y (19 times)",
            "line 13: M83, E: passed over, there is no extruder (11 times)",
            "line 18: G28: the reference point is the drawing's zero (1 time)",
            "line 20: G92: passed over, X and Y stay as they are (1 time)",
            "line 30: F10800: above what the motors can follow, run at 6000 mm/min (2 times)",
            "line 30: Z: passed over, the stage has no such axis (2 times)",
            "line 45: G4: passed over, the stage does not dwell (1 time)",
        ]
    );
}

/// Asserts that two programs make the same steps at the same times.
fn assert_same(program: &str, wanted: &str) {
    let at_feed = ["--steps", "nearest"];
    let [got, wanted] = [program, wanted].map(|text| Run::of_text(text, &at_feed).path());
    assert!(
        got == wanted,
        "{program}: {} steps, {} wanted",
        got.len(),
        wanted.len()
    );
}

#[test]
fn what_moves_neither_axis_changes_nothing() {
    let line = "G1 X10 Y5 F600";
    let circle = "G0 X30 Y20\nG3 X10 Y20 I-10 F600";
    for (program, same) in [
        // Z is not there, and a helix keeps its arc.
        ("G1 Z-5 F100\nG1 X10 Y5 Z-7 F600", line),
        ("G0 X30 Y20 Z5\nG3 X10 Y20 Z-3 I-10 K0 F600", circle),
        ("G0 X30 Y20\nG90.1 G3 X10 Y20 I20 J20 F600", circle),
        ("G0 X30 Y20\nG90.1\nG91.1\nG3 X10 Y20 I-10 F600", circle),
        // X and Y of what is no motion.
        ("M201 X50 Y50\nM92 X80 Y80\nM84 X Y\nG1 X10 Y5 F600", line),
        ("F600 G1\nG4 X2\nG4 U3\nG4\nX10 Y5", line),
        ("F600 G1\nG4 P0.5 X10 Y5", line),
        ("G4 S1 G1 X10 Y5 F600", line),
        ("G20\nG0 X0.7874\nG92 X0.78741\nG21", "G0 X20"),
        ("G92 X0 Y0 Z3\nG52 X0 Y0\nG1 X10 Y5 F600", line),
        (
            "G1 X10 Y5 F600\nG92 X10 Y5 E0\nG28 Z0\nG30 G91 Z0\nG38.2 Z-5\nG31 Z-2 F50",
            line,
        ),
        // Modes that are never on, speeds that are exact, tools, all on one line.
        (
            "G50\nG17 G21 G40 G49 G64 P0.1 G69 G80 G90 G94 G1 X10 Y5 F600 S500 T1 M3 M8",
            line,
        ),
        ("G43 H1 G61 G0 Z1\nG1 X10 Y5 F600 A90 B1 C2 E.5 W3 D1", line),
        ("M3 X10 Y5 F600 G1", line),
        ("M62 G1 X10 Y5 F600", line),
        // Checksums as the firmware's own documents have them.
        ("N3 T0*57\nN4 G92 E0*67\nN5 G28*22\nG1 X10 Y5 F600", line),
        ("/N7 g1x10y5f600 (a (b) ; c", line),
        ("G91 G1 X10 Y5 F600\nG53 G1 X10 Y5", line),
        ("G1 X10 Y5 F600\nM30\n(end)\n%\n", line),
        // Drilling: the way from hole to hole.
        (
            "G99 G82 X10 Y5 Z-3 R1 P0.5 F60\nX20\nG91 X5 L1\nG90 G80\nG0 X0",
            "G0 X10 Y5\nX20\nX25\nX0",
        ),
        // Over a point, or at once; all axes, or those named.
        ("G0 X20 Y10\nG28 X5 Y20", "G0 X20 Y10\nX5 Y20\nX0 Y0"),
        ("G0 X20 Y10\nG91 G28 X0\nG90 G0 Y20", "G0 X20 Y10\nX0\nY20"),
        ("G0 X20 Y10\nG28 O W", "G0 X20 Y10\nX0 Y0"),
        ("G0 X20 Y10\nG28 X Y", "G0 X20 Y10\nX0 Y0"),
    ] {
        assert_same(program, same);
    }
}

/// Arcs in the planes of Z: quarters, with either sense of rotation.
#[test]
fn upright_arcs_are_lines_seen_from_above() {
    for (arc, to) in [
        ("G18 G2 X12 Z-2 I2 K0", "X12"),
        ("G18 G3 X12 Z2 I2 K0", "X12"),
        ("G18 G2 X12 Z2 I0 K2", "X12"),
        ("G18 G2 X12 Z2 R2", "X12"),
        ("G19 G3 Y12 Z-2 J2 K0", "Y12"),
        ("G19 G2 Y12 Z2 J2 K0", "Y12"),
        ("G90.1 G19 G2 Y12 Z2 J12 K0", "Y12"),
        ("G91 G19 G2 Y2 Z2 J2", "Y12"),
    ] {
        let start = "G0 X10 Y10 Z0\nF600\n";
        assert_same(&format!("{start}{arc}"), &format!("{start}G1 {to}"));
    }
}

#[test]
fn lines_end_as_on_any_system() {
    let lines = ["%", "G21 (caf\u{e9})", "G1 X10 Y5 F600", "", "M2", "%"];
    for end in ["\n", "\r\n", "\r"] {
        let text = format!("\u{FEFF}{}{end}", lines.join(end));
        assert_same(&text, "G1 X10 Y5 F600");
    }
    // A comment in an old encoding.
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("latin1.nc");
    fs::write(&file, b"(Fr\xE4sen)\nG1 X10 Y5 F600 ; \xB5m\n").unwrap();
    let run = Run::of(&["--gcode", file.to_str().unwrap()]);
    assert_passes(&run, &["10 5"]);
}

#[test]
fn what_comes_after_the_end_is_noted() {
    for (program, note) in [
        (
            "G0 X5\nM2\nG0 X9\nG0 X8\n",
            "line 3: \"G0 X9\", \"G0 X8\": after the program's end, not run (2 times)",
        ),
        (
            "%\nG0 X5\n%\nhello",
            "line 4: \"hello\": after the program's end, not run (1 time)",
        ),
        (
            "/G0 X5",
            "line 1: /: run: no switch deletes blocks here (1 time)",
        ),
    ] {
        let run = Run::of_text(program, &[]);
        assert_passes(&run, &["5 0"]);
        assert_eq!(without_file(&run.notes), [note]);
    }
}

/// A feed above the stage's highest is run at that, and the note has it in the program's unit.
#[test]
fn high_feeds_are_the_highest() {
    let run = Run::of_text("G20 G1 X2 F400\nF300 X0", &["--steps", "nearest"]);
    assert_eq!(
        without_file(&run.notes),
        ["line 1: F400, F300: above what the motors can follow, run at 6000 mm/min (2 times)"]
    );
    let wanted = 2.0 * 2.0 * 25.4 / 100.0;
    assert!((run.number("/duration_s") - wanted).abs() < wanted * ROUNDING_MM + 1e-5);
}

/// A drawing whose zero is elsewhere is put where the stage travels.
#[test]
fn a_drawing_is_moved_by_an_offset_or_to_fit() {
    // Round its own zero, and far away.
    let around = "G1 F600 X-30 Y-20\nX30\nY20\nX-30\nY-20\n";
    let far = "G0 X500 Y700\nG1 F600 X560\nY740\nG3 X560 Y720 I0 J-10\n";
    let run = Run::of_text(around, &["--offset", "40,50"]);
    assert_passes(&run, &["0 0, 10 30, 70 30, 70 70, 10 70, 10 30"]);
    let run = Run::of_text(around, &["--fit"]);
    assert_passes(&run, &["0 0, 60 0, 60 40, 0 40, 0 0"]);
    let run = Run::of_text(far, &["--fit"]);
    assert_passes(&run, &["0 0, 60 0, 60 40, 60 20"]);
    // What fits stays, and an arc begins where it did.
    let arc = "G3 X20 Y0 I10 J0 F600\n";
    let run = Run::of_text(arc, &["--offset", "5,30"]);
    assert_passes(&run, &["5 30, 15 20, 25 30"]);
    let run = Run::of_text("G1 F600 X30 Y40\n", &["--fit"]);
    assert_passes(&run, &["30 40"]);
}
