//! A listener on both directions of a line.

use core::{mem, time::Duration};
use std::{
    fs,
    io::{self, IsTerminal as _, Read as _, Write as _},
    process::ExitCode,
    sync::mpsc::{self, RecvTimeoutError, Sender},
    thread,
    time::Instant,
};

use anyhow::{Context as _, Result, anyhow, bail};
use clap::Args;
use proto3964r::{Character, Diagnosis, Line, Priority, Side};

use super::serial::Frame;
use crate::{
    Preset,
    capture::{self, Kind, Report, Step, Tap},
    text,
};

/// A port that hears nothing for so long is asked again.
const PATIENCE: Duration = Duration::from_secs(3600);

/// What the verdict of a live tap looks back on.
const RECENT: Duration = Duration::from_secs(60);

/// How often the verdict of a live tap is looked for, at most.
const PAUSE: Duration = Duration::from_secs(1);

/// Tells what happens on a line, and at the end why it does not work.
///
/// A capture has one line per piece: the time in seconds, the direction (`>` from A to B, `<` from
/// B to A), and hexadecimal bytes; `?` after one that came in with a wrong parity bit, `!` after one
/// without a stop bit. `#` begins a comment.
///
///   0.000000 > 02
///   0.003000 < 10
///   0.004200 > 41 10 03 52
///   0.009000 < 10
///
/// With two ports, the first one listens to what A sends and the second one to what B sends.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub(super) struct Options {
    /// Capture file.
    #[arg(required_unless_present = "port", conflicts_with = "port")]
    capture: Option<String>,
    /// Port that hears A; given a second time, port that hears B.
    #[arg(long)]
    port: Vec<String>,
    /// Times and check of the line.
    #[arg(long, default_value = "siemens-3964r")]
    preset: Preset,
    #[command(flatten)]
    frame: Frame,
    /// Print verdicts as JSON, one a line, and nothing else.
    #[arg(long)]
    json: bool,
    /// End after this number of seconds; without it, ports are heard for ever.
    #[arg(long, requires = "port", value_parser = text::seconds, allow_hyphen_values = true)]
    seconds: Option<Duration>,
}

pub(super) fn run(options: &Options) -> Result<ExitCode> {
    // A listener has no priority and sends nothing.
    let tap = Tap::new(options.preset.config(Priority::Low, Line::Instant));
    let printer = Printer { json: options.json };
    match &options.capture {
        Some(path) => replay(path, tap, printer)?,
        None => listen(options, tap, printer)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints the conversation of a capture file and the verdict.
fn replay(path: &str, mut tap: Tap, printer: Printer) -> Result<()> {
    let text = fs::read_to_string(path).with_context(|| path.to_owned())?;
    let record = capture::read(&text).map_err(|error| anyhow!("{path}:{error}"))?;
    for character in record {
        printer.steps(tap.hear(character))?;
    }
    printer.conclude(tap.verdict())
}

/// How a conversation is told.
#[derive(Clone, Copy)]
struct Printer {
    json: bool,
}

impl Printer {
    fn steps(self, steps: Vec<Step>) -> Result<()> {
        if self.json {
            return Ok(());
        }
        for Step { at, kind, text, .. } in steps {
            print(&format!("{}s {text}", text::time(at)), colour(kind))?;
        }
        Ok(())
    }

    /// Prints a verdict on the last minute.
    fn recent(self, now: Duration, recent: Diagnosis) -> Result<()> {
        if self.json {
            print_json(Some(now), recent)
        } else {
            let now = text::time(now);
            print(&format!("{now}s verdict: {}", recent.verdict), "1")
        }
    }

    /// Prints the verdict on all.
    fn conclude(self, diagnosis: Diagnosis) -> Result<()> {
        if self.json {
            print_json(None, diagnosis)
        } else {
            print(&format!("verdict: {diagnosis}"), "1")
        }
    }
}

fn print_json(now: Option<Duration>, diagnosis: Diagnosis) -> Result<()> {
    let line = serde_json::to_string(&Report::new(now, diagnosis)).context("JSON")?;
    writeln!(io::stdout(), "{line}").context("standard output")
}

/// What a port has heard.
type Heard = io::Result<(Instant, Side, Vec<u8>)>;

/// Prints what two ports hear, and the verdict at the end.
fn listen(options: &Options, mut tap: Tap, printer: Printer) -> Result<()> {
    let [a, b] = &options.port[..] else {
        bail!("two ports are needed, one for each direction");
    };
    let begin = Instant::now();
    let (sender, receiver) = mpsc::channel();
    for (side, path) in [(Side::A, a), (Side::B, b)] {
        let port = options.frame.open(path, PATIENCE)?;
        let sender = sender.clone();
        thread::spawn(move || hear(port, side, &sender));
    }
    let mut verdict = None;
    let mut due = PAUSE;
    while options.seconds.is_none_or(|end| begin.elapsed() < end) {
        match receiver.recv_timeout(Duration::from_millis(20)) {
            Ok(heard) => {
                let (at, side, bytes) = heard?;
                for byte in bytes {
                    printer.steps(tap.hear(Character {
                        at: at - begin,
                        side,
                        byte,
                        error: None,
                    }))?;
                }
            }
            Err(RecvTimeoutError::Timeout) => printer.steps(tap.wait(begin.elapsed()))?,
            Err(RecvTimeoutError::Disconnected) => break,
        }
        let now = begin.elapsed();
        if now < due {
            continue;
        }
        due = now + PAUSE;
        // Its numbers change all the time.
        let recent = tap.verdict_since(now.saturating_sub(RECENT));
        let kind = mem::discriminant(&recent.verdict);
        if verdict.replace(kind) != Some(kind) {
            printer.recent(now, recent)?;
        }
    }
    printer.conclude(tap.verdict())
}

/// Reads a port until it or the monitor ends.
fn hear(mut port: Box<dyn serialport::SerialPort>, side: Side, sender: &Sender<Heard>) {
    let mut buffer = [0; 256];
    loop {
        let heard = match port.read(&mut buffer) {
            Ok(len) => Ok((
                Instant::now(),
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

/// The terminal's code: green for what goes well, red for what does not.
const fn colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Good => "32",
        Kind::Neutral => "0",
        Kind::Unusual => "33",
        Kind::Fault => "31",
    }
}

/// A line, in colour on a terminal.
fn print(text: &str, code: &str) -> Result<()> {
    let mut out = io::stdout();
    let printed = if out.is_terminal() {
        writeln!(out, "\x1b[{code}m{text}\x1b[0m")
    } else {
        writeln!(out, "{text}")
    };
    printed.context("standard output")
}
