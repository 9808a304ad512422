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

use anyhow::{Context as _, Result, anyhow, bail, ensure};
use clap::Args;
use proto3964r::{
    Character, Config, Diagnosis, Line, Monitor, Observation, Priority, Side, diagnose,
};
use serde::Serialize;

use crate::{port::Frame, preset::Preset, text};

/// Longest payload that is shown.
const BLOCK: usize = 4096;

/// A port that hears nothing for so long is asked again.
const PATIENCE: Duration = Duration::from_secs(3600);

/// What the verdict of a live tap looks back on.
const RECENT: Duration = Duration::from_secs(60);

/// How often the verdict of a live tap is looked for, at most.
const PAUSE: Duration = Duration::from_secs(1);

/// What a live tap keeps for its last verdict, in characters: a quarter of an hour of both
/// directions of a 9600-baud line that never rests.
const KEPT: usize = 1 << 21;

/// Tells what happens on a line, and at the end why it does not work.
///
/// A capture has one line per piece: the time in seconds, the direction (`>` from A to B, `<` from
/// B to A), and hexadecimal bytes. `#` begins a comment.
///
///   0.000000 > 02
///   0.003000 < 10
///   0.004200 > 41 10 03 52
///   0.009000 < 10
///
/// With two ports, the first one listens to what A sends and the second one to what B sends.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
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

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    // A listener has no priority and sends nothing.
    let config = options.preset.config(Priority::Low, Line::Instant);
    match &options.capture {
        Some(path) => replay(path, Tap::new(config, options.json))?,
        None => listen(options, Tap::new(config, options.json))?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints the conversation of a capture file and the verdict.
fn replay(path: &str, mut tap: Tap) -> Result<()> {
    let text = fs::read_to_string(path).with_context(|| path.to_owned())?;
    let mut before = Duration::ZERO;
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let (now, side, bytes) =
            parse(line).map_err(|error| anyhow!("{path}:{number}: {error}"))?;
        ensure!(
            now >= before,
            "{path}:{number}: time runs backwards: {} after {}",
            seconds(now),
            seconds(before)
        );
        before = now;
        tap.hear(now, side, &bytes)?;
    }
    tap.conclude()
}

/// A monitor, all that it has heard, and how it is told.
struct Tap {
    config: Config,
    monitor: Monitor<BLOCK>,
    record: Vec<Character>,
    json: bool,
}

impl Tap {
    fn new(config: Config, json: bool) -> Self {
        Self {
            config,
            monitor: Monitor::new(config),
            record: Vec::new(),
            json,
        }
    }

    /// Prints what the characters mean.
    fn hear(&mut self, at: Duration, side: Side, bytes: &[u8]) -> Result<()> {
        if self.record.len() >= KEPT {
            self.record.drain(..KEPT / 2);
        }
        for &byte in bytes {
            self.record.push(Character {
                at,
                side,
                byte,
                error: None,
            });
            show(at, self.monitor.handle_byte(at, side, byte), self.json)?;
        }
        Ok(())
    }

    /// Nothing has come up to now.
    fn wait(&mut self, now: Duration) -> Result<()> {
        show(now, self.monitor.handle_timeout(now), self.json)
    }

    /// The verdict on the last minute.
    fn recent(&self, now: Duration) -> Diagnosis {
        let from = now.saturating_sub(RECENT);
        let begin = self.record.partition_point(|heard| heard.at < from);
        diagnose(self.record.get(begin..).unwrap_or_default(), &self.config)
    }

    /// Prints a verdict on the last minute.
    fn report(&self, now: Duration, recent: &Diagnosis) -> Result<()> {
        if self.json {
            print_json(Some(now), recent)
        } else {
            print(
                &format!("{} verdict: {}", seconds(now), recent.verdict),
                "1",
            )
        }
    }

    /// Prints the verdict on all.
    fn conclude(&self) -> Result<()> {
        let diagnosis = diagnose(&self.record, &self.config);
        if self.json {
            print_json(None, &diagnosis)
        } else {
            print(&format!("verdict: {diagnosis}"), "1")
        }
    }
}

/// A verdict for programs.
#[derive(Serialize)]
struct Report<'d> {
    /// When, for a verdict on the last minute.
    #[serde(skip_serializing_if = "Option::is_none")]
    at_s: Option<f64>,
    /// As a person reads it.
    sentence: String,
    /// What tells the causes apart.
    measurement: Option<&'static str>,
    #[serde(flatten)]
    diagnosis: &'d Diagnosis,
}

fn print_json(now: Option<Duration>, diagnosis: &Diagnosis) -> Result<()> {
    let report = Report {
        at_s: now.map(|now| now.as_secs_f64()),
        sentence: diagnosis.verdict.to_string(),
        measurement: diagnosis.verdict.measurement(),
        diagnosis,
    };
    let line = serde_json::to_string(&report).context("JSON")?;
    writeln!(io::stdout(), "{line}").context("standard output")
}

fn parse(line: &str) -> Result<(Duration, Side, Vec<u8>), String> {
    let mut words = line.split_whitespace();
    let time = text::seconds(words.next().unwrap_or_default())?;
    let side = match words.next() {
        Some(">") => Side::A,
        Some("<") => Side::B,
        Some(other) => return Err(format!("`{other}` is neither `>` nor `<`")),
        None => return Err("no direction after the time".to_owned()),
    };
    let bytes = text::bytes(words)?;
    if bytes.is_empty() {
        return Err("no bytes after the direction".to_owned());
    }
    Ok((time, side, bytes))
}

/// What a port has heard.
type Heard = io::Result<(Instant, Side, Vec<u8>)>;

/// Prints what two ports hear, and the verdict at the end.
fn listen(options: &Options, mut tap: Tap) -> Result<()> {
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
                tap.hear(at - begin, side, &bytes)?;
            }
            Err(RecvTimeoutError::Timeout) => tap.wait(begin.elapsed())?,
            Err(RecvTimeoutError::Disconnected) => break,
        }
        let now = begin.elapsed();
        if now < due {
            continue;
        }
        due = now + PAUSE;
        // Its numbers change all the time.
        let recent = tap.recent(now);
        let kind = mem::discriminant(&recent.verdict);
        if verdict.replace(kind) != Some(kind) {
            tap.report(now, &recent)?;
        }
    }
    tap.conclude()
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

fn show<'a>(
    now: Duration,
    observations: impl Iterator<Item = Observation<'a>>,
    json: bool,
) -> Result<()> {
    if json {
        return Ok(());
    }
    for observation in observations {
        print(
            &format!("{} {observation}", seconds(now)),
            colour(&observation),
        )?;
    }
    Ok(())
}

/// A time as the captures have it.
fn seconds(time: Duration) -> String {
    format!("{}.{:06}s", time.as_secs(), time.subsec_micros())
}

/// The terminal's code: green for what goes well, red for what does not, plain for the rest.
fn colour(observation: &Observation<'_>) -> &'static str {
    match observation {
        Observation::Block { .. } | Observation::Accepted { .. } => "32",
        Observation::Request { .. } | Observation::Connected { .. } => "0",
        Observation::Conflict | Observation::Reset { .. } => "33",
        _ => "31",
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
