//! What a live partner is set to, as its answers to STX and NAK show it.
//!
//! Goal: the settings of the other end of a line whose papers are lost, while no telegram is sent
//! or taken. Method: STX at each rate and parity, until a lone DLE comes back, and NAK after the
//! silence that follows it, which no other setting can make of either; then the times of both, some
//! times over; then whoever asks by STX is asked by STX: the side of low priority gives way by DLE.
//! What does not show is not guessed.

mod block;
mod findings;

use core::{future::Future, time::Duration};

use proto3964r::{
    Priority,
    ascii::{DLE, NAK, STX},
};

pub use self::findings::{Findings, ParityFound, Span};
use crate::{Frame, Parity};

/// The other end of the partner's line.
pub trait Bench {
    /// What ends a probe before it is done.
    type Error;

    /// Time since an epoch of its own.
    fn now(&self) -> Duration;

    /// Whether it tells which characters came in damaged.
    fn tells_damage(&self) -> bool;

    /// Sets rate and parity from now on.
    ///
    /// # Errors
    /// Those of the port.
    fn set_frame(&mut self, frame: Frame) -> impl Future<Output = Result<(), Self::Error>>;

    /// Sends a character.
    ///
    /// # Errors
    /// Those of the port.
    fn send(&mut self, byte: u8) -> impl Future<Output = Result<(), Self::Error>>;

    /// The next character, unless this time comes before it.
    ///
    /// # Errors
    /// Those of the port.
    fn hear(&mut self, until: Duration)
    -> impl Future<Output = Result<Option<Heard>, Self::Error>>;
}

/// A character of the partner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::exhaustive_structs, reason = "what a port can know of it")]
pub struct Heard {
    /// When it had come.
    pub at: Duration,
    /// What it is; `None` where it came in damaged.
    pub byte: Option<u8>,
}

/// How far a probe goes.
#[derive(Clone, Debug)]
#[expect(clippy::exhaustive_structs, reason = "plain settings")]
pub struct Options {
    /// Rates to try, in bit/s, the likely ones first.
    pub rates: Vec<u32>,
    /// How long the partner is waited for to send something of its own.
    pub listen: Duration,
    /// Whether a block of its own is heard: its STX is answered DLE, and the block NAK, so that it
    /// repeats it and gives it up in the end.
    pub receives: bool,
}

impl Options {
    /// The usual rates; half a minute of listening; no block.
    #[must_use]
    pub fn usual() -> Self {
        Self {
            rates: vec![9600, 19_200, 38_400, 57_600, 115_200, 4800, 2400, 1200],
            listen: Duration::from_secs(30),
            receives: false,
        }
    }
}

/// The longest answer that is waited for: QVZ is 2 s with BCC.
const ANSWER: Duration = Duration::from_millis(2600);
/// The longest silence after DLE that is waited for: ZVZ is 220 ms.
const SILENCE: Duration = Duration::from_millis(2600);
/// A line on which nothing comes for so long is at rest, unless a side waits for an answer.
const REST: Duration = Duration::from_millis(700);
/// The longest that rest is waited for.
const UNREST: Duration = Duration::from_secs(6);
/// An STX after so long is not the repeat of one.
const FRESH: Duration = Duration::from_secs(5);
/// Tries at a rate and parity, of which this number must show it.
const TRIES: (u32, u32) = (4, 2);
/// Times that an answer is measured.
const TIMES: u32 = 5;

/// What comes of an STX.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    /// DLE, and NAK after the silence: their times without those of the characters.
    Ready {
        delay: Duration,
        silence: Duration,
    },
    /// NAK.
    Refused,
    /// STX: the partner wants to send.
    Conflict,
    /// Anything else.
    Garbage,
    Silent,
}

/// Finds what a partner is set to.
///
/// # Errors
/// Those of the bench.
pub async fn probe<B: Bench>(bench: &mut B, options: &Options) -> Result<Findings, B::Error> {
    let mut probe = Probe {
        bench,
        findings: Findings::default(),
        parity: Parity::Even,
        character: Duration::ZERO,
        last: None,
    };
    for &baud in &options.rates {
        // STX, DLE and NAK have an odd number of ones: without parity they look as with an even
        // one.
        for parity in [Parity::Even, Parity::Odd] {
            let frame = Frame {
                baud,
                parity,
                stop_bits: 1,
            };
            if probe.answers_at(frame).await? {
                let parity = match parity {
                    Parity::Odd => ParityFound::Odd,
                    Parity::Even | Parity::None => ParityFound::EvenOrNone,
                };
                probe.findings.frame = Some((baud, parity));
                probe.measure().await?;
                probe.listen(options).await?;
                return Ok(probe.findings);
            }
        }
    }
    Ok(probe.findings)
}

struct Probe<'b, B> {
    bench: &'b mut B,
    findings: Findings,
    /// That of the bench.
    parity: Parity,
    /// Time of one.
    character: Duration,
    /// What the partner has said last.
    last: Option<Heard>,
}

impl<B: Bench> Probe<'_, B> {
    async fn hear(&mut self, until: Duration) -> Result<Option<Heard>, B::Error> {
        let heard = self.bench.hear(until).await?;
        self.last = heard.or(self.last);
        Ok(heard)
    }

    /// Waits until nothing has come for a while.
    async fn rest(&mut self) -> Result<(), B::Error> {
        let end = self.bench.now() + UNREST;
        loop {
            let until = self.bench.now() + REST;
            if until > end || self.hear(until).await?.is_none() {
                return Ok(());
            }
        }
    }

    async fn set(&mut self, frame: Frame) -> Result<(), B::Error> {
        self.parity = frame.parity;
        self.character = Duration::from_secs(1) * u32::from(frame.bits()) / frame.baud;
        self.bench.set_frame(frame).await
    }

    /// Whether what the partner says is made so.
    async fn answers_at(&mut self, frame: Frame) -> Result<bool, B::Error> {
        self.set(frame).await?;
        self.bench.send(NAK).await?;
        self.rest().await?;
        let (tries, enough) = TRIES;
        let (mut ready, mut said) = (0, 0);
        for _ in 0..tries {
            match self.ask().await? {
                Answer::Ready { .. } => ready += 1,
                // Where damage is told, these are made as they should be.
                Answer::Refused | Answer::Conflict if self.bench.tells_damage() => said += 1,
                Answer::Refused | Answer::Conflict => {}
                Answer::Garbage | Answer::Silent => return Ok(false),
            }
            if ready >= enough || ready + said > enough {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Sends STX, and hears what comes of it until the line rests.
    async fn ask(&mut self) -> Result<Answer, B::Error> {
        self.bench.send(STX).await?;
        let asked = self.bench.now();
        let Some(first) = self.hear(asked + ANSWER).await? else {
            return Ok(Answer::Silent);
        };
        let answer = match first.byte {
            Some(DLE) => {
                let next = self.hear(first.at + SILENCE).await?;
                match next {
                    Some(Heard {
                        at,
                        byte: Some(NAK),
                    }) => Answer::Ready {
                        delay: first.at.saturating_sub(asked + self.character * 2),
                        silence: at.saturating_sub(first.at + self.character),
                    },
                    // One that waits for longer than this probe.
                    None => Answer::Silent,
                    _ => Answer::Garbage,
                }
            }
            Some(NAK) => Answer::Refused,
            Some(STX) => Answer::Conflict,
            _ => Answer::Garbage,
        };
        self.rest().await?;
        Ok(answer)
    }

    async fn measure(&mut self) -> Result<(), B::Error> {
        for _ in 0..TIMES {
            match self.ask().await? {
                Answer::Ready { delay, silence } => {
                    Span::widen(&mut self.findings.answer, delay);
                    Span::widen(&mut self.findings.zvz, silence);
                }
                Answer::Refused => self.findings.refused += 1,
                _ => {}
            }
        }
        Ok(())
    }

    /// Waits for what the partner sends of its own.
    async fn listen(&mut self, options: &Options) -> Result<(), B::Error> {
        let end = self.bench.now() + options.listen;
        let mut before = [None, self.last];
        let mut unanswered = None;
        while let Some(heard) = self.hear(end).await? {
            let is_stx = heard.byte == Some(STX);
            if let Some(asked) = unanswered.take().filter(|_| is_stx) {
                let wait = heard.at.saturating_sub(asked + self.character);
                Span::widen(&mut self.findings.qvz, wait);
            }
            if is_stx && self.findings.priority.is_none() && is_first(before, heard) {
                self.conflict(end).await?;
            } else if is_stx && options.receives && self.findings.check.is_none() {
                self.receive().await?;
            } else if is_stx {
                unanswered = Some(heard.at);
            }
            before = [before[1], self.last];
            if self.is_done(options) {
                break;
            }
        }
        Ok(())
    }

    const fn is_done(&self, options: &Options) -> bool {
        let found = &self.findings;
        let has_block = found.check.is_some() || !options.receives;
        found.priority.is_some() && found.qvz.is_some() && has_block
    }

    /// Asks while the partner asks for the first time: who gives way has the low priority. Who does
    /// not is asked again, as an STX may be lost; some of high priority give way from then on.
    async fn conflict(&mut self, end: Duration) -> Result<(), B::Error> {
        for is_again in [false, true] {
            self.bench.send(STX).await?;
            match self.hear(end).await?.and_then(|heard| heard.byte) {
                Some(DLE) if !is_again => self.findings.priority = Some(Priority::Low),
                Some(STX) if !is_again => continue,
                Some(STX | NAK) if is_again && self.findings.answer.is_some() => {
                    self.findings.priority = Some(Priority::High);
                }
                _ => {}
            }
            break;
        }
        Ok(())
    }
}

/// Whether an STX is the first of a job: after a silence, or after a job that was given up without
/// an answer. Later on another rule may hold.
fn is_first([older, before]: [Option<Heard>; 2], heard: Heard) -> bool {
    let has_byte = |heard: Option<Heard>, byte| heard.and_then(|heard| heard.byte) == Some(byte);
    before.is_none_or(|before| heard.at.saturating_sub(before.at) > FRESH)
        || has_byte(before, NAK) && has_byte(older, STX)
}
