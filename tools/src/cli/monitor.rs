//! A listener on both directions of a line.

mod saved;

use core::{future::pending, mem, time::Duration};
use std::{
    fs,
    io::{self, IsTerminal as _, Write as _},
    process::ExitCode,
    time::{Instant, SystemTime},
};

use anyhow::{Context as _, Result, anyhow, bail};
use clap::Args;
use monitor3964r::{Character, Diagnosis, Side, Verdict};
use proto3964r::{CharacterError, Line, Priority, tokio::Damage};
use tokio::{io::AsyncReadExt as _, select, time::sleep};

use self::saved::Saved;
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
/// B to A), and hexadecimal bytes; `?` after one that came in with a wrong parity bit, `!` after
/// one without a stop bit. `#` begins a comment.
///
///   0.000000 > 02
///   0.003000 < 10
///   0.004200 > 41 10 03 52
///   0.009000 < 10
///
/// With two ports, the first one listens to what A sends and the second one to what B sends.
///
/// The exit status is 1 where the last verdict names a fault, blocks that had to be repeated too.
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
    /// Keep what is heard: as pcapng for Wireshark if the name ends so, else as a capture of this
    /// program. The file must not exist.
    #[arg(long, value_name = "FILE")]
    save: Option<String>,
    /// Print verdicts as JSON, one a line, and nothing else.
    #[arg(long)]
    json: bool,
    /// End after this number of seconds; without it, ports are heard until Ctrl-C.
    #[arg(long, requires = "port", value_parser = text::seconds, allow_hyphen_values = true)]
    seconds: Option<Duration>,
}

pub(super) fn run(options: &Options) -> Result<ExitCode> {
    // A listener has no priority and sends nothing.
    let tap = Tap::new(options.preset.config(Priority::Low, Line::Instant));
    let teller = Teller {
        tap,
        json: options.json,
        file: None,
    };
    let verdict = match &options.capture {
        Some(path) => replay(path, options, teller)?,
        None => crate::runtime::block_on(listen(options, teller))?,
    };
    Ok(if verdict.is_fault() {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

/// Prints the conversation of a capture file and the verdict.
fn replay(path: &str, options: &Options, mut teller: Teller) -> Result<Verdict> {
    let text = fs::read_to_string(path).with_context(|| path.to_owned())?;
    let record = capture::read(&text).map_err(|error| anyhow!("{path}:{error}"))?;
    teller.save(options, Duration::ZERO)?;
    for piece in capture::pieces(&record) {
        teller.hear(piece)?;
    }
    teller.conclude(record.last().map_or(Duration::ZERO, |last| last.at))
}

/// A tap, and how what it hears is told and kept.
struct Teller {
    tap: Tap,
    json: bool,
    file: Option<(Saved, String)>,
}

impl Teller {
    /// Keeps what is heard from now on, if that is asked for.
    fn save(&mut self, options: &Options, epoch: Duration) -> Result<()> {
        if let Some(path) = &options.save {
            let file = Saved::create(path, epoch).with_context(|| path.clone())?;
            self.file = Some((file, path.clone()));
        }
        Ok(())
    }

    /// Tells what a piece means.
    fn hear(&mut self, piece: &[Character]) -> Result<()> {
        let steps = piece.iter().flat_map(|&heard| self.tap.hear(heard));
        let steps: Vec<_> = steps.collect();
        if let Some((file, path)) = &mut self.file {
            file.piece(piece, &steps).with_context(|| path.clone())?;
        }
        self.steps(&steps)
    }

    /// Tells what it means that nothing came.
    fn wait(&mut self, now: Duration) -> Result<()> {
        let steps = self.tap.wait(now);
        if let Some((file, path)) = &mut self.file {
            file.wait(&steps).with_context(|| path.clone())?;
        }
        self.steps(&steps)
    }

    fn steps(&self, steps: &[Step]) -> Result<()> {
        if self.json {
            return Ok(());
        }
        for Step { at, kind, text, .. } in steps {
            print(&format!("{}s {text}", text::time(*at)), colour(*kind))?;
        }
        Ok(())
    }

    /// Prints a verdict on the last minute.
    fn recent(&self, now: Duration, recent: Diagnosis) -> Result<()> {
        if self.json {
            print_json(Some(now), recent)
        } else {
            let now = text::time(now);
            print(&format!("{now}s verdict: {}", recent.verdict), "1")
        }
    }

    /// Tells the verdict on all.
    fn conclude(&mut self, now: Duration) -> Result<Verdict> {
        let diagnosis = self.tap.verdict();
        let verdict = format!("verdict: {diagnosis}");
        if let Some((file, path)) = &mut self.file {
            file.verdict(now, &verdict).with_context(|| path.clone())?;
        }
        if self.json {
            print_json(None, diagnosis)?;
        } else {
            print(&verdict, "1")?;
        }
        Ok(diagnosis.verdict)
    }
}

fn print_json(now: Option<Duration>, diagnosis: Diagnosis) -> Result<()> {
    let line = serde_json::to_string(&Report::new(now, diagnosis)).context("JSON")?;
    writeln!(io::stdout(), "{line}").context("standard output")
}

/// Prints what two ports hear, and the verdict at the end.
async fn listen(options: &Options, mut teller: Teller) -> Result<Verdict> {
    let [a, b] = &options.port[..] else {
        bail!("two ports are needed, one for each direction");
    };
    let mut ear_a = Ear::open(Side::A, a).await?;
    let mut ear_b = Ear::open(Side::B, b).await?;
    let begin = Instant::now();
    let epoch = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    teller.save(options, epoch.unwrap_or_default())?;
    let end = async {
        match options.seconds {
            Some(seconds) => sleep(seconds).await,
            None => pending().await,
        }
    };
    let ended = select! {
        ended = tell([&mut ear_a, &mut ear_b], begin, &mut teller) => ended,
        ended = crate::runtime::interrupted() => ended,
        () = end => Ok(()),
    };
    // Also where a port has gone.
    let verdict = teller.conclude(begin.elapsed());
    ended.and(verdict)
}

/// Tells what is heard, until a port goes.
async fn tell(ears: [&mut Ear; 2], begin: Instant, teller: &mut Teller) -> Result<()> {
    let [ear_a, ear_b] = ears;
    let mut verdict = None;
    let mut due = PAUSE;
    loop {
        let heard = select! {
            heard = ear_a.hear() => heard?,
            heard = ear_b.hear() => heard?,
            () = sleep(TICK) => Vec::new(),
        };
        let now = begin.elapsed();
        teller.wait(now)?;
        let heard: Vec<_> = heard
            .into_iter()
            .map(|heard| Character { at: now, ..heard })
            .collect();
        teller.hear(&heard)?;
        if now < due {
            continue;
        }
        due = now + PAUSE;
        // Its numbers change all the time.
        let recent = teller.tap.verdict_since(now.saturating_sub(RECENT));
        let kind = mem::discriminant(&recent.verdict);
        if verdict.replace(kind) != Some(kind) {
            teller.recent(now, recent)?;
        }
    }
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

    /// The next characters, without their time. May be dropped and called again.
    async fn hear(&mut self) -> Result<Vec<Character>> {
        let mut buffer = [0; 256];
        let intact = match self.port.read(&mut buffer).await {
            Ok(0) => bail!("{}: closed by the other end", self.name),
            Ok(len) => buffer.get(..len).unwrap_or_default(),
            Err(error) => match Damage::of(&error) {
                Some(Damage::Character { byte, error }) => {
                    return Ok(vec![self.character(byte, Some(error))]);
                }
                Some(_) => return Ok(vec![self.character(0, Some(CharacterError::Framing))]), // BREAK
                None => return Err(error).with_context(|| self.name.clone()),
            },
        };
        let intact = intact.iter().map(|&byte| self.character(byte, None));
        Ok(intact.collect())
    }

    const fn character(&self, byte: u8, error: Option<CharacterError>) -> Character {
        Character {
            at: Duration::ZERO,
            side: self.side,
            byte,
            error,
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
