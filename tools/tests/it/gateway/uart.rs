//! Partners of lines, on pseudo-terminals that carry characters at a baud rate and hand them over
//! in pieces, as USB adapters do.

use alloc::sync::Arc;
use core::{mem, time::Duration};
use std::{path::Path, sync::Mutex};

use line3964r::Address;
use proto3964r::{Config, Line, Priority, tokio::Link};
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, duplex, split},
    time::{Instant, sleep_until},
};

/// Bits of a character: 8E1, as the gateway has it.
const BITS: u8 = 11;

/// How soon characters reach a program.
#[derive(Clone, Copy)]
pub(crate) struct Pace {
    pub(crate) baud: u32,
    /// From one piece to the next.
    pub(crate) every: Duration,
}

/// Answers of the gateway: from the last character that was handed to it to the first of its own.
#[derive(Clone, Default)]
pub(crate) struct Answers(Arc<Mutex<Asked>>);

#[derive(Default)]
struct Asked {
    at: Option<Instant>,
    answers: Vec<Duration>,
}

impl Answers {
    fn asked(&self) {
        self.0.lock().unwrap().at = Some(Instant::now());
    }

    fn answered(&self) {
        let mut asked = self.0.lock().unwrap();
        let answer = asked.at.take().map(|at| at.elapsed());
        asked.answers.extend(answer);
    }

    /// Those since the last call.
    pub(crate) fn take(&self) -> Vec<Duration> {
        mem::take(&mut self.0.lock().unwrap().answers)
    }
}

/// A line that the gateway opens as a serial port.
pub(crate) struct Uart {
    /// The port, as the gateway opens it.
    pub(crate) address: Address,
    pub(crate) link: Link,
    pub(crate) answers: Answers,
}

impl Uart {
    pub(crate) async fn new(path: &Path, pace: Pace) -> Self {
        let path = path.display();
        let terminal: Address = format!("pty:{path}").parse().unwrap();
        let (from_gateway, to_gateway) = split(terminal.open().await.unwrap());
        let (here, there) = duplex(4096);
        let (from_partner, to_partner) = split(there);
        let answers = Answers::default();
        let noted = answers.clone();
        tokio::spawn(async move {
            let (asked, answered) = (|| noted.asked(), || noted.answered());
            // Until the link is dropped.
            tokio::select! {
                () = carry(from_partner, to_gateway, pace, || {}, asked) => {}
                () = carry(from_gateway, to_partner, pace, answered, || {}) => {}
            }
        });
        let config = Config::siemens_3964r(Priority::High, Line::buffered(pace.baud, BITS));
        Self {
            address: format!("{path}?baud={}", pace.baud).parse().unwrap(),
            link: Link::new(here, config),
            answers,
        }
    }

    /// The line in the gateway's configuration.
    pub(crate) fn line(&self, name: &str) -> String {
        let port = &self.address;
        format!("[[line]]\nname = \"{name}\"\nport = \"{port}\"\npriority = \"low\"\n")
    }
}

/// Carries characters, each in its time, and hands over those that have arrived when a piece is
/// due.
async fn carry(
    mut from: impl AsyncRead + Unpin,
    mut to: impl AsyncWrite + Unpin,
    pace: Pace,
    taken: impl Fn(),
    handing_over: impl Fn(),
) {
    let character = Duration::from_secs(u64::from(BITS)) / pace.baud;
    let start = Instant::now();
    let mut free_at = start;
    let mut piece = [0; 256];
    while let Ok(len @ 1..) = from.read(&mut piece).await {
        taken();
        let begin = free_at.max(Instant::now());
        let mut rest = &piece[..len];
        while !rest.is_empty() {
            let carried = u32::try_from(len - rest.len()).unwrap();
            let arrives = begin + character * (carried + 1) - start;
            let pieces = arrives.as_nanos().div_ceil(pace.every.as_nanos());
            sleep_until(start + pace.every * u32::try_from(pieces).unwrap()).await;
            let arrived = begin.elapsed().as_nanos() / character.as_nanos();
            let arrived = usize::try_from(arrived).unwrap().min(len);
            let (due, later) = rest.split_at(arrived - (len - rest.len()));
            handing_over();
            if to.write_all(due).await.is_err() {
                return;
            }
            rest = later;
        }
        free_at = begin + character * u32::try_from(len).unwrap();
    }
}
