//! What the edges ask of the motors, and the steps that these lose.

use std::fs;

use super::timed::{pulses, timed};
use super::{Run, shipped};

const AXES: [(&str, &str); 4] = [
    ("elbow", "deg"),
    ("shoulder", "deg"),
    ("disc", "deg"),
    ("vertical", "mm"),
];

/// Without a pulse for longer, an axis stands.
const REST_S: f64 = 0.02;
/// Of a time stamp in ns against some ms from pulse to pulse.
const CLOSE: f64 = 1e-5;

/// Of the first two pulses after a rest or a reversal, in pulses a second.
fn start_speed_hz(pulses: &[(f64, bool)]) -> f64 {
    let mut fastest = 0.0_f64;
    for (index, pair) in pulses.windows(2).enumerate() {
        let before = index.checked_sub(1).map(|last| pulses[last]);
        let [(from_s, one), (to_s, other)] = [pair[0], pair[1]];
        let is_start = before.is_none_or(|(s, way)| from_s - s > REST_S || way != one);
        if is_start && one == other {
            fastest = fastest.max(1.0 / (to_s - from_s));
        }
    }
    fastest
}

/// The start speeds of the report are those of the dump, and no motor that starts with the rate of
/// `machine.toml` loses a step.
#[test]
fn start_speeds_are_those_of_the_dump_and_no_step_is_lost() {
    let run = timed("star");
    let dump = String::from_utf8(run.read("pulses.vcd")).unwrap();
    for (axis, unit) in AXES {
        for of in ["", "/timed"] {
            let of = |name: &str| run.number(&format!("{of}/motors/{axis}/{name}"));
            assert!(of("lost_steps") <= 0.0, "{axis}");
            let lag = of("max_lag_full_steps");
            assert!(lag > 0.5 && lag < 2.0, "{axis}: {lag}");
            let (value, off) = (
                of(&format!("max_acceleration_{unit}_s2/value")),
                of(&format!("max_acceleration_{unit}_s2/uncertainty")),
            );
            assert!(value > off && off > 0.0, "{axis}: {value} {off}");
        }
        let per_pulse = match axis {
            "vertical" => run.number("/machine/mm_per_vertical_pulse"),
            _ => run
                .number(&format!("/machine/rad_per_pulse/{axis}"))
                .to_degrees(),
        };
        let stated = run.number(&format!(
            "/timed/motors/{axis}/max_start_speed_{unit}_s/value"
        ));
        let seen = start_speed_hz(&pulses(&dump, axis)) * per_pulse;
        assert!(
            (stated / seen - 1.0).abs() < CLOSE,
            "{axis}: {stated} {seen}"
        );
    }
    assert!(run.summary.contains("of the arm, 0 steps lost\n"));
}

/// Records that start with 2 kHz at once: the motors stay behind, those of timed strokes do not.
#[test]
fn a_pattern_that_is_too_fast_loses_steps_and_timed_strokes_lose_none() {
    let machine = fs::read_to_string(shipped("machine.toml")).unwrap();
    let folder = tempfile::TempDir::new().unwrap();
    let fast = folder.path().join("fast.toml");
    fs::write(
        &fast,
        machine.replace("process_hz = 112.8", "process_hz = 2000.0"),
    )
    .unwrap();
    let machine = ["--machine", fast.to_str().unwrap()];
    let options = [machine, ["--controller", "timed"]].concat();
    let run = Run::of_drawing("lettering", &options);
    let lost = |of: &str| -> f64 {
        let joints = ["elbow", "shoulder", "disc"].iter();
        joints
            .map(|axis| run.number(&format!("{of}/motors/{axis}/lost_steps")))
            .sum()
    };
    assert!(lost("") > 100.0, "{}", run.summary);
    assert!(lost("/timed") <= 0.0, "{}", run.summary);
}
