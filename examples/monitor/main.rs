//! Listens to a 3964R line and tells what happens there, and at the end why it does not work.
//!
//! ```text
//! cargo run --example monitor -- capture.txt
//! cargo run --example monitor -- --port /dev/ttyUSB0 --port /dev/ttyUSB1 --seconds 60
//! ```
//! A capture has one line per piece: the time in seconds, the direction (`>` from A to B, `<` from
//! B to A), and hexadecimal bytes. `#` begins a comment. With two ports, the first one listens to
//! what A sends and the second one to what B sends.
//!
//! ```text
//! 0.000000 > 02
//! 0.003000 < 10
//! 0.004200 > 41 10 03 52
//! 0.009000 < 10
//! ```

#[path = "../station/preset.rs"]
mod preset;
#[path = "../station/text.rs"]
mod text;

use core::{error::Error, time::Duration};
use std::{
    fs,
    io::{self, IsTerminal as _, Read as _, Write as _},
    process::ExitCode,
    sync::mpsc::{self, RecvTimeoutError, Sender},
    thread,
    time::Instant as Clock,
};

use clap::Parser;
use preset::{Parity, Preset};
use proto3964r::{Config, Instant, Monitor, Observation, Priority, Side};

/// Longest payload that is shown.
const BLOCK: usize = 4096;

type Tap = Monitor<BLOCK>;

/// A listener on both directions of a 3964R line.
#[derive(Parser)]
struct Options {
    /// Capture file.
    #[arg(required_unless_present = "port", conflicts_with = "port")]
    capture: Option<String>,
    /// Port that hears A; given a second time, port that hears B.
    #[arg(long)]
    port: Vec<String>,
    /// Times and check of the line.
    #[arg(long, default_value = "siemens-3964r")]
    preset: Preset,
    /// Bits per second of the ports.
    #[arg(long, default_value_t = 9600, value_parser = clap::value_parser!(u32).range(1..))]
    baud: u32,
    /// Parity bit of the ports.
    #[arg(long, default_value = "even")]
    parity: Parity,
    /// End after so many seconds; without it, ports are heard for ever.
    #[arg(long, requires = "port", value_parser = text::seconds, allow_hyphen_values = true)]
    seconds: Option<Duration>,
}

fn main() -> ExitCode {
    match command_line::arguments()
        .map_err(Into::into)
        .and_then(|options| run(&options))
    {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("monitor: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let config = options.preset.config(Priority::Low);
    match &options.capture {
        Some(path) => replay(path, config),
        None => listen(options, config),
    }
}

/// Prints the conversation of a capture file and the verdict.
fn replay(path: &str, config: Config) -> Result<(), Box<dyn Error>> {
    let text = fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let mut monitor = Tap::new(config);
    let mut before = Instant::ZERO;
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let (now, side, bytes) =
            parse(line).map_err(|error| format!("{path}:{number}: {error}"))?;
        if now < before {
            return Err(
                format!("{path}:{number}: time runs backwards: {now} behind {before}").into(),
            );
        }
        before = now;
        for byte in bytes {
            show(now, monitor.handle_byte(now, side, byte))?;
        }
    }
    conclude(&monitor)?;
    Ok(())
}

fn parse(line: &str) -> Result<(Instant, Side, Vec<u8>), String> {
    let mut words = line.split_whitespace();
    let time = text::seconds(words.next().unwrap_or_default())?;
    let side = match words.next() {
        Some(">") => Side::A,
        Some("<") => Side::B,
        Some(other) => return Err(format!("`{other}` is neither `>` nor `<`")),
        None => return Err("no direction behind the time".to_owned()),
    };
    let bytes = text::bytes(words)?;
    if bytes.is_empty() {
        return Err("no bytes behind the direction".to_owned());
    }
    Ok((Instant::ZERO + time, side, bytes))
}

/// What a port has heard.
type Heard = io::Result<(Clock, Side, Vec<u8>)>;

/// Prints what two ports hear, and the verdict at the end.
fn listen(options: &Options, config: Config) -> Result<(), Box<dyn Error>> {
    let [a, b] = &options.port[..] else {
        return Err("two ports are needed, one for each direction".into());
    };
    let begin = Clock::now();
    let (sender, receiver) = mpsc::channel();
    for (side, path) in [(Side::A, a), (Side::B, b)] {
        let port = serialport::new(path, options.baud)
            .parity(options.parity.of_port())
            .timeout(Duration::from_secs(3600))
            .open()
            .map_err(|error| format!("{path}: {error}"))?;
        let sender = sender.clone();
        thread::spawn(move || hear(port, side, &sender));
    }
    let mut monitor = Tap::new(config);
    let mut verdict = monitor.verdict();
    while options.seconds.is_none_or(|end| begin.elapsed() < end) {
        match receiver.recv_timeout(Duration::from_millis(20)) {
            Ok(heard) => {
                let (at, side, bytes) = heard?;
                let now = Instant::ZERO + (at - begin);
                for byte in bytes {
                    show(now, monitor.handle_byte(now, side, byte))?;
                }
            }
            Err(RecvTimeoutError::Timeout) => {
                let now = Instant::ZERO + begin.elapsed();
                show(now, monitor.handle_timeout(now))?;
            }
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if monitor.verdict() != verdict {
            verdict = monitor.verdict();
            conclude(&monitor)?;
        }
    }
    conclude(&monitor)?;
    Ok(())
}

/// Reads a port until it or the monitor ends.
fn hear(mut port: Box<dyn serialport::SerialPort>, side: Side, sender: &Sender<Heard>) {
    let mut buffer = [0; 256];
    loop {
        let heard = match port.read(&mut buffer) {
            Ok(len) => Ok((
                Clock::now(),
                side,
                buffer.get(..len).unwrap_or_default().to_vec(),
            )),
            Err(error) if error.kind() == io::ErrorKind::TimedOut => continue,
            Err(error) => Err(error),
        };
        let failed = heard.is_err();
        if sender.send(heard).is_err() || failed {
            return;
        }
    }
}

fn show<'a>(now: Instant, observations: impl Iterator<Item = Observation<'a>>) -> io::Result<()> {
    for observation in observations {
        print(&format!("{now} {observation}"), colour(&observation))?;
    }
    Ok(())
}

fn conclude(monitor: &Tap) -> io::Result<()> {
    print(&format!("verdict: {}", monitor.verdict()), "1")
}

/// The terminal's code: green for what goes well, red for what does not, plain for the rest.
fn colour(observation: &Observation<'_>) -> &'static str {
    match observation {
        Observation::Block { .. } | Observation::Accepted { .. } => "32",
        Observation::Request { .. } | Observation::Connected { .. } => "0",
        Observation::Collision | Observation::Reset { .. } => "33",
        _ => "31",
    }
}

/// A line, in colour on a terminal.
fn print(text: &str, code: &str) -> io::Result<()> {
    let mut out = io::stdout();
    if out.is_terminal() {
        writeln!(out, "\x1b[{code}m{text}\x1b[0m")
    } else {
        writeln!(out, "{text}")
    }
}
