//! From a C source and a header to a trace of the ports.

use std::fs;
use std::io::{self, BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Once;

use tempfile::TempDir;
use vcd::{IdCode, Parser};

/// Set to 1: a missing tool is a failure.
const REQUIRE: &str = "POSE2PULSE_REQUIRE_MCS51";

/// One line is enough for all tests.
static SAID: Once = Once::new();

/// Longest run of the simulator, in seconds: a program that does not end is killed.
const LIMIT_S: &str = "60";

/// A machine cycle at 12 MHz in the simulator's picoseconds.
const CYCLE_PS: u64 = 1_000_000;

/// What is traced, by its address. A byte write shows in `sfr[address]` alone, a bit instruction in
/// `bits[address + n]` alone.
const PORTS: [(Port, u8); 4] = [
    (Port::P0, 0x80),
    (Port::Tcon, 0x88),
    (Port::P1, 0x90),
    (Port::P2, 0xA0),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Port {
    P0,
    Tcon,
    P1,
    P2,
}

/// A write, also of the value that was there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Write {
    /// Machine cycles since reset, at the start of the writing instruction.
    pub(crate) cycle: u64,
    pub(crate) port: Port,
    /// All eight bits after the write.
    pub(crate) value: u8,
}

/// Compiles `source` of `firmware/mcs51` with a header and `-D` settings, and runs it until it
/// writes P3. `None`, and a line on standard error, when a tool is missing.
pub(crate) fn simulate(source: &str, header: (&str, &str), defines: &[&str]) -> Option<Vec<Write>> {
    let folder = build(source, header, defines)?;
    run(folder.path());
    let file = fs::File::open(folder.path().join("ports.vcd")).unwrap();
    Some(read(Parser::new(BufReader::new(file))))
}

/// Bytes of program memory up to the last one that is used, the tables of the header among them.
pub(crate) fn program_bytes(source: &str, header: (&str, &str), defines: &[&str]) -> Option<usize> {
    let folder = build(source, header, defines)?;
    let text = fs::read_to_string(folder.path().join("program.ihx")).unwrap();
    // `:LLAAAATT`: length, address, type 00 for data.
    let ends = text.lines().filter(|line| &line[7..9] == "00").map(|line| {
        let number = |digits| usize::from_str_radix(digits, 16).unwrap();
        number(&line[1..3]) + number(&line[3..7])
    });
    ends.max()
}

/// The folder with `program.ihx`.
fn build(source: &str, header: (&str, &str), defines: &[&str]) -> Option<TempDir> {
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
    Some(folder)
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
    for (_, address) in PORTS {
        commands += &format!("set hardware vcd[0] add sfr[{address:#x}]\n");
        for bit in address..address + 8 {
            commands += &format!("set hardware vcd[0] add bits[{bit:#x}]\n");
        }
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

/// Codes of all traced variables, in the order of [`run`]: of each port the byte, then its bits.
fn codes(parser: &mut Parser<BufReader<fs::File>>) -> Vec<IdCode> {
    let header = parser.parse_header().unwrap();
    let scopes = header.items.iter().filter_map(|item| match item {
        vcd::ScopeItem::Scope(scope) => Some(&scope.items),
        _ => None,
    });
    let codes = scopes.flatten().filter_map(|item| match item {
        vcd::ScopeItem::Var(variable) => Some(variable.code),
        _ => None,
    });
    codes.collect()
}

fn read(mut parser: Parser<BufReader<fs::File>>) -> Vec<Write> {
    let codes = codes(&mut parser);
    assert_eq!(codes.len(), PORTS.len() * 9);
    let mut cycle = 0;
    let mut values = [0xFF; PORTS.len()];
    let mut writes = Vec::new();
    for command in parser {
        let (code, value) = match command.unwrap() {
            // Stamps are off by a picosecond now and then.
            vcd::Command::Timestamp(ps) => {
                cycle = (ps + CYCLE_PS / 2) / CYCLE_PS;
                continue;
            }
            vcd::Command::ChangeScalar(code, value) => (code, u8::from(value == vcd::Value::V1)),
            vcd::Command::ChangeVector(code, bits) => {
                let bits = bits.iter().map(|bit| u8::from(bit == vcd::Value::V1));
                (code, bits.fold(0, |byte, bit| byte << 1 | bit))
            }
            _ => continue,
        };
        let variable = codes.iter().position(|&known| known == code).unwrap();
        let port = &mut values[variable / 9];
        *port = match variable % 9 {
            0 => value,
            bit => *port & !(1 << (bit - 1)) | value << (bit - 1),
        };
        // What stands at cycle 0 are levels, not writes.
        if cycle > 0 {
            writes.push(Write {
                cycle,
                port: PORTS[variable / 9].0,
                value: *port,
            });
        }
    }
    writes
}
