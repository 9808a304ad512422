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
//! `-` on standard input is the empty telegram. The program ends at the end of the input, after
//! the outcome of the last job; with `--listen` it stays that much longer.

mod preset;

use core::{error::Error, time::Duration};
use std::{
    io::{self, BufRead as _},
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
    #[arg(long, default_value_t = 9600)]
    baud: u32,
    /// Parity bit.
    #[arg(long, default_value = "even")]
    parity: Parity,
    /// Stay so many seconds after the last outcome.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    listen: f64,
}

#[derive(Clone, Copy, ValueEnum)]
enum PriorityName {
    High,
    Low,
}

/// A line of standard input: its number, and a job or what is wrong with it.
type Line = (usize, Result<Vec<u8>, String>);

fn main() -> ExitCode {
    match run(&Options::parse()) {
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
    let listen = Duration::try_from_secs_f64(options.listen)
        .map_err(|error| format!("--listen {}: {error}", options.listen))?;
    let mut line = Driver::<BLOCK>::new(port, config)?;
    let input = read_input();
    let mut code = ExitCode::SUCCESS;
    let mut input_ended = false;
    let mut end: Option<Instant> = None;
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
        if let Some(event) = line.wait(TICK)? {
            print(event);
            continue;
        }
        if input_ended && line.station_mut().can_send() && line.station_mut().is_idle() {
            let end = *end.get_or_insert_with(|| Instant::now() + listen);
            if Instant::now() >= end {
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
            let job = match line {
                Ok(line) if line.trim().is_empty() => continue,
                Ok(line) => parse(line.trim()),
                Err(error) => Err(error.to_string()),
            };
            if sender.send((number, job)).is_err() {
                return;
            }
        }
    });
    receiver
}

fn parse(line: &str) -> Result<Vec<u8>, String> {
    if line == "-" {
        return Ok(Vec::new());
    }
    line.split_whitespace()
        .map(|word| {
            let byte = u8::from_str_radix(word, 16);
            byte.map_err(|_| format!("`{word}` is not a hexadecimal byte"))
        })
        .collect()
}

fn print(event: Event<'_>) {
    match event {
        Event::Received(telegram) => {
            let hex: String = telegram.iter().map(|byte| format!(" {byte:02X}")).collect();
            println!("received{hex}");
        }
        Event::Sent { len } => println!("sent {len}"),
        Event::Failed(Failure {
            phase,
            cause,
            attempts,
            ..
        }) => {
            println!("failed {phase} {} {attempts}", cause_word(cause));
        }
        Event::Rejected(rejection) => println!("error {}", rejection_word(rejection)),
        Event::Abandoned(Abandoned::NoRepeat) => println!("receive-failed bwz"),
        Event::Abandoned(Abandoned::TooMany(_)) => println!("receive-failed attempts"),
        Event::Abandoned(Abandoned::ByPartner) => println!("receive-failed nak"),
        Event::Collision { in_a_row } => println!("collision {in_a_row}"),
        Event::SamePriority => println!("same-priority"),
        Event::Break => println!("break"),
        other => println!("{other:?}"),
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
