//! The sketch `OneAxis` on a simulated Uno.
//!
//! It needs Debian's `arduino-core-avr`, `gcc-avr` and `libsimavr-dev`. Without them the tests say
//! so on standard error and pass; with `POSE2PULSE_REQUIRE_AVR=1` they fail.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use super::{Wire, file, steps_of};

/// Cycles of a tick.
const TICK: u64 = 8;

/// The simulator looks at its timer between instructions, and reckons in 24 bits.
const SIMULATED_CYCLES: u64 = 6;

/// Cycles and signs of the steps, and what the sketch answered besides `+`.
struct Run {
    steps: Vec<(u64, char)>,
    complaints: String,
}

/// `None`, and a line on standard error, when a tool is missing.
fn run(bytes: &[u8]) -> Option<Run> {
    let tools = [
        "/usr/bin/avr-g++",
        "/usr/share/arduino",
        "/usr/include/simavr",
    ];
    if let Some(missing) = tools.into_iter().find(|path| !Path::new(path).exists()) {
        let line = format!("the sketch of firmware/segments was not run: no {missing}");
        assert!(
            std::env::var_os("POSE2PULSE_REQUIRE_AVR").is_none(),
            "{line}"
        );
        writeln!(io::stderr(), "{line}").unwrap();
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let built = Command::new(file("extras/build"))
        .arg(file("examples/OneAxis/OneAxis.ino"))
        .arg(path("sketch.elf"))
        .output()
        .unwrap();
    let report = String::from_utf8_lossy(&built.stderr);
    assert!(built.status.success(), "{report}");
    let compiled = Command::new("cc")
        .args(["-std=gnu99", "-O2", "-Wall", "-Wextra", "-Werror", "-o"])
        .arg(path("simulate"))
        .args([&file("extras/simulate.c"), "-lsimavr"])
        .status()
        .unwrap();
    assert!(compiled.success());
    fs::write(path("segments.bin"), bytes).unwrap();
    let output = Command::new(path("simulate"))
        .arg(path("sketch.elf"))
        .stdin(Stdio::from(fs::File::open(path("segments.bin")).unwrap()))
        .output()
        .unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let complaints = text.lines().find_map(|line| line.strip_prefix("said: "));
    Some(Run {
        steps: steps_of(&text),
        complaints: complaints.unwrap_or("nothing").into(),
    })
}

/// Up to 20,000 steps a second, turns, a rest of a second between chunks of the timer, single
/// steps.
const ROWS: &[super::Row] = &[
    (40_000, 200, 10),
    (100_000, 1200, 10),
    (90_000, 1290, -8),
    (100_000, 490, -8),
    (100_000, 90, 0),
    (2_000_000, 80, 0),
    (50_000, 81, 0),
    (50_000, 80, 0),
];

#[test]
fn each_edge_of_an_uno_comes_at_its_tick() {
    let wire = Wire::of_rows(ROWS);
    let Some(run) = run(&wire.bytes) else { return };
    assert_eq!(run.complaints, "");
    assert_eq!(run.steps.len(), wire.steps.len());
    let signs = |steps: &[(u64, char)]| steps.iter().map(|step| step.1).collect::<String>();
    assert_eq!(signs(&run.steps), signs(&wire.steps));
    let (start, first) = (run.steps[0].0, wire.steps[0].0);
    for (seen, wanted) in run.steps.iter().zip(&wire.steps) {
        let (seen, wanted) = (seen.0 - start, TICK * (wanted.0 - first));
        assert!(
            seen.abs_diff(wanted) <= SIMULATED_CYCLES,
            "{seen}, {wanted}"
        );
    }
}

#[test]
fn steps_that_an_uno_cannot_make_are_late_and_said_so() {
    // 40,000 a second; none is lost.
    let wire = Wire::of_rows(&[(40_000, 400, 20), (20_000, 800, 20), (40_000, 1200, 0)]);
    let Some(run) = run(&wire.bytes) else { return };
    assert_eq!(run.steps.len(), wire.steps.len());
    assert!(run.complaints.starts_with('-'), "{:?}", run.complaints);
}

#[test]
fn bytes_that_are_no_segment_stop_it() {
    let wire = Wire::of_rows(ROWS);
    let mut bytes = wire.bytes;
    bytes.truncate(200);
    // Of counts over 1024.
    bytes.extend([0x3F; 64]);
    let Some(run) = run(&bytes) else { return };
    assert_eq!(run.complaints, "!");
    assert!(run.steps.len() < wire.steps.len());
}
