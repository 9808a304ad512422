//! The line between control and pendant: its bytes at the speed of 9600 bit/s in counted time, and
//! a log.

use alloc::collections::VecDeque;
use core::fmt::Write as _;

use anyhow::Result;

/// 8 data bits, even parity, one stop bit.
const BITS_PER_SECOND: u32 = 9600;
const BITS_PER_CHARACTER: u8 = 11;
/// What the stations know of it.
pub(crate) const PACED: proto3964r::Line =
    proto3964r::Line::paced(BITS_PER_SECOND, BITS_PER_CHARACTER);
/// Time of a character on the line, rounded up.
const CHARACTER_US: u64 = (BITS_PER_CHARACTER as u64 * 1_000_000).div_ceil(BITS_PER_SECOND as u64);

/// An end of the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(clippy::exhaustive_enums, reason = "a line has two ends")]
pub enum Side {
    /// The control's.
    Control,
    /// The pendant's.
    Pendant,
}

impl Side {
    const fn arrow(self) -> char {
        match self {
            Self::Control => '>',
            Self::Pendant => '<',
        }
    }
}

/// What carries bytes: takes the one that an end sends, returns what arrives at the other.
pub type Wire<'a> = &'a mut dyn FnMut(Side, u8) -> Result<u8>;

/// The characters that wait in an end's transmitter.
#[derive(Default)]
struct Transmitter {
    waiting: VecDeque<u8>,
    /// When the first of them is at the other end.
    due_us: u64,
}

pub(crate) struct Line<'a> {
    wire: Box<dyn FnMut(Side, u8) -> Result<u8> + 'a>,
    control: Transmitter,
    pendant: Transmitter,
    log: String,
    bytes: usize,
    /// Who said the last line of the log, and when its last byte arrived.
    last: Option<(Side, u64)>,
}

impl<'a> Line<'a> {
    pub(crate) fn new(wire: impl FnMut(Side, u8) -> Result<u8> + 'a) -> Self {
        Self {
            wire: Box::new(wire),
            control: Transmitter::default(),
            pendant: Transmitter::default(),
            log: String::new(),
            bytes: 0,
            last: None,
        }
    }

    const fn transmitter(&mut self, side: Side) -> &mut Transmitter {
        match side {
            Side::Control => &mut self.control,
            Side::Pendant => &mut self.pendant,
        }
    }

    /// Hands bytes to an end's transmitter.
    pub(crate) fn send(&mut self, side: Side, now_us: u64, bytes: &[u8]) {
        let transmitter = self.transmitter(side);
        if transmitter.waiting.is_empty() {
            transmitter.due_us = now_us + CHARACTER_US;
        }
        transmitter.waiting.extend(bytes);
    }

    /// Drops what has not gone out.
    pub(crate) fn discard(&mut self, side: Side) {
        self.transmitter(side).waiting.clear();
    }

    /// When the next character arrives.
    pub(crate) fn due_us(&self) -> Option<u64> {
        let due = |it: &Transmitter| (!it.waiting.is_empty()).then_some(it.due_us);
        [due(&self.control), due(&self.pendant)]
            .into_iter()
            .flatten()
            .min()
    }

    /// The character from `side` that has arrived at the other end by now.
    pub(crate) fn carry(&mut self, side: Side, now_us: u64) -> Result<Option<u8>> {
        let transmitter = self.transmitter(side);
        if transmitter.due_us > now_us {
            return Ok(None);
        }
        let Some(sent) = transmitter.waiting.pop_front() else {
            return Ok(None);
        };
        let at_us = transmitter.due_us;
        transmitter.due_us += CHARACTER_US;
        self.bytes += 1;
        let received = (self.wire)(side, sent)?;
        self.note(side, at_us, received)?;
        Ok(Some(received))
    }

    /// Bytes without a gap are one line of the log, with the time at which the first arrived.
    fn note(&mut self, side: Side, at_us: u64, byte: u8) -> Result<()> {
        let goes_on = self
            .last
            .is_some_and(|(last, before)| last == side && at_us <= before + CHARACTER_US);
        self.last = Some((side, at_us));
        if goes_on {
            write!(self.log, " {byte:02X}")?;
        } else {
            let end = if self.log.is_empty() { "" } else { "\n" };
            let (seconds, micros) = (at_us / 1_000_000, at_us % 1_000_000);
            let arrow = side.arrow();
            write!(self.log, "{end}{seconds}.{micros:06} {arrow} {byte:02X}")?;
        }
        Ok(())
    }

    /// Bytes that both ends have sent.
    pub(crate) const fn bytes(&self) -> usize {
        self.bytes
    }

    /// The log: time in seconds, `>` from the control or `<` from the pendant, bytes.
    pub(crate) fn into_log(mut self) -> String {
        self.log.push('\n');
        self.log
    }
}
