//! The line: a pseudo-terminal, its bytes at the pace of 9600 bit/s in counted time, and a log.

use alloc::collections::VecDeque;
use core::time::Duration;
use std::io::{Read, Write};

use anyhow::{Context, Result, ensure};
use serialport::{SerialPort, TTYPort};

/// 8 data bits, even parity, one stop bit.
const BITS_PER_SECOND: u32 = 9600;
const BITS_PER_CHARACTER: u8 = 11;
/// What the stations know of it.
pub(crate) const WIRE: proto3964r::Line =
    proto3964r::Line::paced(BITS_PER_SECOND, BITS_PER_CHARACTER);
/// Time of a character on the line, rounded up.
const CHARACTER_US: u64 = (BITS_PER_CHARACTER as u64 * 1_000_000).div_ceil(BITS_PER_SECOND as u64);
/// Far longer than a pseudo-terminal holds a byte back.
const PATIENCE: Duration = Duration::from_secs(5);

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Control,
    Unit,
}

impl Side {
    const fn other(self) -> Self {
        match self {
            Self::Control => Self::Unit,
            Self::Unit => Self::Control,
        }
    }

    const fn arrow(self) -> char {
        match self {
            Self::Control => '>',
            Self::Unit => '<',
        }
    }
}

/// One end: its port, and the characters that wait in its transmitter.
struct End {
    port: TTYPort,
    waiting: VecDeque<u8>,
    /// When the first of them is on the other side.
    due_us: u64,
    bytes: usize,
}

impl End {
    fn new(mut port: TTYPort) -> Result<Self> {
        port.set_timeout(PATIENCE)?;
        Ok(Self {
            port,
            waiting: VecDeque::new(),
            due_us: 0,
            bytes: 0,
        })
    }
}

pub(crate) struct Line {
    control: End,
    unit: End,
    log: String,
    /// Who said the last line of the log, and when its last byte arrived.
    last: Option<(Side, u64)>,
}

impl Line {
    pub(crate) fn new() -> Result<Self> {
        let (control, unit) = TTYPort::pair().context("pseudo-terminal")?;
        Ok(Self {
            control: End::new(control)?,
            unit: End::new(unit)?,
            log: String::new(),
            last: None,
        })
    }

    fn end(&mut self, side: Side) -> &mut End {
        match side {
            Side::Control => &mut self.control,
            Side::Unit => &mut self.unit,
        }
    }

    /// Hands bytes to a side's transmitter.
    pub(crate) fn send(&mut self, side: Side, now_us: u64, bytes: &[u8]) {
        let end = self.end(side);
        if end.waiting.is_empty() {
            end.due_us = now_us + CHARACTER_US;
        }
        end.waiting.extend(bytes);
    }

    /// Drops what has not gone out.
    pub(crate) fn discard(&mut self, side: Side) {
        self.end(side).waiting.clear();
    }

    /// When the next character arrives.
    pub(crate) fn due_us(&self) -> Option<u64> {
        let due = |end: &End| (!end.waiting.is_empty()).then_some(end.due_us);
        [due(&self.control), due(&self.unit)]
            .into_iter()
            .flatten()
            .min()
    }

    /// The character that has gone out from `side` by now: through the pseudo-terminal, to the
    /// other side.
    pub(crate) fn carry(&mut self, side: Side, now_us: u64) -> Result<Option<u8>> {
        let end = self.end(side);
        if end.waiting.is_empty() || end.due_us > now_us {
            return Ok(None);
        }
        let Some(sent) = end.waiting.pop_front() else {
            return Ok(None);
        };
        let at_us = end.due_us;
        end.due_us += CHARACTER_US;
        end.bytes += 1;
        end.port.write_all(&[sent]).context("pseudo-terminal")?;
        let mut received = [0];
        let port = &mut self.end(side.other()).port;
        port.read_exact(&mut received).context("pseudo-terminal")?;
        let [received] = received;
        ensure!(
            received == sent,
            "the pseudo-terminal turned {sent:02X}h into {received:02X}h"
        );
        self.note(side, at_us, received);
        Ok(Some(received))
    }

    /// Bytes without a gap are one line of the log, with the time at which the first arrived.
    fn note(&mut self, side: Side, at_us: u64, byte: u8) {
        use core::fmt::Write as _;
        let goes_on = self
            .last
            .is_some_and(|(last, before)| last == side && at_us <= before + CHARACTER_US);
        self.last = Some((side, at_us));
        // Writing to a string does not fail.
        let _ = if goes_on {
            write!(self.log, " {byte:02X}")
        } else {
            let end = if self.log.is_empty() { "" } else { "\n" };
            let (seconds, micros) = (at_us / 1_000_000, at_us % 1_000_000);
            write!(
                self.log,
                "{end}{seconds}.{micros:06} {} {byte:02X}",
                side.arrow()
            )
        };
    }

    /// Bytes that a side has sent.
    pub(crate) const fn bytes(&self, side: Side) -> usize {
        match side {
            Side::Control => self.control.bytes,
            Side::Unit => self.unit.bytes,
        }
    }

    pub(crate) fn write_log(&self, mut out: impl Write) -> Result<()> {
        writeln!(out, "{}", self.log)?;
        Ok(out.flush()?)
    }
}
