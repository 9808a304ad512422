//! The gateway as a process.

use alloc::sync::Arc;
use core::time::Duration;
use std::{
    fs,
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::TcpStream,
    process::{Child, Command, ExitStatus, Stdio},
    sync::Mutex,
    thread::{self, JoinHandle},
    time::Instant,
};

use tempfile::TempDir;

use super::broker::{PASSWORD, USER, signal, terminate};

/// Far above what anything here takes on a busy computer.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

const PROGRAM: &str = env!("CARGO_BIN_EXE_line3964r");

/// A running gateway.
pub(crate) struct Gateway {
    process: Child,
    log: Arc<Mutex<String>>,
    /// What reads the log, to its end.
    reader: Option<JoinHandle<()>>,
    folder: TempDir,
}

/// The settings of a broker without TLS.
pub(crate) fn mqtt(port: u16) -> String {
    format!(
        "[mqtt]\nbroker = \"mqtt://127.0.0.1:{port}\"\nuser = \"{USER}\"\npassword = \"{PASSWORD}\"\n"
    )
}

/// A line whose partner is at this port of TCP.
pub(crate) fn line(name: &str, port: u16) -> String {
    format!(
        "[[line]]\nname = \"{name}\"\nport = \"tcp://127.0.0.1:{port}?line=instant\"\n\
         priority = \"low\"\nqvz_ms = 500\n"
    )
}

/// Where metrics are served.
pub(crate) fn metrics(port: u16) -> String {
    format!("[metrics]\nlisten = \"127.0.0.1:{port}\"\n")
}

/// The configuration of a gateway, `hall`, in its parts.
pub(crate) fn hall(parts: &[&str]) -> String {
    format!("name = \"hall\"\n{}", parts.concat())
}

impl Gateway {
    pub(crate) fn start(config: &str) -> Self {
        Self::start_by(Command::new(PROGRAM), config)
    }

    /// One that may have so many files and connections open at a time.
    pub(crate) fn start_with_files(limit: u32, config: &str) -> Self {
        let mut shell = Command::new("sh");
        let script = format!("ulimit -n {limit}; exec \"$0\" \"$@\"");
        shell.args(["-c", &script, PROGRAM]);
        Self::start_by(shell, config)
    }

    fn start_by(mut program: Command, config: &str) -> Self {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("gateway.toml");
        fs::write(&path, config).unwrap();
        let mut process = program
            .arg("gateway")
            .arg(path)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let log = Arc::new(Mutex::new(String::new()));
        let (lines, kept) = (process.stderr.take().unwrap(), Arc::clone(&log));
        let reader = thread::spawn(move || {
            for line in BufReader::new(lines).lines().map_while(Result::ok) {
                let mut log = kept.lock().unwrap();
                log.push_str(&line);
                log.push('\n');
            }
        });
        Self {
            process,
            log,
            reader: Some(reader),
            folder,
        }
    }

    /// Seconds of a processor that it has used.
    pub(crate) fn cpu_s(&self) -> f64 {
        /// Of `/proc`, a second.
        const TICKS: f64 = 100.0;
        let text = fs::read_to_string(format!("/proc/{}/stat", self.process.id())).unwrap();
        // After the program's name, which is in brackets: the third field and those that follow.
        let fields: Vec<_> = text
            .rsplit_once(')')
            .unwrap()
            .1
            .split_whitespace()
            .collect();
        let ticks = |field: usize| fields[field - 3].parse::<f64>().unwrap();
        (ticks(14) + ticks(15)) / TICKS
    }

    /// Its memory, in MB.
    pub(crate) fn resident_mb(&self) -> f64 {
        let text = fs::read_to_string(format!("/proc/{}/status", self.process.id())).unwrap();
        let kib = text.lines().find_map(|line| {
            let line = line.strip_prefix("VmRSS:")?;
            line.strip_suffix("kB")?.trim().parse::<f64>().ok()
        });
        kib.unwrap() * 1024.0 / 1e6
    }

    pub(crate) fn log(&self) -> String {
        self.log.lock().unwrap().clone()
    }

    /// Waits until the log contains this.
    pub(crate) fn logs(&self, text: &str) {
        let begin = Instant::now();
        while !self.log().contains(text) {
            assert!(begin.elapsed() < PATIENCE, "no `{text}` in\n{}", self.log());
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Another configuration, and SIGHUP.
    pub(crate) fn reload(&self, config: &str) {
        fs::write(self.folder.path().join("gateway.toml"), config).unwrap();
        signal(&self.process, "-HUP");
    }

    /// SIGTERM, and the end that comes of it.
    pub(crate) fn stop(mut self) -> (ExitStatus, String) {
        terminate(&self.process);
        let status = self.process.wait().unwrap();
        // Its pipe is closed.
        self.reader.take().unwrap().join().unwrap();
        (status, self.log())
    }

    /// The same where the end is a good one; its log.
    pub(crate) fn ends(self) -> String {
        let (status, log) = self.stop();
        assert!(status.success(), "{log}");
        log
    }
}

impl Drop for Gateway {
    fn drop(&mut self) {
        drop(self.process.kill());
        drop(self.process.wait());
    }
}

/// The value of a metric.
pub(crate) fn metric(port: u16, name: &str) -> u64 {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    write!(stream, "GET /metrics HTTP/1.1\r\nHost: gateway\r\n\r\n").unwrap();
    let mut text = String::new();
    stream.read_to_string(&mut text).unwrap();
    assert!(text.starts_with("HTTP/1.1 200 OK"), "{text}");
    let value = text
        .lines()
        .find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    value
        .unwrap_or_else(|| panic!("no {name} in\n{text}"))
        .parse()
        .unwrap()
}
