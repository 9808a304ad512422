//! What `monitor --save` writes, read by Wireshark's own `tshark`.
//!
//! Without it the test says so on standard error and passes; with `POSE2PULSE_REQUIRE_TSHARK=1` it
//! fails.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

use super::program::{lines, program, run};

/// Fields of each packet, as `tshark` prints them.
fn packets(path: &Path) -> Option<Vec<String>> {
    let mut tshark = Command::new("tshark");
    tshark
        .arg("-r")
        .arg(path)
        .args(["-T", "fields", "-E", "separator=|"]);
    for field in [
        "frame.time_epoch",
        "rtacser.timestamp",
        "frame.interface_name",
        "rtacser.eventtype",
        "data.data",
        "frame.comment",
    ] {
        tshark.args(["-e", field]);
    }
    match tshark.output() {
        Ok(output) => {
            assert!(output.status.success(), "{output:?}");
            Some(lines(&output.stdout))
        }
        Err(error) if env::var_os("POSE2PULSE_REQUIRE_TSHARK").is_none() => {
            eprintln!("skipped: tshark: {error}");
            None
        }
        Err(error) => panic!("tshark: {error}"),
    }
}

#[test]
fn both_directions_times_damage_and_verdict() {
    let folder = TempDir::new().unwrap();
    let (text, saved) = (
        folder.path().join("line"),
        folder.path().join("line.pcapng"),
    );
    let capture = "\
0.5 > 02
0.503 < 10
0.504200 > 41 10 03 52
0.509 < 10
1 < 41?
4.000001 < 00!
";
    fs::write(&text, capture).unwrap();
    let output = run(program("monitor").arg(&text).arg("--save").arg(&saved), b"");
    assert!(output.status.success(), "{output:?}");
    let Some(packets) = packets(&saved) else {
        return;
    };
    let (verdict, pieces) = packets.split_last().unwrap();
    assert_eq!(
        pieces,
        [
            "0.500000000|0.500000000|A to B|0x01|02|A STX, attempt 1",
            "0.503000000|0.503000000|B to A|0x02|10|B DLE, ready to receive, 3.000 ms",
            "0.504200000|0.504200000|A to B|0x01|41100352|A block of 1: 41",
            "0.509000000|0.509000000|B to A|0x02|10|B DLE, accepted, 4.800 ms",
            "1.000000000|1.000000000|B to A|0x08|41|B parity error in 41; B stray 41",
            "4.000001000|4.000001000|B to A|0x07|00|B framing error in 00; B stray 00",
        ]
    );
    let verdict = verdict.strip_prefix("4.000001000|4.000001000|A to B|0x06||verdict: ");
    assert!(verdict.is_some_and(|it| it.starts_with("the line works")));
}

/// A file that was saved is a capture like any other.
#[test]
fn as_text() {
    let folder = TempDir::new().unwrap();
    let (text, saved) = (folder.path().join("line"), folder.path().join("saved"));
    fs::write(&text, "0.5 > 02 # A begins\n0.9 < 15\n").unwrap();
    let output = run(program("monitor").arg(&text).arg("--save").arg(&saved), b"");
    assert_eq!(output.status.code(), Some(1), "a fault: {output:?}");
    let kept = fs::read_to_string(&saved).unwrap();
    assert_eq!(
        kept.lines().take(3).collect::<Vec<_>>(),
        [
            "0.500000 > 02",
            "0.900000 < 15",
            "# verdict: B answers NAK to STX: no receive buffer",
        ]
    );
    let again = run(program("monitor").arg(&saved), b"");
    assert_eq!(again.stdout, output.stdout);
    let refused = run(program("monitor").arg(&text).arg("--save").arg(&saved), b"");
    let error = format!("error: {}: File exists (os error 17)", saved.display());
    assert_eq!(lines(&refused.stderr), [error]);
}
