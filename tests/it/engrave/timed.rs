//! Timed strokes: the same drawing from edges alone, beside the pattern's.

use serde_json::Value;

use super::{Run, page};

/// Rates of `machine.toml`: the joints' largest, in Hz, and what a step may be off by beside it.
const MAX_HZ: f64 = 800.0;
const OFF_S: f64 = 1e-5;

/// The pulses of an axis in a dump: seconds, and whether the direction is negative.
pub(super) fn pulses(dump: &str, axis: &str) -> Vec<(f64, bool)> {
    let (head, body) = dump.split_once("$enddefinitions").unwrap();
    let id = |name: String| {
        let declared = head.lines().find(|line| line.contains(&name)).unwrap();
        declared.split_whitespace().nth(3).unwrap()
    };
    let (step, direction) = (id(format!("{axis}_step")), id(format!("{axis}_dir")));
    let (mut time_ns, mut is_negative, mut pulses) = (0.0, false, Vec::new());
    for line in body.lines() {
        if let Some(stamp) = line.strip_prefix('#') {
            time_ns = stamp.parse().unwrap();
        } else if line.len() > 1 {
            let (value, wire) = line.split_at(1);
            if wire == direction {
                is_negative = value == "1";
            } else if wire == step && value == "1" {
                pulses.push((time_ns * 1e-9, is_negative));
            }
        }
    }
    pulses
}

pub(super) fn timed(drawing: &str) -> Run {
    Run::of_drawing(drawing, &["--controller", "timed"])
}

#[test]
fn drawings_are_nearer_and_evenly_fast() {
    for drawing in ["rosette", "lettering", "star"] {
        let run = timed(drawing);
        let plain = Run::of_drawing(drawing, &[]);
        assert_eq!(run.read("pattern.bin"), plain.read("pattern.bin"));
        assert!(plain.report["timed"].is_null());
        let (worst, bound) = (
            run.number("/timed/max_deviation_mm"),
            run.number("/timed/bound_mm"),
        );
        assert!(worst > 0.0 && worst <= bound, "{drawing}: {worst} {bound}");
        assert!(worst <= run.number("/max_deviation_mm"));
        assert!(run.number("/timed/missing_mm") <= 0.0);
        let spread = |of: &str| {
            let of = |name| run.number(&format!("{of}/speed_over_4_mm/{name}"));
            of("deviation_mm_s") / of("mean_mm_s")
        };
        assert!(spread("/timed") < spread(""), "{drawing}");
        // The feed, and what single steps make of it over 4 mm.
        let fastest = run.number("/timed/speed_over_4_mm/max_mm_s");
        assert!(fastest < 15.0 * 1.1, "{drawing}: {fastest}");
        for line in ["pattern and timed strokes:\n", "  in the glass  "] {
            assert!(run.summary.contains(line), "{}", run.summary);
        }
    }
}

/// All pulses are in the dump, bring the machine home, and no motor is faster than it may be.
#[test]
fn the_dump_has_every_pulse_and_no_motor_is_too_fast() {
    let run = timed("star");
    let dump = String::from_utf8(run.read("pulses.vcd")).unwrap();
    for axis in ["elbow", "shoulder", "disc", "vertical"] {
        let pulses = pulses(&dump, axis);
        let counted = run.report.pointer(&format!("/timed/pulses/{axis}"));
        let counted = counted.and_then(Value::as_u64);
        assert_eq!(u64::try_from(pulses.len()).ok(), counted, "{axis}");
        let sum: i32 = pulses
            .iter()
            .map(|(_, is_negative)| if *is_negative { -1 } else { 1 })
            .sum();
        assert_eq!(sum, 0, "{axis} does not come home");
        let end = run.report.pointer(&format!("/timed/end_position/{axis}"));
        assert_eq!(end.and_then(Value::as_i64), Some(0));
        for pair in pulses.windows(2) {
            let [(from_s, one), (to_s, other)] = pair else {
                unreachable!()
            };
            let interval_s = to_s - from_s;
            assert!(
                one != other || interval_s > 1.0 / MAX_HZ - OFF_S,
                "{axis}: {interval_s} s at {from_s} s"
            );
        }
    }
}

/// Dots, curves that begin without speed, corners of all kinds.
#[test]
fn drawings_of_all_kinds_are_timed() {
    let body = "<path d='M20 20L20 20' stroke='black' stroke-linecap='round'/>\
        <path d='M30 30C30 30 40 50 60 40' stroke='black'/>\
        <path d='M10 80h50l-3 5h-40l5 -3' stroke='black'/>\
        <path d='M10 10q20 30 40 0t40 0c5 -20 -10 20 0 30' stroke='black'/>\
        <circle cx='70' cy='70' r='12'/>";
    let run = Run::of_text(&page(body), &["--controller", "timed"]);
    assert!(run.number("/timed/max_deviation_mm") <= run.number("/timed/bound_mm"));
    assert!(run.number("/timed/missing_mm") <= 0.0);
}
