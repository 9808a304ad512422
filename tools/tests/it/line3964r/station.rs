//! `station` byte by byte: the test is its partner.

use core::time::Duration;
use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use serialport::{SerialPort as _, TTYPort};

use super::program::{assert_misused, assert_refused, instant, lines, program};

/// How long the partner waits for a byte, far above any time of the presets in use.
const PATIENCE: Duration = Duration::from_secs(30);

/// A running `station` and the other end of its line.
struct Bench {
    line: TTYPort,
    /// Kept open: a port that everybody has closed is an error at the other end.
    _station_end: TTYPort,
    station: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Bench {
    fn new(preset: &str, options: &[&str]) -> Self {
        let (mut line, station_end) = TTYPort::pair().unwrap();
        line.set_timeout(PATIENCE).unwrap();
        let mut station = program("station")
            .args(["--port", &instant(&station_end)])
            .args(["--priority", "low", "--preset", preset])
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        Self {
            line,
            _station_end: station_end,
            input: station.stdin.take(),
            output: BufReader::new(station.stdout.take().unwrap()),
            station,
        }
    }

    /// The first NAK is out: the station hears what comes now.
    fn started(preset: &str, options: &[&str]) -> Self {
        let mut bench = Self::new(preset, options);
        bench.expect(&[0x15]);
        bench
    }

    fn submit(&mut self, line: &str) {
        let input = self.input.as_mut().unwrap();
        writeln!(input, "{line}").unwrap();
    }

    fn send(&mut self, bytes: &[u8]) {
        self.line.write_all(bytes).unwrap();
    }

    fn expect(&mut self, bytes: &[u8]) {
        let mut read = vec![0; bytes.len()];
        self.line.read_exact(&mut read).unwrap();
        assert_eq!(read, bytes);
    }

    fn event(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).unwrap();
        line.trim_end().to_owned()
    }

    /// Closes the input; exit code, further events, errors.
    fn end(mut self) -> (Option<i32>, Vec<String>, Vec<String>) {
        drop(self.input.take());
        let mut rest = Vec::new();
        self.output.read_to_end(&mut rest).unwrap();
        let output = self.station.wait_with_output().unwrap();
        (output.status.code(), lines(&rest), lines(&output.stderr))
    }

    fn ends_well(self) {
        self.ends_with(0);
    }

    fn ends_with(self, code: i32) {
        assert_eq!(self.end(), (Some(code), vec![], vec![]));
    }
}

#[test]
fn received() {
    let mut bench = Bench::started("siemens-3964r", &[]);
    bench.send(&[0x02]);
    bench.expect(&[0x10]);
    bench.send(&[0x41, 0x42, 0x10, 0x03, 0x10]);
    bench.expect(&[0x10]);
    assert_eq!(bench.event(), "received 41 42");
    bench.ends_well();
}

#[test]
fn received_nothing() {
    let mut bench = Bench::started("siemens-3964r", &[]);
    bench.send(&[0x02]);
    bench.expect(&[0x10]);
    bench.send(&[0x10, 0x03, 0x13]);
    bench.expect(&[0x10]);
    assert_eq!(bench.event(), "received");
    bench.ends_well();
}

#[test]
fn sent() {
    let mut bench = Bench::started("siemens-3964r", &[]);
    bench.submit("41 10");
    bench.expect(&[0x02]);
    bench.send(&[0x10]);
    bench.expect(&[0x41, 0x10, 0x10, 0x10, 0x03, 0x52]);
    bench.send(&[0x10]);
    assert_eq!(bench.event(), "sent 2");
    bench.ends_well();
}

#[test]
fn sent_without_spaces_and_empty() {
    let mut bench = Bench::started("siemens-3964r", &[]);
    bench.submit("4aFf");
    bench.submit("");
    bench.submit("-");
    bench.expect(&[0x02]);
    bench.send(&[0x10]);
    bench.expect(&[0x4A, 0xFF, 0x10, 0x03, 0xA6]);
    bench.send(&[0x10]);
    assert_eq!(bench.event(), "sent 2");
    bench.expect(&[0x02]);
    bench.send(&[0x10]);
    bench.expect(&[0x10, 0x03, 0x13]);
    bench.send(&[0x10]);
    assert_eq!(bench.event(), "sent 0");
    bench.ends_well();
}

#[test]
fn failed_connection() {
    let mut bench = Bench::started("siemens-3964", &[]);
    bench.submit("41");
    bench.expect(&[0x02, 0x02, 0x02, 0x02, 0x02, 0x02, 0x15]);
    assert_eq!(bench.event(), "failed connection timeout 6");
    bench.ends_with(1);
}

#[test]
fn failed_transmission() {
    let mut bench = Bench::new("hbls", &[]);
    bench.submit("41");
    for _ in 0..3 {
        bench.expect(&[0x02]);
        bench.send(&[0x10]);
        bench.expect(&[0x41, 0x10, 0x03, 0x52]);
        bench.send(&[0x15]);
    }
    bench.expect(&[0x15]);
    assert_eq!(bench.event(), "failed transmission nak 3");
    bench.ends_with(1);
}

#[test]
fn error_bcc_and_the_partner_gives_up() {
    let mut bench = Bench::started("siemens-3964r", &[]);
    bench.send(&[0x02]);
    bench.expect(&[0x10]);
    bench.send(&[0x41, 0x10, 0x03, 0x00]);
    bench.expect(&[0x15]);
    assert_eq!(bench.event(), "error bcc");
    bench.send(&[0x15]);
    assert_eq!(bench.event(), "receive-failed nak");
    bench.ends_well();
}

#[test]
fn events_as_json() {
    let mut bench = Bench::started("siemens-3964r", &["--json"]);
    let heard: [(&[u8], &[u8], &str); 4] = [
        (&[0x02], &[0x10], ""),
        (
            &[0x41, 0x10, 0x03, 0x00],
            &[0x15],
            r#"{"cause":"bcc","event":"error"}"#,
        ),
        (&[0x02], &[0x10], ""),
        (
            &[0x41, 0x42, 0x10, 0x03, 0x10],
            &[0x10],
            r#"{"event":"received","hex":"41 42"}"#,
        ),
    ];
    for (bytes, answer, event) in heard {
        bench.send(bytes);
        bench.expect(answer);
        if !event.is_empty() {
            assert_eq!(bench.event(), event);
        }
    }
    bench.submit("43");
    bench.expect(&[0x02]);
    bench.send(&[0x10]);
    bench.expect(&[0x43, 0x10, 0x03, 0x50]);
    bench.send(&[0x10]);
    assert_eq!(bench.event(), r#"{"event":"sent","length":1}"#);
    bench.submit("43");
    for _ in 0..6 {
        bench.expect(&[0x02]);
        bench.send(&[0x15]);
    }
    bench.expect(&[0x15]);
    assert_eq!(
        bench.event(),
        r#"{"attempts":6,"cause":"nak","event":"failed","phase":"connection"}"#
    );
    bench.ends_with(1);
}

#[test]
fn the_last_job_ends_before_the_program() {
    let mut bench = Bench::started("siemens-3964r", &[]);
    bench.submit("41");
    drop(bench.input.take());
    bench.expect(&[0x02]);
    bench.send(&[0x02]); // conflict: low gives way
    bench.expect(&[0x10]);
    bench.send(&[0x42, 0x10, 0x03, 0x51]);
    bench.expect(&[0x10, 0x02]);
    bench.send(&[0x10]);
    bench.expect(&[0x41, 0x10, 0x03, 0x52]);
    bench.send(&[0x10]);
    assert_eq!(bench.event(), "conflict 1");
    assert_eq!(bench.event(), "received 42");
    assert_eq!(bench.event(), "sent 1");
    bench.ends_well();
}

#[test]
fn listen() {
    const STAY: Duration = Duration::from_millis(1500);
    let mut bench = Bench::started("siemens-3964r", &["--listen", "1.5"]);
    let begin = Instant::now();
    drop(bench.input.take());
    bench.send(&[0x02]);
    bench.expect(&[0x10]);
    bench.send(&[0x41, 0x10, 0x03, 0x52]);
    bench.expect(&[0x10]);
    assert_eq!(bench.event(), "received 41");
    bench.ends_well();
    assert!(begin.elapsed() >= STAY - Duration::from_millis(100)); // the input may end sooner
}

#[test]
fn wrong_lines_are_named_and_the_rest_is_sent() {
    let mut bench = Bench::started("siemens-3964r", &[]);
    bench.submit("41 4G");
    bench.submit("+1");
    bench.submit("123");
    bench.input.as_mut().unwrap().write_all(b"\xFF\n").unwrap();
    bench.submit(&"00".repeat(4097));
    bench.submit("41");
    bench.expect(&[0x02]);
    bench.send(&[0x10]);
    bench.expect(&[0x41, 0x10, 0x03, 0x52]);
    bench.send(&[0x10]);
    assert_eq!(bench.event(), "sent 1");
    let (code, events, errors) = bench.end();
    assert_eq!((code, &events[..]), (Some(1), &[][..]));
    assert_eq!(
        errors,
        [
            "error: line 1: `4G` is not made of hexadecimal bytes",
            "error: line 2: `+1` is not made of hexadecimal bytes",
            "error: line 3: `123` is not made of hexadecimal bytes",
            "error: line 4: stream did not contain valid UTF-8",
            "error: line 5: the payload has 4097 bytes, the transmit buffer holds 4096",
        ]
    );
}

#[test]
fn an_input_that_cannot_be_read_ends_it() {
    let (_line, station_end) = TTYPort::pair().unwrap();
    let name = station_end.name().unwrap();
    let mut command = program("station");
    command
        .args(["--port", &name, "--priority", "low"])
        .args(["--preset", "siemens-3964r"])
        .stdin(File::open("/").unwrap());
    let output = command.output().unwrap();
    assert_eq!(
        lines(&output.stderr),
        ["error: line 1: Is a directory (os error 21)"]
    );
    assert_eq!(output.status.code(), Some(1));
}

fn station(port: &str, priority: &str, preset: &str) -> Command {
    let mut command = program("station");
    command.args(["--port", port, "--priority", priority, "--preset", preset]);
    command
}

#[test]
fn wrong_options() {
    assert_misused(
        &mut program("station"),
        "error: the following required arguments were not provided: --port <PORT> --priority <PRIORITY> --preset <PRESET>",
    );
    assert_refused(
        &mut station("/nowhere/port", "high", "km271"),
        "error: /nowhere/port: No such file or directory (os error 2)",
    );
    assert_refused(
        &mut station("/dev/null", "high", "km271"),
        "error: /dev/null: Inappropriate ioctl for device (os error 25)",
    );
    assert_misused(
        &mut station("x", "middle", "km271"),
        "error: invalid value 'middle' for '--priority <PRIORITY>' [possible values: high, low]",
    );
    assert_misused(
        &mut station("x", "high", "s7"),
        "error: invalid value 's7' for '--preset <PRESET>' [possible values: siemens-3964r, siemens-3964, hbls, hbas, linux, km271]",
    );
    assert_misused(
        &mut station("tcp://plc?baud=9600", "high", "linux"),
        "error: invalid value 'tcp://plc?baud=9600' for '--port <PORT>': `tcp://plc?baud=9600`: `plc` is not HOST:PORT",
    );
    for (option, value, error) in [
        ("--listen <SECONDS>", "-1", "`-1` is not a time in seconds"),
        (
            "--listen <SECONDS>",
            "nan",
            "`nan` is not a time in seconds",
        ),
        (
            "--listen <SECONDS>",
            "1e99",
            "`1e99` is not a time in seconds",
        ),
    ] {
        let name = option.split(' ').next().unwrap();
        assert_misused(
            station("x", "low", "linux").args([name, value]),
            &format!("error: invalid value '{value}' for '{option}': {error}"),
        );
    }
}
