//! From a C source and a header to a trace of the ports.

use std::fs;
use std::io::{self, BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Once;

use vcd::{IdCode, Parser};

/// Set to 1: a missing tool is a failure.
const REQUIRE: &str = "POSE2PULSE_REQUIRE_MCS51";

/// One line is enough for all tests.
static SAID: Once = Once::new();

/// Longest run of the simulator, in seconds: a program that does not end is killed.
const LIMIT_S: &str = "60";

/// A machine cycle at 12 MHz in the simulator's picoseconds.
const CYCLE_PS: u64 = 1_000_000;

/// What is traced. Byte writes show in `sfr`, bit instructions in `bits`.
const SIGNALS: [(Signal, &str); 4] = [
    (Signal::Tcon, "sfr[0x88]"),
    (Signal::P1, "sfr[0x90]"),
    (Signal::P2, "sfr[0xa0]"),
    (Signal::Probe, "bits[0x80]"),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Signal {
    Tcon,
    P1,
    P2,
    /// P0.0
    Probe,
}

/// A write, also of the value that was there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Write {
    /// Machine cycles since reset, at the start of the writing instruction.
    pub(crate) cycle: u64,
    pub(crate) signal: Signal,
    pub(crate) value: u8,
}

/// Compiles `source` of `firmware/mcs51` with a header and `-D` settings, and runs it until it
/// writes P3. `None`, and a line on standard error, when a tool is missing.
pub(crate) fn simulate(source: &str, header: (&str, &str), defines: &[&str]) -> Option<Vec<Write>> {
    if let Some(missing) = missing_tool() {
        let line = format!("tests of firmware/mcs51 skipped: {missing} is not installed");
        assert!(std::env::var(REQUIRE).as_deref() != Ok("1"), "{line}");
        // Not `eprintln!`, which the test harness keeps to itself.
        SAID.call_once(|| writeln!(io::stderr(), "{line}").unwrap());
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let (name, text) = header;
    fs::write(folder.path().join(name), text).unwrap();
    compile(folder.path(), source, defines);
    run(folder.path());
    let file = fs::File::open(folder.path().join("ports.vcd")).unwrap();
    Some(read(Parser::new(BufReader::new(file))))
}

fn missing_tool() -> Option<&'static str> {
    let tools = [
        ("sdcc", "--version"),
        ("s51", "-v"),
        ("timeout", "--version"),
    ];
    let missing = tools.into_iter().find(|(tool, version)| {
        let mut command = Command::new(tool);
        command.arg(version).stdin(Stdio::null());
        !command.output().is_ok_and(|output| output.status.success())
    });
    missing.map(|(tool, _)| tool)
}

fn compile(folder: &Path, source: &str, defines: &[&str]) {
    let firmware = Path::new(env!("CARGO_MANIFEST_DIR")).join("firmware/mcs51");
    let output = Command::new("sdcc")
        .args(["-mmcs51", "--Werror", "-I", "."])
        .args(defines.iter().map(|define| format!("-D{define}")))
        .arg(firmware.join(source))
        .args(["-o", "program.ihx"])
        .current_dir(folder)
        .output()
        .unwrap();
    let report = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{source} {defines:?}: {report}");
}

fn run(folder: &Path) {
    let mut commands = String::from("set hardware vcd[0] output \"ports.vcd\"\n");
    for (_, place) in SIGNALS {
        commands += &format!("set hardware vcd[0] add {place}\n");
    }
    commands += "set hardware vcd[0] start\nbreak sfr w 0xb0\nrun\n";
    commands += "set hardware vcd[0] stop\nkill\n";
    fs::write(folder.join("commands"), commands).unwrap();
    let output = Command::new("timeout")
        .args([LIMIT_S, "s51", "-t", "8052", "-X", "12M", "-b"])
        .arg("program.ihx")
        .current_dir(folder)
        .stdin(fs::File::open(folder.join("commands")).unwrap())
        .output()
        .unwrap();
    let report = String::from_utf8_lossy(&output.stdout);
    assert!(report.contains("Event break"), "no end: {report}");
}

fn read(mut parser: Parser<BufReader<fs::File>>) -> Vec<Write> {
    let header = parser.parse_header().unwrap();
    let variables: Vec<(IdCode, Signal)> = header
        .items
        .iter()
        .filter_map(|item| match item {
            vcd::ScopeItem::Scope(scope) => Some(&scope.items),
            _ => None,
        })
        .flatten()
        .filter_map(|item| match item {
            vcd::ScopeItem::Var(variable) => Some(variable.code),
            _ => None,
        })
        .zip(SIGNALS.map(|(signal, _)| signal))
        .collect();
    assert_eq!(variables.len(), SIGNALS.len());
    let mut cycle = 0;
    let mut writes = Vec::new();
    let mut write = |cycle, code, value| {
        let (_, signal) = *variables.iter().find(|(known, _)| *known == code).unwrap();
        writes.push(Write {
            cycle,
            signal,
            value,
        });
    };
    for command in parser {
        match command.unwrap() {
            // Stamps are off by a picosecond now and then.
            vcd::Command::Timestamp(ps) => cycle = (ps + CYCLE_PS / 2) / CYCLE_PS,
            vcd::Command::ChangeScalar(code, value) => {
                write(cycle, code, u8::from(value == vcd::Value::V1));
            }
            vcd::Command::ChangeVector(code, bits) => {
                let value = bits
                    .iter()
                    .fold(0, |byte, bit| byte << 1 | u8::from(bit == vcd::Value::V1));
                write(cycle, code, value);
            }
            _ => {}
        }
    }
    // What stands at cycle 0 are levels, not writes.
    writes.retain(|write| write.cycle > 0);
    writes
}
