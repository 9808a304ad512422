//! `probe` against `simulate`.

use core::time::Duration;
use std::{net::TcpListener, process::Stdio, thread, time::Instant};

use super::program::{assert_misused, assert_refused, lines, program, run};

/// Until the simulated partner listens, on a busy computer.
const PATIENCE: Duration = Duration::from_secs(60);

/// A partner of low priority that has nothing to send: what shows is told, and nothing else.
#[test]
fn a_partner_that_only_answers() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let host = listener.local_addr().unwrap();
    drop(listener);
    let mut partner = program("simulate")
        .args(["3964r", "--port", &format!("tcp-listen://{host}")])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let port = format!("tcp://{host}?line=instant");
    let begin = Instant::now();
    let output = loop {
        let output = run(program("probe").args([&port, "--listen", "1"]), b"");
        if lines(&output.stderr).is_empty() {
            break output;
        }
        assert!(begin.elapsed() < PATIENCE, "{output:?}");
        thread::sleep(Duration::from_millis(50));
    };
    partner.kill().unwrap();
    partner.wait().unwrap();
    let printed = lines(&output.stdout);
    assert!(output.status.success(), "{printed:?}");
    let starts = [
        "rate       that of the serial server",
        "answer     0.",
        "ZVZ        2",
        "QVZ        cannot tell",
        "priority   cannot tell",
        "BCC        cannot tell",
        "block      cannot tell",
    ];
    assert_eq!(printed.len(), starts.len() + 1, "{printed:?}");
    for (line, start) in printed.iter().zip(starts) {
        // Times are longer where others are at work.
        let start = if line.ends_with("ms") {
            &start[..11]
        } else {
            start
        };
        assert!(line.starts_with(start), "{line}");
    }
    let settings =
        format!("--port '{port}' --priority low|high --preset siemens-3964r|siemens-3964");
    assert_eq!(printed.last().unwrap(), &settings);
}

#[test]
fn only_partners_are_probed() {
    assert_refused(
        program("probe").arg("tcp-listen://127.0.0.1:0"),
        "error: tcp-listen://127.0.0.1:0: a partner is at a serial port or a serial server",
    );
    assert_misused(
        program("probe").args(["COM3", "--listen", "soon"]),
        "error: invalid value 'soon' for '--listen <SECONDS>': `soon` is not a time in seconds",
    );
}
