//! A listener on both directions of a line.

use core::{mem, time::Duration};
use std::{
    fs,
    io::{self, IsTerminal as _, Write as _},
    process::ExitCode,
    time::Instant,
};

use anyhow::{Context as _, Result, anyhow, bail};
use clap::Args;
use proto3964r::{Character, Diagnosis, Line, LineError, Priority, Side, tokio::Damage};
use tokio::{io::AsyncReadExt as _, select, time::sleep};

use crate::{
    Address, Port, Preset,
    capture::{self, Kind, Report, Step, Tap},
    text,
};

/// How soon a wait that has become too long is told.
const TICK: Duration = Duration::from_millis(20);

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
    /// Port that hears A; given a second time, port that hears B. Its syntax is that of `station`.
    #[arg(long)]
    port: Vec<Address>,
    /// Times and check of the line.
    #[arg(long, default_value = "siemens-3964r")]
    preset: Preset,
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
        None => super::block_on(listen(options, tap, printer))?,
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

/// Prints what two ports hear, and the verdict at the end.
async fn listen(options: &Options, mut tap: Tap, printer: Printer) -> Result<()> {
    let [a, b] = &options.port[..] else {
        bail!("two ports are needed, one for each direction");
    };
    let mut ear_a = Ear::open(Side::A, a).await?;
    let mut ear_b = Ear::open(Side::B, b).await?;
    let begin = Instant::now();
    let mut verdict = None;
    let mut due = PAUSE;
    while options.seconds.is_none_or(|end| begin.elapsed() < end) {
        let heard = select! {
            heard = ear_a.hear() => heard?,
            heard = ear_b.hear() => heard?,
            () = sleep(TICK) => Vec::new(),
        };
        let now = begin.elapsed();
        printer.steps(tap.wait(now))?;
        for (side, byte, error) in heard {
            printer.steps(tap.hear(Character {
                at: now,
                side,
                byte,
                error,
            }))?;
        }
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

/// A port that hears one side.
struct Ear {
    side: Side,
    port: Port,
    name: String,
}

impl Ear {
    async fn open(side: Side, address: &Address) -> Result<Self> {
        let name = address.target.to_string();
        let port = address.open().await.with_context(|| name.clone())?;
        Ok(Self { side, port, name })
    }

    /// The next characters. May be dropped and called again.
    async fn hear(&mut self) -> Result<Vec<(Side, u8, Option<LineError>)>> {
        let mut buffer = [0; 256];
        let intact = match self.port.read(&mut buffer).await {
            Ok(0) => bail!("{}: closed by the other end", self.name),
            Ok(len) => buffer.get(..len).unwrap_or_default(),
            Err(error) => match Damage::of(&error) {
                Some(Damage::Character { byte, error }) => {
                    return Ok(vec![(self.side, byte, Some(error))]);
                }
                Some(_) => return Ok(vec![(self.side, 0, Some(LineError::Framing))]), // BREAK
                None => return Err(error).with_context(|| self.name.clone()),
            },
        };
        Ok(intact.iter().map(|&byte| (self.side, byte, None)).collect())
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
