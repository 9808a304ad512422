//! `monitor` on capture files and on two ports.

use core::time::Duration;
use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::TcpListener;
use std::path::PathBuf;
use std::process::Stdio;
use std::thread;

use serde_json::{Value, json};
use serialport::{SerialPort as _, TTYPort};
use tempfile::TempDir;

use super::program::{assert_misused, assert_refused, lines, program, run};

/// A capture file that lasts as long as the folder.
fn capture(text: &[u8]) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("line.txt");
    fs::write(&path, text).unwrap();
    (folder, path)
}

/// What is printed of a capture; `code` is the exit status.
fn replay(options: &[&str], text: &str, code: i32) -> Vec<String> {
    let (_folder, path) = capture(text.as_bytes());
    let output = run(program("monitor").args(options).arg(path), b"");
    assert_eq!(lines(&output.stderr), [""; 0]);
    assert_eq!(output.status.code(), Some(code));
    lines(&output.stdout)
}

#[test]
fn good_conversation() {
    let text = "\
# start-up, then one telegram each way
0.000000 > 15
0.100000 > 02
0.103000 < 10
0.104200 > 41 10 10 42 10 03 10
0.112000 < 10

0.200 < 02   # the answer
0.204 > 10
0.205 < 10 03 13
0.2075 > 10
";
    assert_eq!(
        replay(&[], text, 0),
        [
            "0.000000s A NAK without a question",
            "0.100000s A STX, attempt 1",
            "0.103000s B DLE, ready to receive, 3.000 ms",
            "0.104200s A block of 3: 41 10 42",
            "0.112000s B DLE, accepted, 7.800 ms",
            "0.200000s B STX, attempt 1",
            "0.204000s A DLE, ready to receive, 4.000 ms",
            "0.205000s B block of 0: ",
            "0.207500s A DLE, accepted, 2.500 ms",
            "verdict: the line works",
            "A to B: 1 telegrams, 0 repeats, 0 rejected, 0 conflicts, worst answer to STX 3.000 ms, worst acknowledgement 7.800 ms",
            "B to A: 1 telegrams, 0 repeats, 0 rejected, 0 conflicts, worst answer to STX 4.000 ms, worst acknowledgement 2.500 ms",
        ]
    );
}

#[test]
fn wrong_bcc_and_its_repeat() {
    let text = "\
1.000 > 02
1.002 < 10
1.003 > 41 10 03 00
1.008 < 15
1.009 > 02
1.011 < 10
1.012 > 41 10 03 52
1.017 < 10
";
    assert_eq!(
        replay(&[], text, 1),
        [
            "1.000000s A STX, attempt 1",
            "1.002000s B DLE, ready to receive, 2.000 ms",
            "1.003000s A bad block: BCC 00h received, 52h computed",
            "1.008000s B NAK, rejected, 5.000 ms",
            "1.009000s A STX, attempt 1",
            "1.011000s B DLE, ready to receive, 2.000 ms",
            "1.012000s A block of 1: 41",
            "1.017000s B DLE, accepted, 5.000 ms",
            "verdict: the line works, but 1 of 2 blocks of A had to be repeated; 1 arrived damaged",
            "A to B: 1 telegrams, 1 repeats (50.0 %), 1 rejected (50.0 %), 0 conflicts, worst answer to STX 2.000 ms, worst acknowledgement 5.000 ms",
            "B to A: 0 telegrams, 0 repeats, 0 rejected, 0 conflicts",
        ]
    );
}

#[test]
fn json() {
    let text = "0.0 > 02\n0.4 < 15\n0.401 > 02\n0.801 < 15\n";
    let printed = replay(&["--json"], text, 1);
    assert_eq!(printed.len(), 1);
    let report: Value = serde_json::from_str(&printed[0]).unwrap();
    assert_eq!(
        report["verdict"],
        json!({ "NoReceiveBuffer": { "refuser": "B" } })
    );
    assert_eq!(
        report["sentence"],
        "B answers NAK to STX: no receive buffer"
    );
    assert_eq!(report["or"], Value::Null);
    assert_eq!(report["a"]["requests"], 2);
    assert_eq!(report["b"]["telegrams"], 0);
}

#[test]
fn nak_to_stx_is_the_verdict() {
    let text = "\
0.0 > 02
0.4 < 15
0.401 > 02
0.801 < 15
";
    assert_eq!(
        replay(&[], text, 1),
        [
            "0.000000s A STX, attempt 1",
            "0.400000s B NAK to STX, 400.000 ms",
            "0.401000s A STX, attempt 2",
            "0.801000s B NAK to STX, 400.000 ms",
            "verdict: B answers NAK to STX: no receive buffer",
            "A to B: 0 telegrams, 0 repeats, 0 rejected, 0 conflicts",
            "B to A: 0 telegrams, 0 repeats, 0 rejected, 0 conflicts",
        ]
    );
}

#[test]
fn the_times_are_those_of_the_preset() {
    let text = "0 > 02\n0.6 < 10\n1.3 > 41 10 03\n";
    assert_eq!(
        replay(&["--preset", "siemens-3964"], text, 1),
        [
            "0.000000s A STX, attempt 1",
            "0.600000s B does not answer, waited 600.000 ms",
            "0.600000s B DLE, ready to receive, 600.000 ms",
            "1.300000s A sends no block after DLE, 700.000 ms",
            "1.300000s A pauses in the block, ZVZ exceeded: 700.000 ms",
            "1.300000s A block of 1: 41",
            "verdict: B answers 600.000 ms after the question, later than A waits (QVZ, 550.000 ms): too late by 50.000 ms; and A pauses in its blocks for longer than the character delay time (ZVZ): 700.000 ms",
            "A to B: 0 telegrams, 0 repeats, 0 rejected, 0 conflicts, worst answer to STX 600.000 ms, longest gap 700.000 ms",
            "B to A: 0 telegrams, 0 repeats, 0 rejected, 0 conflicts",
        ]
    );
}

#[test]
fn two_ports() {
    let [(mut from_a, tap_a), (mut from_b, tap_b)] = [(); 2].map(|()| TTYPort::pair().unwrap());
    let mut monitor = program("monitor")
        .args(["--port", &tap_a.name().unwrap()])
        .args(["--port", &tap_b.name().unwrap()])
        .args(["--seconds", "6"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let output = monitor.stdout.take().unwrap();
    let mut lines = BufReader::new(output).lines().map(Result::unwrap);
    // Each step waits for the one before; the times are those of the day.
    let mut see = |line: &mut TTYPort, bytes: &[u8], expected: &str| {
        line.write_all(bytes).unwrap();
        let seen = lines.by_ref().find(|line| !line.contains("verdict"));
        let seen = seen.unwrap();
        assert!(seen.contains(expected), "{seen}");
    };
    see(&mut from_a, &[0x02], "s A STX, attempt 1");
    see(&mut from_b, &[0x10], "s B DLE, ready to receive, ");
    see(&mut from_a, &[0x41, 0x10, 0x03, 0x52], "s A block of 1: 41");
    see(&mut from_b, &[0x10], "s B DLE, accepted, ");
    see(&mut from_b, &[0x02], "s B STX, attempt 1");
    // Nothing comes: the time alone makes the next line.
    see(&mut from_a, &[], "s A does not answer, waited ");
    see(&mut from_b, &[0x02], "s B STX, attempt 2");
    for expected in ["s B STX, attempt 3", "s B STX, attempt 4"] {
        thread::sleep(Duration::from_millis(200));
        see(&mut from_b, &[0x02], "s A does not answer, waited ");
        see(&mut from_b, &[], expected);
    }
    let verdict = lines.find(|line| line.starts_with("verdict")).unwrap();
    assert!(
        verdict.starts_with("verdict: A does not answer STX any more"),
        "{verdict}"
    );
    assert_eq!(lines.count(), 3);
    assert_eq!(monitor.wait().unwrap().code(), Some(1), "a fault");
}

/// An adapter is pulled out: what was heard before is judged and kept.
#[test]
fn a_port_that_goes_leaves_its_verdict() {
    let (mut from_a, tap_a) = TTYPort::pair().unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let name = format!("tcp://{}", listener.local_addr().unwrap());
    let folder = TempDir::new().unwrap();
    let saved = folder.path().join("kept");
    let mut monitor = program("monitor")
        .args(["--port", &tap_a.name().unwrap()])
        .args(["--port", &name])
        .arg("--save")
        .arg(&saved)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let output = monitor.stdout.take().unwrap();
    let mut told = BufReader::new(output).lines().map(Result::unwrap);
    let (from_b, _) = listener.accept().unwrap();
    from_a.write_all(&[0x02]).unwrap();
    assert!(told.next().unwrap().ends_with("A STX, attempt 1"));
    drop(from_b);
    let verdict = "verdict: nothing to complain of so far";
    assert!(told.any(|line| line == verdict));
    let ended = monitor.wait_with_output().unwrap();
    let errors = lines(&ended.stderr);
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(
        errors[0].starts_with(&format!("error: {name}: ")),
        "{errors:?}"
    );
    assert_eq!(ended.status.code(), Some(1));
    let kept = fs::read_to_string(saved).unwrap();
    assert!(kept.contains(&format!("# {verdict}\n")), "{kept}");
}

#[test]
fn wrong_lines_are_named() {
    for (text, error) in [
        ("0 > 02\nx < 10\n", "2: `x` is not a time in seconds"),
        ("-1 < 10\n", "1: `-1` is not a time in seconds"),
        ("nan < 10\n", "1: `nan` is not a time in seconds"),
        ("0 = 10\n", "1: `=` is neither `>` nor `<`"),
        ("\n# only a time\n0.5\n", "3: no direction after the time"),
        ("0 >\n", "1: no bytes after the direction"),
        ("0 > 02 1G\n", "1: `1G` is not made of hexadecimal bytes"),
        ("0 > 123\n", "1: `123` is not made of hexadecimal bytes"),
        ("0 > +2\n", "1: `+2` is not made of hexadecimal bytes"),
        (
            "0.5 > 02\n0.25 < 10\n",
            "2: time runs backwards: 0.250000s after 0.500000s",
        ),
    ] {
        let (_folder, path) = capture(text.as_bytes());
        let line = format!("error: {}:{error}", path.display());
        assert_refused(program("monitor").arg(&path), &line);
    }
}

#[test]
fn unreadable_captures_are_named() {
    let (folder, binary) = capture(&[0xFF, 0x02]);
    let name = binary.display();
    let line = format!("error: {name}: stream did not contain valid UTF-8");
    assert_refused(program("monitor").arg(&binary), &line);
    let missing = folder.path().join("missing");
    let line = format!(
        "error: {}: No such file or directory (os error 2)",
        missing.display()
    );
    assert_refused(program("monitor").arg(missing), &line);
}

#[test]
fn wrong_options() {
    for (options, error) in [
        (
            &[][..],
            "the following required arguments were not provided: <CAPTURE>",
        ),
        (
            &["--port", "a", "line.txt"],
            "the argument '--port <PORT>' cannot be used with '[CAPTURE]'",
        ),
        (
            &["--port", "a", "--port", "b", "--seconds", "-1"],
            "invalid value '-1' for '--seconds <SECONDS>': `-1` is not a time in seconds",
        ),
    ] {
        assert_misused(program("monitor").args(options), &format!("error: {error}"));
    }
    for (ports, error) in [
        (
            &["--port", "a"][..],
            "two ports are needed, one for each direction",
        ),
        (
            &["--port", "/nowhere/a", "--port", "/nowhere/b"],
            "/nowhere/a: No such file or directory (os error 2)",
        ),
    ] {
        assert_refused(program("monitor").args(ports), &format!("error: {error}"));
    }
}
