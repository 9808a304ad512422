//! The machine at the other end of a line, for a program that is to be tested without it.

mod answers;
mod heating;
mod paced;
mod pendant;
mod plc;

use core::{future::pending, time::Duration};
use std::{
    io::{self, Write as _},
    process::ExitCode,
    time::Instant,
};

use anyhow::{Context as _, Result, anyhow};
use clap::{Args, ValueEnum};
use proto3964r::{Config, Event, Line, Priority, tokio::driver};
use tokio::{
    io::{AsyncRead, AsyncWrite},
    select,
    sync::mpsc::Receiver,
    time::sleep,
};

use self::{answers::Answers, heating::Heating, paced::paced, pendant::Pendant, plc::Plc};
use super::{
    input::{self, InputLine},
    station::{BLOCK, PriorityName, describe},
};
use crate::{Address, Frame, Preset, Target, Wire, text};

/// Is the machine at the other end of a line.
///
/// What happens is printed as by `station`; lines of standard input tell the machine what to do. A
/// program that connects (tcp-listen) may go and come again; it hears a serial server: characters
/// take their time (baud=9600), unless the port has line=instant.
///
///   3964r  sends hexadecimal lines of standard input; --data has answers, `HEX = HEX` a line
///   rk512  a PLC that serves SEND and FETCH; --data has its memory, as TOML with bytes in
///          hexadecimal or their number: `db.10 = "0001 0203"`, `dx.2 = 64`, `flags = 256`,
///          inputs, outputs, timers, counters
///   km271  a Buderus KM271 that sends its values after EE 00 00 and then every 10 seconds; --data
///          has them, a hexadecimal telegram a line; such lines of standard input are sent at once
///   hbls   a EUCHNER hand-held pendant: `key 5`, `key` (released), `w1 3`, `w2 16`
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub(super) struct Options {
    /// The machine.
    machine: Machine,
    /// Port, as for `station`: pty:PATH and tcp-listen://HOST:PORT for a program on this PC.
    #[arg(long)]
    port: Address,
    /// What the machine knows.
    #[arg(long, value_name = "FILE")]
    data: Option<String>,
    /// Who gives way; by default the PLC is high, the others low.
    #[arg(long)]
    priority: Option<PriorityName>,
    /// Times, attempts and policies; by default those of the machine.
    #[arg(long)]
    preset: Option<Preset>,
    /// End after this number of seconds; without it, the machine runs until Ctrl-C.
    #[arg(long, value_parser = text::seconds, allow_hyphen_values = true)]
    seconds: Option<Duration>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Machine {
    #[value(name = "3964r")]
    Any,
    Rk512,
    Km271,
    Hbls,
}

/// What a machine does with telegrams. Times are since its start.
trait Partner {
    /// Takes a telegram.
    fn receive(&mut self, now: Duration, telegram: &[u8]);

    /// The next telegram to send; asked for while none is under way.
    fn poll_transmit(&mut self, now: Duration) -> Option<Vec<u8>>;

    /// Takes a line of standard input.
    fn order(&mut self, line: &str) -> Result<(), String>;

    /// What there is to print.
    fn poll_note(&mut self) -> Option<String> {
        None
    }

    /// Time has passed.
    fn handle_timeout(&mut self, _now: Duration) {}

    /// When `handle_timeout` or `poll_transmit` is due, without a telegram.
    fn poll_timeout(&self) -> Option<Duration> {
        None
    }

    /// What became of its telegram, if it has one under way.
    fn handle_outcome(&mut self, _now: Duration, _is_sent: bool) {}

    /// Whether its telegram is out of date.
    fn wants_recall(&self) -> bool {
        false
    }
}

pub(super) fn run(options: &Options) -> Result<ExitCode> {
    let partner = partner(options.machine, options.data.as_deref())?;
    let work = async {
        select! {
            done = work(options, partner) => done,
            ended = crate::runtime::interrupted() => ended,
            () = wait(Instant::now(), options.seconds) => Ok(()),
        }
    };
    crate::runtime::block_on(work)?;
    Ok(ExitCode::SUCCESS)
}

fn partner(machine: Machine, path: Option<&str>) -> Result<Box<dyn Partner>> {
    let text = match path {
        Some(path) => Some(std::fs::read_to_string(path).with_context(|| path.to_owned())?),
        None => None,
    };
    let text = text.as_deref();
    let made: Result<Box<dyn Partner>> = match machine {
        Machine::Any => Answers::new(text.unwrap_or_default()).map(|it| Box::new(it) as _),
        Machine::Rk512 => Plc::new(text.unwrap_or_default()).map(|it| Box::new(it) as _),
        Machine::Km271 => Heating::new(text).map(|it| Box::new(it) as _),
        Machine::Hbls if text.is_some() => Err(anyhow!("a pendant has no data")),
        Machine::Hbls => Ok(Box::new(Pendant::new())),
    };
    match path {
        Some(path) => made.with_context(|| path.to_owned()),
        None => made,
    }
}

/// The parameters of the machine's own station.
fn config(options: &Options) -> Result<Config> {
    let (preset, priority) = match options.machine {
        Machine::Any | Machine::Km271 => (Preset::Siemens3964r, Priority::Low),
        Machine::Rk512 => (Preset::Siemens3964r, Priority::High),
        Machine::Hbls => (Preset::Hbls, Priority::Low),
    };
    let priority = options.priority.map_or(priority, Priority::from);
    let preset = options.preset.unwrap_or(preset);
    let line = match paced_frame(&options.port) {
        Some(frame) => Line::buffered(frame.baud, frame.bits()),
        None => options.port.line()?,
    };
    Ok(preset.config(priority, line))
}

/// How fast characters go to a program that takes this machine for a serial server: `None` where
/// they go at once.
fn paced_frame(port: &Address) -> Option<Frame> {
    let is_server = matches!(port.target, Target::TcpListen(_));
    (is_server && port.wire != Some(Wire::Instant)).then_some(port.frame)
}

/// Serves one connection after the other, or the one port that there is.
async fn work(options: &Options, mut partner: Box<dyn Partner>) -> Result<()> {
    let name = || options.port.target.to_string();
    let mut orders = input::lines();
    let epoch = Instant::now();
    let config = config(options)?;
    loop {
        let port = options.port.open().await.with_context(name)?;
        let ended = match paced_frame(&options.port) {
            Some(frame) => {
                let port = paced(port, frame);
                serve(port, config, partner.as_mut(), &mut orders, epoch).await
            }
            None => serve(port, config, partner.as_mut(), &mut orders, epoch).await,
        };
        match ended {
            Err(_) if matches!(options.port.target, Target::TcpListen(_)) => {
                // What was under way to the one that has gone.
                partner.handle_outcome(epoch.elapsed(), false);
                writeln!(io::stdout(), "disconnected")?;
            }
            other => return other.with_context(name),
        }
    }
}

async fn serve(
    port: impl AsyncRead + AsyncWrite + Send + 'static,
    config: Config,
    partner: &mut dyn Partner,
    orders: &mut Receiver<InputLine>,
    epoch: Instant,
) -> Result<()> {
    let mut line = driver::<BLOCK>(port, config);
    let mut orders_ended = false;
    loop {
        let now = epoch.elapsed();
        partner.handle_timeout(now);
        if partner.wants_recall() {
            line.cancel();
        }
        if !line.is_busy()
            && let Some(telegram) = partner.poll_transmit(now)
            && let Err(error) = line.submit(&telegram)
        {
            eprintln!("error: {error}");
            partner.handle_outcome(now, false);
        }
        while let Some(note) = partner.poll_note() {
            writeln!(io::stdout(), "{note}")?;
        }
        let due = partner.poll_timeout();
        select! {
            event = line.wait() => match event {
                Ok(event) => {
                    writeln!(io::stdout(), "{}", describe(event))?;
                    let now = epoch.elapsed();
                    match event {
                        Event::Received(telegram) => partner.receive(now, telegram),
                        Event::Sent { .. } => partner.handle_outcome(now, true),
                        Event::Failed(_) => partner.handle_outcome(now, false),
                        _ => {}
                    }
                }
                Err(error) => line.take_damage(error)?,
            },
            order = orders.recv(), if !orders_ended => match order {
                Some((number, order)) => {
                    if let Err(error) = order.and_then(|order| partner.order(&order)) {
                        eprintln!("error: line {number}: {error}");
                    }
                }
                None => orders_ended = true,
            },
            () = wait(epoch, due) => {}
        }
    }
}

/// Returns when it is `due`, never without a time.
async fn wait(epoch: Instant, due: Option<Duration>) {
    match due {
        Some(due) => sleep(due.saturating_sub(epoch.elapsed())).await,
        None => pending().await,
    }
}
