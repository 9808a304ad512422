//! What a monitor sees.

use core::{fmt, iter::FusedIterator, time::Duration};

use proto3964r::{CharacterError, Hex, frame::FrameError};

use super::side::Side;

/// One step of the conversation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Observation<'a> {
    /// STX: this side wants to send.
    Request {
        /// The side.
        side: Side,
        /// Requests in a row without a connection, from 1.
        attempt: u8,
    },
    /// Both sides sent STX.
    Conflict,
    /// STX although the other side's STX has had no answer and came too long ago to cross.
    RequestUnanswered {
        /// Who should have answered.
        side: Side,
        /// Since the other side's STX.
        delay: Duration,
    },
    /// Both sides answered the other's STX with DLE, and neither sends.
    BothGaveWay,
    /// DLE to STX: ready to receive.
    Connected {
        /// The receiver.
        by: Side,
        /// Since the STX.
        delay: Duration,
    },
    /// NAK to STX.
    Refused {
        /// The receiver.
        by: Side,
        /// Since the STX.
        delay: Duration,
    },
    /// Data right after STX, without waiting for the answer.
    DidNotWait {
        /// The sender.
        side: Side,
    },
    /// A block whose form and check are right.
    Block {
        /// The sender.
        by: Side,
        /// Its payload.
        payload: &'a [u8],
    },
    /// A block that is no good.
    BadBlock {
        /// The sender.
        by: Side,
        /// What is wrong with it.
        error: FrameError,
    },
    /// A block ends with DLE ETX: the sender speaks 3964 without BCC.
    NoBcc {
        /// The sender.
        by: Side,
    },
    /// The answer came before the BCC, which came all the same: the receiver speaks 3964 without
    /// BCC.
    BccNotAwaited {
        /// The receiver.
        by: Side,
    },
    /// No block after DLE.
    NoBlock {
        /// Who should send it.
        by: Side,
        /// Since the DLE.
        waited: Duration,
    },
    /// DLE to a block.
    Accepted {
        /// The receiver.
        by: Side,
        /// Since the end of the block.
        delay: Duration,
    },
    /// NAK to a block.
    Rejected {
        /// The receiver.
        by: Side,
        /// Since the end of the block.
        delay: Duration,
    },
    /// STX in place of the answer to a block.
    RequestForAnswer {
        /// The receiver.
        by: Side,
        /// Since the end of the block.
        delay: Duration,
    },
    /// NAK into a block.
    Aborted {
        /// The receiver.
        by: Side,
    },
    /// The sender left its block unfinished.
    BrokenOff {
        /// The sender.
        by: Side,
    },
    /// NAK without a question: start-up, after noise, or the end of the last attempt.
    Reset {
        /// Who sent it.
        side: Side,
    },
    /// No answer within QVZ.
    NoAnswer {
        /// Who should have answered.
        silent: Side,
        /// How long the other waited so far.
        waited: Duration,
    },
    /// A pause longer than ZVZ in a block.
    Gap {
        /// The sender.
        by: Side,
        /// The pause so far.
        gap: Duration,
    },
    /// A character that has no place in the procedure.
    Stray {
        /// Who sent it.
        side: Side,
        /// The character.
        byte: u8,
    },
    /// A character that came in damaged.
    Damaged {
        /// Who sent it.
        side: Side,
        /// What was read.
        byte: u8,
        /// What the receiver circuit says.
        error: CharacterError,
    },
}

impl Observation<'_> {
    /// Whose step it is: who sent something, or who should have; `None` for what both did.
    #[must_use]
    pub const fn side(&self) -> Option<Side> {
        match *self {
            Self::Conflict | Self::BothGaveWay => None,
            Self::Request { side, .. }
            | Self::RequestUnanswered { side, .. }
            | Self::DidNotWait { side }
            | Self::Reset { side }
            | Self::Stray { side, .. }
            | Self::Damaged { side, .. } => Some(side),
            Self::NoAnswer { silent, .. } => Some(silent),
            Self::Connected { by, .. }
            | Self::Refused { by, .. }
            | Self::Block { by, .. }
            | Self::BadBlock { by, .. }
            | Self::NoBcc { by }
            | Self::BccNotAwaited { by }
            | Self::NoBlock { by, .. }
            | Self::Accepted { by, .. }
            | Self::Rejected { by, .. }
            | Self::RequestForAnswer { by, .. }
            | Self::Aborted { by }
            | Self::BrokenOff { by }
            | Self::Gap { by, .. } => Some(by),
        }
    }
}

impl fmt::Display for Observation<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Request { side, attempt } => write!(f, "{side} STX, attempt {attempt}"),
            Self::Conflict => f.write_str("initialization conflict: both sent STX"),
            Self::RequestUnanswered { side, delay } => {
                write!(f, "{side} did not answer STX, {}", Millis(delay))
            }
            Self::BothGaveWay => f.write_str("both answered DLE and neither sends"),
            Self::Connected { by, delay } => {
                write!(f, "{by} DLE, ready to receive, {}", Millis(delay))
            }
            Self::Refused { by, delay } => write!(f, "{by} NAK to STX, {}", Millis(delay)),
            Self::DidNotWait { side } => write!(f, "{side} sends data without waiting for DLE"),
            Self::Block { by, payload } => {
                write!(f, "{by} block of {}: {}", payload.len(), Hex(payload))
            }
            Self::BadBlock { by, error } => write!(f, "{by} bad block: {error}"),
            Self::NoBcc { by } => write!(f, "{by} block without BCC"),
            Self::BccNotAwaited { by } => write!(f, "{by} did not wait for the BCC"),
            Self::NoBlock { by, waited } => {
                write!(f, "{by} sends no block after DLE, {}", Millis(waited))
            }
            Self::RequestForAnswer { by, delay } => {
                write!(f, "{by} STX in place of the answer, {}", Millis(delay))
            }
            Self::BrokenOff { by } => write!(f, "{by} leaves its block unfinished"),
            Self::Accepted { by, delay } => write!(f, "{by} DLE, accepted, {}", Millis(delay)),
            Self::Rejected { by, delay } => write!(f, "{by} NAK, rejected, {}", Millis(delay)),
            Self::Aborted { by } => write!(f, "{by} NAK into the block"),
            Self::Reset { side } => write!(f, "{side} NAK without a question"),
            Self::NoAnswer { silent, waited } => {
                write!(f, "{silent} does not answer, waited {}", Millis(waited))
            }
            Self::Gap { by, gap } => {
                write!(f, "{by} pauses in the block, ZVZ exceeded: {}", Millis(gap))
            }
            Self::Stray { side, byte } => write!(f, "{side} stray {byte:02X}"),
            Self::Damaged { side, byte, error } => write!(f, "{side} {error} error in {byte:02X}"),
        }
    }
}

/// `2.000 ms`.
pub(crate) struct Millis(pub(crate) Duration);

impl fmt::Display for Millis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let micros = self.0.as_micros();
        write!(f, "{}.{:03} ms", micros / 1000, micros % 1000)
    }
}

/// An [`Observation`] whose payload is still in the buffer.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Mark {
    Block { by: Side, len: u32 },
    Other(Observation<'static>),
}

/// Most marks of one character.
const MARKS: usize = 6;

/// Marks of one character: the wait before it, its damage, the end of what was open, and at most
/// three steps.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Marks([Option<Mark>; MARKS]);

impl Marks {
    pub(crate) fn iter(&self) -> impl Iterator<Item = Mark> {
        self.0.into_iter().flatten()
    }

    pub(crate) fn push(&mut self, mark: Mark) {
        if let Some(free) = self.0.iter_mut().find(|slot| slot.is_none()) {
            *free = Some(mark);
        }
    }
}

/// What one character, or one timeout, means: an iterator over [`Observation`]s in their order.
#[derive(Clone, Debug)]
#[must_use = "a monitor does nothing but observe"]
pub struct Observations<'a> {
    marks: core::array::IntoIter<Option<Mark>, MARKS>,
    buffer: &'a [u8],
}

impl<'a> Observations<'a> {
    pub(crate) fn new(marks: Marks, buffer: &'a [u8]) -> Self {
        Self {
            marks: marks.0.into_iter(),
            buffer,
        }
    }
}

impl Observations<'_> {
    /// What the buffer holds: at most 65535 bytes.
    fn capacity(&self) -> u16 {
        u16::try_from(self.buffer.len()).map_or(u16::MAX, |len| len)
    }
}

impl<'a> Iterator for Observations<'a> {
    type Item = Observation<'a>;

    fn next(&mut self) -> Option<Observation<'a>> {
        Some(match self.marks.next()?? {
            Mark::Other(observation) => observation,
            Mark::Block { by, len } => {
                let payload = usize::try_from(len)
                    .ok()
                    .and_then(|len| self.buffer.get(..len));
                match payload {
                    Some(payload) => Observation::Block { by, payload },
                    None => Observation::BadBlock {
                        by,
                        error: FrameError::TooLong {
                            capacity: self.capacity(),
                        },
                    },
                }
            }
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.marks.as_slice().iter().flatten().count();
        (left, Some(left))
    }
}

impl FusedIterator for Observations<'_> {}
