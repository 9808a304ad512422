//! Lines of G-code over a serial line, and their answers.

use core::time::Duration;
use std::io::{Read as _, Write as _};
use std::process::{Child, Stdio};

use serialport::{SerialPort as _, TTYPort};
use tempfile::TempDir;

use super::run::{ROUNDING_MM, Run};
use crate::tools::example::example;

/// A process that does not outlive a test that fails.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// A running `stage` and the other end of its line.
struct Dialogue {
    line: TTYPort,
    /// Kept open: a port that everybody has closed is an error at the other end.
    _far_end: TTYPort,
    child: Running,
    folder: TempDir,
}

impl Dialogue {
    fn new() -> Self {
        const PATIENCE: Duration = Duration::from_secs(30);
        let (mut line, far_end) = TTYPort::pair().unwrap();
        line.set_timeout(PATIENCE).unwrap();
        let folder = TempDir::new().unwrap();
        let child = example("stage")
            .args(["--port", &far_end.name().unwrap(), "--out"])
            .arg(folder.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        Self {
            line,
            _far_end: far_end,
            child: Running(child),
            folder,
        }
    }

    fn expect(&mut self, sent: &str, wanted: &str) {
        self.line.write_all(sent.as_bytes()).unwrap();
        let mut answer = Vec::new();
        let mut byte = [0];
        while byte != *b"\n" {
            self.line.read_exact(&mut byte).unwrap();
            answer.extend(byte);
        }
        assert_eq!(String::from_utf8(answer).unwrap().trim_end(), wanted);
    }
}

/// One message for each kind, before the answer; a feed as grbl wants it.
#[test]
fn the_dialogue_says_what_it_passes_over() {
    let mut dialogue = Dialogue::new();
    dialogue.expect(
        "G1 X5\n",
        "error:no F before the first G1, G2 or G3: undefined feed rate (22) at line 1",
    );
    dialogue.expect("?", "pos:0.00,0.00");
    dialogue.expect(
        "G1 X5 Z2 F600\n",
        "[MSG:line 2: Z: passed over, the stage has no such axis (1 time)]",
    );
    dialogue.expect("", "ok");
    dialogue.expect("Z3 X6\n", "ok");
    dialogue.expect(
        "G41 D1\n",
        "error:G41: the tool's radius would move the path aside at line 4",
    );
    dialogue.expect("?", "pos:6.00,0.00");
    dialogue.expect("M2\n", "ok");
    assert!(dialogue.child.0.wait().unwrap().success());
    let run = Run::read(dialogue.folder);
    assert_eq!(
        run.report["notes"],
        serde_json::json!(["line 2: Z: passed over, the stage has no such axis (2 times)"])
    );
}

#[test]
fn the_dialogue_answers_each_line() {
    let mut dialogue = Dialogue::new();
    dialogue.expect("?", "pos:0.00,0.00");
    dialogue.expect("G21 G90 F600\n", "ok");
    dialogue.expect("G0 X20 Y10\r\n", "ok");
    dialogue.expect("?", "pos:20.00,10.00");
    dialogue.expect("G1 Q3\n", "error:Q3: no word of this stage at line 3");
    dialogue.expect("G1 X500 Y10\n", "error:on the way to (500.000, 10.000) mm: X: the upper limit switch is closed at 12100 steps at line 4");
    dialogue.expect("?", "pos:121.00,10.00");
    // Off the switch again, by keys and by lines.
    dialogue.expect("<", "pos:120.00,10.00");
    dialogue.expect("^", "pos:120.00,11.00");
    dialogue.expect("v", "pos:120.00,10.00");
    dialogue.expect(">", "pos:121.00,10.00");
    dialogue.expect(
        ">",
        "error:on the way to (122.000, 10.000) mm: X: the upper limit switch is closed at 12100 steps",
    );
    dialogue.expect("G91\n", "ok");
    dialogue.expect("G3 X-20 I-10\n", "ok");
    dialogue.expect("?", "pos:101.00,10.00");
    // Broken off at the end: it stands, and closes, where it was stopped.
    dialogue.expect("G90\n", "ok");
    dialogue.expect(
        "G1 X101 Y-7\n",
        "error:on the way to (101.000, -7.000) mm: Y: the lower limit switch is closed at -100 steps at line 8",
    );
    dialogue.expect("M2\n", "ok");
    assert!(dialogue.child.0.wait().unwrap().success());
    let run = Run::read(dialogue.folder);
    assert!(run.number("/closing_error_mm") < ROUNDING_MM);
    let last = run.path().last().unwrap().1;
    let off = (last[0] - 101.0).abs() + (last[1] + 1.0).abs();
    assert!(off < ROUNDING_MM, "{last:?}");
}
