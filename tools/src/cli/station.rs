//! One end of a line: hexadecimal lines in, events out.

mod events;

use core::time::Duration;
use std::{
    io::{self, Write as _},
    process::ExitCode,
    time::Instant,
};

use anyhow::{Context as _, Result};
use clap::{Args, ValueEnum};
use proto3964r::{Event, Priority, tokio::driver};
use tokio::{select, time::sleep};

pub(super) use self::events::describe;
use super::input;
use crate::{Address, Preset, text};

/// Longest block in either direction: that of a CP 341.
pub(super) const BLOCK: usize = 4096;

/// How soon the end is noticed.
const TICK: Duration = Duration::from_millis(20);

/// One end of a line, to bring up the other.
///
/// Lines of hexadecimal bytes on standard input are sent, `-` is the empty telegram; what happens
/// is printed, one event per line:
///
///   received [HEX ..]            a telegram
///   sent LENGTH                  a job acknowledged
///   failed PHASE CAUSE ATTEMPTS  a job given up, in the connection or transmission phase: timeout nak char line conflict stalled break
///   error CAUSE                  something answered NAK: bcc dle overflow line zvz endless nobuf noise
///   receive-failed CAUSE         no good repeat: bwz attempts nak
///   conflict COUNT               both sent STX
///   same-priority                both sides seem to have the same priority
///   break                        BREAK on the line
///
/// A line that is no telegram is reported, and makes the exit status 1, as a job that was given up
/// does. The program ends at the end of the input, after the outcome of the last job.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub(super) struct Options {
    /// Port: /dev/ttyUSB0?baud=9600&parity=even, tcp://HOST:PORT, rfc2217://HOST:PORT,
    /// tcp-listen://HOST:PORT, pty:PATH; line=instant where no wire is in between.
    #[arg(long)]
    port: Address,
    /// Who gives way when both sides want to send.
    #[arg(long)]
    priority: PriorityName,
    /// Times, attempts and policies.
    #[arg(long)]
    preset: Preset,
    /// Stay this number of seconds after the last outcome.
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = text::seconds, allow_hyphen_values = true)]
    listen: Duration,
    /// Print events as JSON, one object a line.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum PriorityName {
    High,
    Low,
}

impl From<PriorityName> for Priority {
    fn from(name: PriorityName) -> Self {
        match name {
            PriorityName::High => Self::High,
            PriorityName::Low => Self::Low,
        }
    }
}

pub(super) fn run(options: &Options) -> Result<ExitCode> {
    crate::runtime::block_on(work(options))
}

async fn work(options: &Options) -> Result<ExitCode> {
    let Options { port: address, .. } = options;
    let name = || address.target.to_string();
    let config = options
        .preset
        .config(options.priority.into(), address.line()?);
    let port = address.open().await.with_context(name)?;
    let mut line = driver::<BLOCK>(port, config);
    let mut input = input::lines();
    let mut code = ExitCode::SUCCESS;
    let mut input_ended = false;
    let mut last_outcome: Option<Instant> = None;
    loop {
        let is_free = !line.is_busy() && !input_ended;
        select! {
            event = line.wait() => match event {
                Ok(event) => {
                    if matches!(event, Event::Failed(_)) {
                        code = ExitCode::FAILURE;
                    }
                    if options.json {
                        writeln!(io::stdout(), "{}", events::json(event))?;
                    } else {
                        writeln!(io::stdout(), "{}", describe(event))?;
                    }
                }
                Err(error) => line.take_damage(error).with_context(name)?,
            },
            job = input.recv(), if is_free => match job {
                Some((number, job)) => {
                    let job = job.and_then(|job| parse(&job));
                    let job = job.and_then(|job| line.submit(&job).map_err(|error| error.to_string()));
                    if let Err(error) = job {
                        eprintln!("error: line {number}: {error}");
                        code = ExitCode::FAILURE;
                    }
                }
                None => input_ended = true,
            },
            () = sleep(TICK) => {}
        }
        if input_ended && !line.is_busy() && line.station_mut().is_idle() {
            let since = last_outcome.get_or_insert_with(Instant::now);
            if since.elapsed() >= options.listen {
                return Ok(code);
            }
        }
    }
}

fn parse(line: &str) -> Result<Vec<u8>, String> {
    match line {
        "-" => Ok(Vec::new()),
        hex => text::bytes(hex.split_whitespace()),
    }
}
