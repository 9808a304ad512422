//! How fast the tool goes and how long it dwells, from the records' own counts.

use super::{Run, integrate, run_body};

/// The disc turns, then the arms move, each for as many intervals as it has pulses.
#[test]
fn speed_and_dwell_are_stated() {
    let run = Run::of(&[]);
    let pulse_s = 2e-9 * run.number("/machine/half_period_ticks") * run.number("/machine/tick_ns");
    let (mut dwell_s, mut arms_s) = (0.0, 0.0);
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    let mut from = [0; 4];
    for (fast, to) in integrate(&run.read("pattern.bin")) {
        let ways = [0, 1, 2].map(|k| f64::from(to[k].abs_diff(from[k])));
        if !fast {
            dwell_s += ways[2] * pulse_s;
            let time_s = ways[0].max(ways[1]) * pulse_s;
            arms_s += time_s;
            let ((x0, y0), (x1, y1)) = (run.tool(from), run.tool(to));
            if time_s > 0.0 {
                let speed = (x1 - x0).hypot(y1 - y0) / time_s;
                (least, greatest) = (least.min(speed), greatest.max(speed));
            }
        }
        from = to;
    }
    let states = |pointer: &str, wanted: f64| {
        let stated = run.number(pointer);
        assert!(
            (stated - wanted).abs() < 1e-9 * wanted,
            "{pointer}: {stated}, {wanted}"
        );
    };
    states("/tool_speed_mm_s/0", least);
    states("/tool_speed_mm_s/1", greatest);
    states("/dwell_s", dwell_s);
    states("/in_glass_s", dwell_s + arms_s);
    // One interval for all pulses: a factor of four in speed.
    assert!(greatest > 4.0 * least && least > 8.0, "{least} {greatest}");
    for line in [
        format!(
            "tool: {least:.1} to {greatest:.1} mm/s along the strokes: the format has one pulse interval\n"
        ),
        format!(
            "disc: turns for {dwell_s:.1} of the {:.1} s in the glass, and the tool dwells there\n",
            dwell_s + arms_s
        ),
    ] {
        assert!(run.summary.contains(&line), "{}", run.summary);
    }
    // A dot has no speed.
    let dot = run_body("<path d='M20 20L20 20' stroke='black' stroke-linecap='round'/>");
    assert!(dot.report["tool_speed_mm_s"].is_null() && !dot.summary.contains("tool:"));
}
