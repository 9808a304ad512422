//! `simulate` with `station` as the program that is tested against it.

use core::time::Duration;
use std::fs;
use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread;

use tempfile::TempDir;

use super::program::{assert_misused, assert_refused, lines, program, run};

/// Questions, a second each, until an order must have been heard of.
const PATIENCE: u32 = 20;

/// A running machine; its port is a pseudo-terminal in a folder of its own.
struct Machine {
    child: Child,
    orders: Option<ChildStdin>,
    folder: TempDir,
}

impl Machine {
    fn start(machine: &str, data: Option<&str>) -> Self {
        let folder = TempDir::new().unwrap();
        let link = folder.path().join("line");
        let port = format!("pty:{}", link.display());
        let mut command = program("simulate");
        command.args([machine, "--port", &port]);
        if let Some(data) = data {
            let path = folder.path().join("data");
            fs::write(&path, data).unwrap();
            command.arg("--data").arg(path);
        }
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for(&link);
        Self {
            orders: child.stdin.take(),
            child,
            folder,
        }
    }

    fn order(&mut self, line: &str) {
        writeln!(self.orders.as_mut().unwrap(), "{line}").unwrap();
    }

    /// What `station` prints that sends these telegrams and then listens for a second.
    fn asked(&self, options: &[&str], telegrams: &str) -> Vec<String> {
        let path = self.folder.path().join("line");
        let port = format!("{}?line=instant", path.display());
        let mut station = program("station");
        station
            .args(["--port", &port, "--listen", "1"])
            .args(options);
        let output = run(&mut station, telegrams.as_bytes());
        assert_eq!(lines(&output.stderr), [""; 0]);
        assert!(output.status.success());
        // How the machine's own beginning is met depends on who comes first.
        let mut printed = lines(&output.stdout);
        printed.retain(|line| line.starts_with("sent") || line.starts_with("received"));
        printed
    }

    /// Asks until that is what `station` prints: orders come another way than telegrams, and may be
    /// heard of after them.
    fn answers(&self, options: &[&str], telegrams: &str, expected: &[&str]) {
        let mut printed = Vec::new();
        for _ in 0..PATIENCE {
            printed = self.asked(options, telegrams);
            if printed == expected {
                return;
            }
        }
        panic!("{printed:?} in place of {expected:?}");
    }

    /// What the machine has printed of its own.
    fn end(mut self) -> Vec<String> {
        self.child.kill().unwrap();
        let mut text = Vec::new();
        let mut stdout = self.child.stdout.take().unwrap();
        stdout.read_to_end(&mut text).unwrap();
        let mut printed = lines(&text);
        // Whether both begin at once depends on who comes first.
        let of_the_line = ["received", "sent", "error", "receive-failed", "conflict"];
        printed.retain(|line| !of_the_line.iter().any(|word| line.starts_with(word)));
        printed
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        drop(self.child.kill()); // it may have ended
        drop(self.child.wait());
    }
}

fn wait_for(path: &Path) {
    while fs::symlink_metadata(path).is_err() {
        thread::sleep(Duration::from_millis(5));
    }
}

/// A client with its defaults takes the machine for a serial server at 9600 bit/s: its answers come
/// no sooner than a wire could carry them.
#[cfg(feature = "gateway")]
#[tokio::test(flavor = "multi_thread")]
async fn a_client_of_rk512_finds_a_serial_server() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let host = listener.local_addr().unwrap();
    drop(listener);
    let folder = TempDir::new().unwrap();
    let data = folder.path().join("data");
    fs::write(&data, "db.10 = \"0001 0203\"\n").unwrap();
    let machine = program("simulate")
        .args(["rk512", "--port", &format!("tcp-listen://{host}"), "--data"])
        .arg(data)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let _machine = Machine {
        child: machine,
        orders: None,
        folder,
    };
    let begin = std::time::Instant::now();
    let plc = loop {
        match rk512::tokio::connect(&format!("tcp://{host}")).await {
            Ok(plc) => break plc,
            Err(error) => assert!(begin.elapsed() < Duration::from_secs(60), "{error}"),
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    };
    for _ in 0..5 {
        let words = plc.fetch(rk512::Area::db(10, 0), 2).await.unwrap();
        assert_eq!(words, [0, 1, 2, 3]);
    }
}

const LOW: &[&str] = &["--priority", "low", "--preset", "siemens-3964r"];
const HIGH: &[&str] = &["--priority", "high", "--preset", "siemens-3964r"];
const PENDANT: &[&str] = &["--priority", "high", "--preset", "hbls"];

#[test]
fn a_partner_answers_what_it_knows() {
    let mut partner = Machine::start("3964r", Some("# name\n41 42 = 43\n44 = -\n"));
    assert_eq!(
        partner.asked(HIGH, "41 42\n45\n44\n"),
        ["sent 2", "received 43", "sent 1", "sent 1", "received"]
    );
    partner.order("55 10");
    let mut printed = partner.asked(HIGH, "46\n");
    printed.sort(); // both sides send at once
    assert_eq!(printed, ["received 55 10", "sent 1"]);
}

/// The telegrams byte by byte, as the manuals of the communication processors print them.
#[test]
fn a_plc_serves_its_memory() {
    let plc = Machine::start("rk512", Some("db.10 = \"0001 0203 0405\"\nflags = 4\n"));
    let fetch = "00 00 45 44 0A 01 00 02 FF FF\n";
    let send = "00 00 41 44 0A 02 00 01 FF FF CA FE\n";
    let missing = "00 00 45 44 0B 00 00 01 FF FF\n";
    assert_eq!(
        plc.asked(LOW, &format!("{fetch}{send}{fetch}{missing}")),
        [
            "sent 10",
            "received 00 00 00 00 02 03 04 05",
            "sent 12",
            "received 00 00 00 00",
            "sent 10",
            "received 00 00 00 00 02 03 CA FE",
            "sent 10",
            "received 00 00 00 14",
        ]
    );
    let printed = plc.end();
    assert_eq!(printed.len(), 4, "{printed:?}");
    assert!(printed[0].starts_with("served "), "{printed:?}");
    assert!(printed[3].starts_with("refused: "), "{printed:?}");
}

#[test]
fn a_heating_controller_tells_its_values_when_asked() {
    let heating = Machine::start("km271", Some("80 02 2D\n84 2B 3A # boiler\n"));
    assert_eq!(heating.asked(HIGH, "01\n"), ["sent 1"]);
    assert_eq!(
        heating.asked(HIGH, "EE 00 00\n"),
        ["sent 3", "received 80 02 2D", "received 84 2B 3A"]
    );
}

#[test]
fn a_pendant_is_silent_until_its_status_is_asked_for() {
    let mut pendant = Machine::start("hbls", None);
    pendant.order("w2 2");
    pendant.order("key 1");
    // Key 1, W1 at 1, W2 at 2.
    pendant.answers(PENDANT, "23\n", &["sent 1", "received 31 41 52"]);
    pendant.order("key");
    let printed = pendant.asked(PENDANT, "6C 27 33 35 B2 A5 A1 A4 B9\n");
    assert_eq!(printed.len(), 3, "{printed:?}");
    assert_eq!(pendant.end(), ["display READY"]);
}

#[test]
fn a_machine_that_is_ended_leaves_nothing() {
    let mut machine = Machine::start("km271", None);
    let id = machine.child.id().to_string();
    let sent = Command::new("kill").args(["-TERM", &id]).status().unwrap();
    assert!(sent.success());
    assert!(machine.child.wait().unwrap().success());
    assert!(fs::symlink_metadata(machine.folder.path().join("line")).is_err());
}

/// A machine that programs connect to, one after the other.
struct Served {
    child: Child,
    address: String,
}

impl Served {
    fn start(machine: &str, options: &[&str]) -> Self {
        let port = TcpListener::bind("127.0.0.1:0")
            .unwrap()
            .local_addr()
            .unwrap()
            .port();
        let child = program("simulate")
            .args([machine, "--port", &format!("tcp-listen://127.0.0.1:{port}")])
            .args(options)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let address = format!("tcp://127.0.0.1:{port}?line=instant");
        Self { child, address }
    }

    /// What a `station` prints that connects, sends this and goes.
    fn asked(&self, options: &[&str], telegram: &str) -> Vec<String> {
        loop {
            let mut station = program("station");
            station.args(["--port", &self.address]).args(options);
            let output = run(&mut station, telegram.as_bytes());
            if output.status.success() {
                return lines(&output.stdout);
            }
            // Not there yet, or not there again.
            let error = lines(&output.stderr).concat();
            assert!(error.contains("Connection refused"), "{error}");
            thread::sleep(Duration::from_millis(5));
        }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

/// Programs come and go.
#[test]
fn the_next_program_is_served_too() {
    let machine = Served::start("3964r", &[]);
    for _ in 0..3 {
        let printed = machine.asked(HIGH, "41\n");
        assert_eq!(printed.last().map(String::as_str), Some("sent 1"));
    }
}

/// Programs that do not wait for the reaction to their command.
#[test]
fn a_plc_serves_the_next_program_after_one_that_has_gone_too_soon() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("data");
    fs::write(&path, "db.10 = \"0001\"\n").unwrap();
    let plc = Served::start("rk512", &["--data", path.to_str().unwrap()]);
    let fetch = "00 00 45 44 0A 00 00 01 FF FF\n";
    for _ in 0..3 {
        plc.asked(LOW, fetch);
    }
    let printed = plc.asked(&[LOW, &["--listen", "2"]].concat(), fetch);
    assert_eq!(
        printed.last().map(String::as_str),
        Some("received 00 00 00 00 00 01")
    );
}

#[test]
fn wrong_data_are_named() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("data");
    for (machine, data, error) in [
        ("3964r", "41\n", "line 1: `41` is not HEX = HEX"),
        (
            "3964r",
            "\n41 = 4G",
            "line 2: `4G` is not made of hexadecimal bytes",
        ),
        (
            "km271",
            "80 X",
            "line 1: `X` is not made of hexadecimal bytes",
        ),
        (
            "rk512",
            "db.256 = 2",
            "db.256: a block has a number from 0 to 255",
        ),
        (
            "rk512",
            "db.1 = \"1G\"",
            "db.1: `1G` is not made of hexadecimal bytes",
        ),
        ("hbls", "", "a pendant has no data"),
        (
            "rk512",
            "db.1 = 2\nmerker = 4\n",
            "line 2, column 1: unknown field `merker`, expected one of `db`, `dx`, `inputs`, \
             `outputs`, `flags`, `timers`, `counters`",
        ),
    ] {
        fs::write(&path, data).unwrap();
        let mut command = program("simulate");
        command.args([machine, "--port", "/nowhere", "--data"]);
        command.arg(&path);
        let refusal = format!("error: {}: {error}", path.display());
        assert_refused(&mut command, &refusal);
    }
}

#[test]
fn wrong_machines() {
    assert_misused(
        program("simulate").args(["s7", "--port", "x"]),
        "error: invalid value 's7' for '<MACHINE>' [possible values: 3964r, rk512, km271, hbls]",
    );
}
