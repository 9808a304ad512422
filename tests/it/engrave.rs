//! The example `engrave` from outside: its files, checked by other code than its own.

mod left_out;
mod motors;
mod pace;
mod timed;

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

use crate::tools::artefacts::{assert_all_or_none, assert_refused, run_into};
use crate::tools::report::{number, report_in};

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("machines/engraver")
        .join(name)
}

/// A finished run's files.
struct Run {
    folder: TempDir,
    report: Value,
    summary: String,
    /// Standard error.
    notes: Vec<String>,
}

impl Run {
    fn of(arguments: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        let output = run_into(folder.path(), "engrave", arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        Self {
            report: report_in(folder.path()),
            summary: String::from_utf8(output.stdout).unwrap(),
            notes: errors.lines().map(str::to_owned).collect(),
            folder,
        }
    }

    /// Engraves a drawing that comes with the machine.
    fn of_drawing(name: &str, options: &[&str]) -> Self {
        let file = shipped(&format!("drawings/{name}.svg"));
        Self::of(&[&["--svg", file.to_str().unwrap()], options].concat())
    }

    /// Engraves the text of an SVG file.
    fn of_text(text: &str, options: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        let svg = folder.path().join("some.svg");
        fs::write(&svg, text).unwrap();
        Self::of(&[&["--svg", svg.to_str().unwrap()], options].concat())
    }

    fn number(&self, pointer: &str) -> f64 {
        number(&self.report, pointer)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.path().join(name)).unwrap()
    }

    fn angle(&self, joint: &str, pulses: i32) -> f64 {
        self.number(&format!("/machine/home_rad/{joint}"))
            + f64::from(pulses) * self.number(&format!("/machine/rad_per_pulse/{joint}"))
    }

    /// Direction of the forearm.
    fn elbow(&self, [elbow, shoulder, ..]: [i32; 4]) -> f64 {
        self.angle("shoulder", shoulder) + self.angle("elbow", elbow)
    }

    fn tool(&self, position: [i32; 4]) -> (f64, f64) {
        let upper = self.number("/machine/upper_mm");
        let fore = self.number("/machine/fore_mm");
        let shoulder = self.angle("shoulder", position[1]);
        let elbow = self.elbow(position);
        (
            upper * shoulder.cos() + fore * elbow.cos(),
            upper * shoulder.sin() + fore * elbow.sin(),
        )
    }

    fn user_to_machine(&self, x: f64, y: f64) -> (f64, f64) {
        let [a, b, c, d, e, f] =
            [0, 1, 2, 3, 4, 5].map(|k| self.number(&format!("/placement/{k}")));
        (a * x + c * y + e, b * x + d * y + f)
    }
}

/// Positions of elbow, shoulder, disc and the vertical axis after each record.
fn integrate(pattern: &[u8]) -> Vec<(bool, [i32; 4])> {
    let mut position = [0; 4];
    pattern
        .chunks_exact(3)
        .map(|record| {
            let signed = |byte: u8, count: i32| if byte & 0x80 == 0 { count } else { -count };
            let fast = record[0] & 0x1F == 0x1F;
            if fast {
                let count = i32::from(record[1]) << 8 | i32::from(record[2]);
                position[usize::from(record[0] >> 5 & 3)] += signed(record[0], count);
            } else {
                // In the order disc, elbow, shoulder.
                for (axis, byte) in [2, 0, 1].into_iter().zip(record) {
                    position[axis] += signed(*byte, i32::from(byte & 0x1F));
                }
            }
            (fast, position)
        })
        .collect()
}

#[test]
fn shipped_drawings_keep_their_bound() {
    for drawing in ["rosette", "lettering", "star"] {
        let run = Run::of_drawing(drawing, &[]);
        let (worst, bound) = (run.number("/max_deviation_mm"), run.number("/bound_mm"));
        assert!(worst <= bound, "{drawing}: {worst} > {bound}");
        assert!(worst > 0.0 && run.number("/rms_deviation_mm") < worst);
        assert!(run.number("/missing_mm").to_bits() == 0);
        assert_eq!(run.notes, [""; 0], "{drawing}");
        assert!(run.read("engraved.svg").ends_with(b"</svg>\n"));
    }
}

#[test]
fn the_bytes_alone_draw_a_circle() {
    // Root units are not pixels: the view box is scaled and moved.
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="60mm" viewBox="-20 10 40 40">
        <g transform="translate(5 20)"><circle cx="1" cy="4" r="9"/></g></svg>"#;
    let run = Run::of_text(text, &[]);
    let (x, y) = run.user_to_machine(6.0, 24.0);
    let (edge, _) = run.user_to_machine(15.0, 24.0);
    let (radius, bound) = (edge - x, run.number("/bound_mm"));
    assert!(radius > 60.0, "{radius}: the bed is not filled");

    let positions = integrate(&run.read("pattern.bin"));
    let mut seen = [false; 72];
    for &(fast, position) in &positions {
        if fast {
            continue;
        }
        let [.., disc, vertical] = position;
        assert!(vertical < 0, "engraved above the glass");
        let disc = run.elbow(position) + run.angle("disc", disc);
        let (tool_x, tool_y) = run.tool(position);
        let (at_x, at_y) = (tool_x - x, tool_y - y);
        assert!((at_x.hypot(at_y) - radius).abs() <= bound);
        // The disc is tangent: square to the radius, to some steps of the arm and its own.
        let square = (disc.cos() * at_x + disc.sin() * at_y) / radius;
        assert!(square.abs() < 0.08, "the disc is off by {square} rad");
        let share = (at_y.atan2(at_x) / core::f64::consts::TAU).rem_euclid(1.0) * 72.0;
        seen[(0..72)
            .find(|k| f64::from(*k) + 1.0 > share)
            .map_or(0, |k| usize::try_from(k).unwrap())] = true;
    }
    assert!(
        seen.iter().all(|seen| *seen),
        "a part of the circle is missing"
    );
    assert_eq!(positions.last().unwrap().1, [0; 4], "not home");
}

#[test]
fn the_dump_has_every_pulse() {
    let run = Run::of_drawing("star", &[]);
    let dump = String::from_utf8(run.read("pulses.vcd")).unwrap();
    let (head, body) = dump.split_once("$enddefinitions").unwrap();
    for axis in ["elbow", "shoulder", "disc", "vertical"] {
        let name = format!("{axis}_step");
        assert!(head.contains(&format!("{axis}_dir")));
        let declared = head.lines().find(|line| line.contains(&name)).unwrap();
        let id = declared.split_whitespace().nth(3).unwrap();
        let rising = body
            .lines()
            .filter(|line| line.strip_prefix('1') == Some(id));
        let falling = body
            .lines()
            .filter(|line| line.strip_prefix('0') == Some(id));
        let pulses = run
            .report
            .pointer(&format!("/pulses/{axis}"))
            .and_then(Value::as_u64);
        let rising = u64::try_from(rising.count()).unwrap();
        assert_eq!(Some(rising), pulses, "{axis}");
        // One more for the level at the start.
        assert_eq!(
            u64::try_from(falling.count()).unwrap(),
            rising + 1,
            "{axis}"
        );
    }
    let stamps = body
        .lines()
        .filter_map(|line| line.strip_prefix('#')?.parse::<u64>().ok());
    assert!(stamps.clone().is_sorted_by(|a, b| a < b));
    let duration_ns = run.number("/duration_s") * 1e9;
    let last: u32 = (stamps.max().unwrap() / 1000).try_into().unwrap();
    assert!((f64::from(last) * 1e3 - duration_ns).abs() < 1e4);
}

/// Strokes whose file goes from one end of the drawing to the other for each.
fn hatch(count: u32) -> String {
    let stroke = |k: u32| {
        let (x, y) = (k * 737 % count % 40, k * 737 % count / 40);
        format!("<path d='M{x}.2 {y}.1h.6' stroke='black'/>")
    };
    let body: String = (0..count).map(stroke).collect();
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 30'>{body}</svg>")
}

#[test]
fn strokes_are_ordered_and_a_huge_dump_is_asked_for() {
    let folder = TempDir::new().unwrap();
    let svg = folder.path().join("hatch.svg");
    let out = folder.path().join("out");
    let run = |count: u32, options: &[&str]| {
        fs::write(&svg, hatch(count)).unwrap();
        let input = ["--svg", svg.to_str().unwrap()];
        let output = run_into(&out, "engrave", &[&input, options].concat());
        assert!(output.status.success(), "{output:?}");
        let dump = fs::metadata(out.join("pulses.vcd")).ok();
        (report_in(&out), dump.map(|file| file.len()))
    };

    let (ordered, _) = run(300, &[]);
    let (kept, dump) = run(300, &["--keep-order", "--vcd"]);
    let pulses = |report: &Value| {
        let pulses = report["pulses"].as_object().unwrap();
        pulses.values().filter_map(Value::as_u64).sum::<u64>()
    };
    // An edge up and one down of each pulse, with a stamp or another edge: 4 bytes at least.
    assert!(dump.unwrap() > 4 * pulses(&kept));
    for same in ["/strokes", "/length_mm"] {
        assert!(
            (number(&ordered, same) - number(&kept, same)).abs() < 1e-6,
            "{same}"
        );
    }
    assert!(number(&ordered, "/travel_mm") * 10.0 < number(&kept, "/travel_mm"));

    let (huge, dump) = run(1200, &[]);
    assert!(pulses(&huge) > 500_000);
    assert_eq!(dump, None, "the run before has left its own");
}

#[test]
fn bad_input_is_one_line_and_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let machine = fs::read_to_string(shipped("machine.toml")).unwrap();
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        fs::write(&file, text).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let short = write(
        "short.toml",
        &machine.replace("fore_mm = 132.0", "fore_mm = -1.0"),
    );
    let typo = write("typo.toml", &machine.replace("lift_mm", "lift_cm"));
    let slow = write(
        "slow.toml",
        &machine.replace("max_hz = 800.0", "max_hz = 9.0"),
    );
    let endless = write(
        "endless.toml",
        &machine.replace("corner_deg = 25.0", "corner_deg = inf"),
    );
    let codes = write(
        "codes.toml",
        &machine.replace("shoulder = 1", "shoulder = 0"),
    );
    let broken = write(
        "broken.svg",
        "<svg xmlns='http://www.w3.org/2000/svg'><path d=",
    );
    let empty = write("empty.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>");
    let wide =
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><path d='M0 0H9'/></svg>";
    let wide = write("wide.svg", wide);
    let cases: [(&[&str], &str); 15] = [
        (&["--svg", "nowhere.svg"], "nowhere.svg: No such file"),
        (&["--svg", &broken], "broken.svg: "),
        (&["--svg", &empty], "empty.svg: there is nothing to draw"),
        (
            &["--svg", &wide, "--placement", "1,0,0,1,500,0"],
            "stroke 1 of 1: at 0 of line 0, (500, 0): too far",
        ),
        (
            &["--machine", &short],
            "short.toml: [arm]: length -1 of the forearm",
        ),
        (
            &["--machine", &typo],
            "line 34, column 1: unknown field `lift_cm`",
        ),
        (
            &["--machine", &codes],
            "elbow and shoulder: both have the axis code 0",
        ),
        (&["--tolerance", "-1"], "--tolerance: -1 is not above 0 mm"),
        (
            &["--tolerance", "1e-300"],
            "--tolerance: 1e-300 is below 1e-6 mm",
        ),
        (
            &["--tolerance", "1e300"],
            "--tolerance: 1e300 is above 10 mm",
        ),
        (
            &["--tolerance", "x"],
            "invalid value 'x' for '--tolerance <MM>'",
        ),
        (
            &["--placement", "1e30,0,0,1e30,0,0", "--keep-order"],
            "too far",
        ),
        (
            &["--machine", &endless],
            "endless.toml: [disc]: corner_deg = inf is not finite",
        ),
        (&["--machine", &slow], "slow.toml: [rapid]: start rate"),
        (
            &["--tolerance", "nan"],
            "--tolerance: NaN is not above 0 mm",
        ),
    ];
    for (arguments, wanted) in cases {
        assert_refused("engrave", arguments, wanted);
    }
}

#[test]
fn a_folder_in_an_artefacts_place_is_refused_before_any_is_written() {
    assert_all_or_none(
        "engrave",
        &[],
        &["pattern.bin", "pulses.vcd", "engraved.svg", "report.json"],
    );
}

/// An SVG body in a view box of 100 by 100.
fn page(body: &str) -> String {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>")
}

fn run_body(body: &str) -> Run {
    Run::of_text(&page(body), &[])
}

/// How near the tool in the glass comes to a place of the drawing, in mm.
fn nearest(run: &Run, x: f64, y: f64) -> f64 {
    let (x, y) = run.user_to_machine(x, y);
    integrate(&run.read("pattern.bin"))
        .iter()
        .filter(|(_, position)| position[3] < 0)
        .map(|(_, position)| {
            let (at_x, at_y) = run.tool(*position);
            (at_x - x).hypot(at_y - y)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Curves that run along a line and turn back on it: flattening misses their tips.
#[test]
fn folded_curves_are_engraved_to_their_tips() {
    for turn in [0, 17] {
        let run = run_body(&format!(
            "<g transform='rotate({turn})' fill='none' stroke='black'>
             <path d='M50 60Q50 90 50 60M10 50C110 50 -10 50 90 50M20 20Q20 20 40 20'/></g>"
        ));
        let bound = run.number("/bound_mm");
        assert!(run.number("/max_deviation_mm") <= bound);
        let (sin, cos) = f64::from(turn).to_radians().sin_cos();
        for (x, y) in [(50.0, 75.0), (50.0, 60.0), (40.0, 20.0)] {
            let off = nearest(&run, cos * x - sin * y, sin * x + cos * y);
            assert!(off <= bound, "{off} mm from the tip {x}, {y}");
        }
    }
}

#[test]
fn dots_are_engraved() {
    // Below one step, without length, alone in the drawing.
    for body in [
        "<path d='M10 10h0.01M20 20L20 20M50 50L90 60' stroke='black'/>",
        "<path d='M20 20L20 20' stroke='black' stroke-linecap='round'/>",
    ] {
        let run = run_body(body);
        let bound = run.number("/bound_mm");
        assert!(run.number("/max_deviation_mm") <= bound);
        assert!(nearest(&run, 20.0, 20.0) <= bound);
    }
}
