//! The settings of a partner whose papers are lost.

use core::time::Duration;
use std::{io, process::ExitCode, time::Instant};

use anyhow::{Context as _, Result, bail};
use clap::Args;
use proto3964r::{Priority, frame::Check, tokio::Damage};
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _},
    time::timeout,
};

use crate::{
    Address, Frame, Port, Target,
    probe::{self, Bench, Findings, Heard, ParityFound, Span},
    text,
};

/// Finds what a live partner is set to, and prints it.
///
/// It sends STX and NAK alone, so that no telegram comes or goes: STX at each rate and parity,
/// until a lone DLE comes back. Then it measures how soon the partner answers and after which
/// silence it gives up, and waits for it to send something of its own: its priority and its QVZ
/// show only then. A BCC, a missing parity bit and the length of blocks show in blocks alone,
/// which --receive lets come: they are answered NAK, so that the partner repeats them and gives
/// them up in the end.
///
/// Nothing is guessed: what does not show is printed as `cannot tell`. The rate of a serial server
/// in raw mode (tcp) is its own. The exit status is 1 where nothing answers.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub(super) struct Options {
    /// Port, as for `station`; its rate and parity are tried first.
    #[arg(value_name = "PORT")]
    port: Address,
    /// Wait this number of seconds for the partner to send.
    #[arg(long, value_name = "SECONDS", default_value = "30", value_parser = text::seconds, allow_hyphen_values = true)]
    listen: Duration,
    /// Let a block of the partner come, and refuse it.
    #[arg(long)]
    receive: bool,
}

pub(super) fn run(options: &Options) -> Result<ExitCode> {
    let mut settings = probe::Options::usual();
    settings.listen = options.listen;
    settings.receives = options.receive;
    let own = options.port.frame.baud;
    match options.port.target {
        Target::Serial(_) | Target::Rfc2217(_) => {
            settings.rates.retain(|&rate| rate != own);
            settings.rates.insert(0, own);
        }
        // Whatever the server is set to; its characters take as long as is said here.
        Target::Tcp(_) => {
            options.port.line()?;
            settings.rates = vec![own];
        }
        _ => bail!(
            "{}: a partner is at a serial port or a serial server",
            options.port.target
        ),
    }
    let work = async {
        let mut bench = Line {
            address: options.port.clone(),
            port: None,
            begin: Instant::now(),
        };
        let name = || options.port.target.to_string();
        tokio::select! {
            found = probe::probe(&mut bench, &settings) => found.map(Some).with_context(name),
            ended = crate::runtime::interrupted() => ended.map(|()| None),
        }
    };
    let found = crate::runtime::block_on(work)?.unwrap_or_default();
    print(options, &found);
    Ok(if found.frame.is_some() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// A port, opened anew for each frame.
struct Line {
    address: Address,
    port: Option<Port>,
    begin: Instant,
}

impl Line {
    fn port(&mut self) -> io::Result<&mut Port> {
        self.port
            .as_mut()
            .ok_or_else(|| io::ErrorKind::NotConnected.into())
    }
}

impl Bench for Line {
    type Error = io::Error;

    fn now(&self) -> Duration {
        self.begin.elapsed()
    }

    fn tells_damage(&self) -> bool {
        cfg!(unix) && matches!(self.address.target, Target::Serial(_))
    }

    async fn set_frame(&mut self, frame: Frame) -> io::Result<()> {
        if matches!(self.address.target, Target::Tcp(_)) && self.port.is_some() {
            return Ok(());
        }
        // The one before is given back first.
        self.port = None;
        self.address.frame = frame;
        self.port = Some(self.address.open().await?);
        Ok(())
    }

    async fn send(&mut self, byte: u8) -> io::Result<()> {
        let port = self.port()?;
        port.write_all(&[byte]).await?;
        port.flush().await
    }

    async fn hear(&mut self, until: Duration) -> io::Result<Option<Heard>> {
        let (now, begin) = (self.now(), self.begin);
        let port = self.port()?;
        let Ok(read) = timeout(until.saturating_sub(now), port.read_u8()).await else {
            return Ok(None);
        };
        let byte = match read {
            Ok(byte) => Some(byte),
            Err(error) if Damage::of(&error).is_some() => None,
            Err(error) => return Err(error),
        };
        let at = begin.elapsed();
        Ok(Some(Heard { at, byte }))
    }
}

const UNKNOWN: &str = "cannot tell";

#[expect(clippy::print_stdout, reason = "what the program is for")]
fn print(options: &Options, found: &Findings) {
    let or_unknown = |text: Option<String>| text.unwrap_or_else(|| UNKNOWN.to_owned());
    let span = |span: Option<Span>| or_unknown(span.map(|span| span.to_string()));
    let Some((baud, parity)) = found.frame else {
        println!("nothing answers STX at any rate and parity");
        return;
    };
    let port = if let Target::Tcp(_) = options.port.target {
        println!("rate       that of the serial server");
        options.port.to_string()
    } else {
        println!("rate       {baud} bit/s");
        println!("parity     {parity}");
        let parity = match parity {
            ParityFound::EvenOrNone => "even|none".to_owned(),
            known => known.to_string(),
        };
        format!("{}?baud={baud}&parity={parity}", options.port.target)
    };
    let refused = match found.refused {
        0 => String::new(),
        times => format!(", NAK {times} times: no receive buffer"),
    };
    println!("answer     {}{refused}", span(found.answer));
    println!("ZVZ        {}", span(found.zvz));
    println!("QVZ        {}", span(found.qvz));
    let priority = found.priority.map(|priority| match priority {
        Priority::Low => "low: be the high side".to_owned(),
        Priority::High => "high: be the low side".to_owned(),
    });
    println!("priority   {}", or_unknown(priority));
    let check = found.check.map(|check| match check {
        Check::Bcc => "yes, 3964R".to_owned(),
        Check::None => "no, 3964".to_owned(),
    });
    println!("BCC        {}", or_unknown(check));
    let longest = found.longest.map(|len| format!("{len} bytes at least"));
    println!("block      {}", or_unknown(longest));
    let priority = match found.priority {
        Some(Priority::Low) => "high",
        Some(Priority::High) => "low",
        None => "low|high",
    };
    let preset = match found.check {
        Some(Check::Bcc) => "siemens-3964r",
        Some(Check::None) => "siemens-3964",
        None => "siemens-3964r|siemens-3964",
    };
    println!("--port '{port}' --priority {priority} --preset {preset}");
}
