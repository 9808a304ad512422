//! One end of a 3964R line, to bring up the other: lines of hexadecimal bytes on standard input
//! are sent, what happens is printed, one event per line.
//!
//! ```text
//! cargo run --example station -- --port /dev/ttyUSB0 --priority high --preset siemens-3964r
//! ```
//!
//! ```text
//! received [HEX ..]                  a telegram
//! sent LENGTH                        a job acknowledged
//! failed setup|transfer CAUSE COUNT  a job given up: timeout nak char line collision stalled break
//! error CAUSE                        something answered NAK: bcc dle overflow line zvz endless nobuf noise
//! receive-failed CAUSE               no good repeat: bwz attempts nak
//! collision COUNT                    both sent STX
//! same-priority                      both sides seem to have the same priority
//! break                              BREAK on the line
//! ```
//! `-` on standard input is the empty telegram. A line that is no telegram is reported, and makes
//! the exit code 1. The program ends at the end of the input, after
//! the outcome of the last job; with `--listen` it stays that much longer.

mod preset;
mod text;

use core::{error::Error, time::Duration};
use std::{
    io::{self, BufRead as _, Write as _},
    process::ExitCode,
    sync::mpsc::{self, Receiver, TryRecvError},
    thread,
    time::Instant,
};

use clap::{Parser, ValueEnum};
use preset::{Parity, Preset};
use proto3964r::{
    Abandoned, Cause, Event, Failure, Priority, Rejection, frame::FrameError, serialport::Driver,
};

/// Longest block in either direction: that of a CP 341.
const BLOCK: usize = 4096;

/// How soon a new input line is noticed.
const TICK: Duration = Duration::from_millis(20);

/// One end of a 3964R line: sends hexadecimal lines from standard input, prints events.
#[derive(Parser)]
struct Options {
    /// Serial device or pseudo-terminal.
    #[arg(long)]
    port: String,
    /// Who gives way when both sides want to send.
    #[arg(long)]
    priority: PriorityName,
    /// Times, attempts and policies.
    #[arg(long)]
    preset: Preset,
    /// Bits per second.
    #[arg(long, default_value_t = 9600, value_parser = clap::value_parser!(u32).range(1..))]
    baud: u32,
    /// Parity bit.
    #[arg(long, default_value = "even")]
    parity: Parity,
    /// Stay so many seconds after the last outcome.
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = text::seconds, allow_hyphen_values = true)]
    listen: Duration,
}

#[derive(Clone, Copy, ValueEnum)]
enum PriorityName {
    High,
    Low,
}

/// A line of standard input: its number, and a job or what is wrong with it.
type Line = (usize, Result<Vec<u8>, String>);

fn main() -> ExitCode {
    match command_line::arguments()
        .map_err(Into::into)
        .and_then(|options| run(&options))
    {
        Ok(code) => code,
        Err(error) => {
            eprintln!("station: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<ExitCode, Box<dyn Error>> {
    let priority = match options.priority {
        PriorityName::High => Priority::High,
        PriorityName::Low => Priority::Low,
    };
    let port = serialport::new(&options.port, options.baud)
        .parity(options.parity.of_port())
        .open()
        .map_err(|error| format!("{}: {error}", options.port))?;
    let config = options
        .preset
        .config(priority)
        .with_line(options.baud, bits(options.parity));
    let mut line = Driver::<BLOCK>::new(port, config)?;
    let input = read_input();
    let mut code = ExitCode::SUCCESS;
    let mut input_ended = false;
    let mut last_outcome: Option<Instant> = None;
    loop {
        if line.station_mut().can_send() && !input_ended {
            match input.try_recv() {
                Ok((number, job)) => {
                    let sent =
                        job.and_then(|job| line.send(&job).map_err(|error| error.to_string()));
                    if let Err(error) = sent {
                        eprintln!("station: line {number}: {error}");
                        code = ExitCode::FAILURE;
                    }
                }
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => input_ended = true,
            }
        }
        let event = line.wait(TICK);
        if let Some(event) = event.map_err(|error| format!("{}: {error}", options.port))? {
            writeln!(io::stdout(), "{}", describe(event))?;
            continue;
        }
        if input_ended && line.station_mut().can_send() && line.station_mut().is_idle() {
            let since = last_outcome.get_or_insert_with(Instant::now);
            if since.elapsed() >= options.listen {
                return Ok(code);
            }
        }
    }
}

/// Bits of a character on the line, with start and stop bit.
fn bits(parity: Parity) -> u8 {
    match parity {
        Parity::None => 10,
        Parity::Even | Parity::Odd => 11,
    }
}

/// Reads standard input in a thread of its own.
fn read_input() -> Receiver<Line> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        for (number, line) in (1..).zip(io::stdin().lock().lines()) {
            let readable = match &line {
                Ok(_) => true,
                Err(error) => error.kind() == io::ErrorKind::InvalidData, // not text, but read
            };
            let job = match line {
                Ok(line) if line.trim().is_empty() => continue,
                Ok(line) => parse(line.trim()),
                Err(error) => Err(error.to_string()),
            };
            if sender.send((number, job)).is_err() || !readable {
                return;
            }
        }
    });
    receiver
}

fn parse(line: &str) -> Result<Vec<u8>, String> {
    match line {
        "-" => Ok(Vec::new()),
        hex => text::bytes(hex.split_whitespace()),
    }
}

/// The line of output for an event.
fn describe(event: Event<'_>) -> String {
    match event {
        Event::Received(telegram) => {
            let hex: String = telegram.iter().map(|byte| format!(" {byte:02X}")).collect();
            format!("received{hex}")
        }
        Event::Sent { len } => format!("sent {len}"),
        Event::Failed(Failure {
            phase,
            cause,
            attempts,
            ..
        }) => format!("failed {phase} {} {attempts}", cause_word(cause)),
        Event::Rejected(rejection) => format!("error {}", rejection_word(rejection)),
        Event::Abandoned(Abandoned::NoRepeat) => "receive-failed bwz".to_owned(),
        Event::Abandoned(Abandoned::TooMany(_)) => "receive-failed attempts".to_owned(),
        Event::Abandoned(Abandoned::ByPartner) => "receive-failed nak".to_owned(),
        Event::Collision { in_a_row } => format!("collision {in_a_row}"),
        Event::SamePriority => "same-priority".to_owned(),
        Event::Break => "break".to_owned(),
        other => format!("{other:?}"),
    }
}

fn cause_word(cause: Cause) -> String {
    match cause {
        Cause::Unexpected(_) => "char".to_owned(),
        Cause::Line(_) => "line".to_owned(),
        other => other.to_string(),
    }
}

fn rejection_word(rejection: Rejection) -> String {
    match rejection {
        Rejection::Frame(FrameError::Bcc { .. }) => "bcc".to_owned(),
        Rejection::Frame(FrameError::IllegalDle { .. }) => "dle".to_owned(),
        Rejection::Frame(FrameError::TooLong { .. }) => "overflow".to_owned(),
        Rejection::Line(_) => "line".to_owned(),
        Rejection::CharacterDelay => "zvz".to_owned(),
        Rejection::Endless => "endless".to_owned(),
        Rejection::NoBuffer => "nobuf".to_owned(),
        Rejection::Noise { .. } => "noise".to_owned(),
        other => other.to_string(),
    }
}
