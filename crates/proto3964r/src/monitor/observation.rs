//! What a monitor sees.

use core::{fmt, iter::FusedIterator, time::Duration};

use crate::{event::LineError, frame::FrameError};

/// One of the two stations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the line is point to point")]
pub enum Side {
    /// The first one.
    A,
    /// The second one.
    B,
}

impl Side {
    /// The other one.
    pub(super) const fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }

    pub(super) const fn index(self) -> usize {
        match self {
            Self::A => 0,
            Self::B => 1,
        }
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "A",
            Self::B => "B",
        })
    }
}

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
    /// The answer came where the BCC was expected: the sender speaks 3964 without BCC.
    NoBcc {
        /// The sender.
        by: Side,
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
    /// NAK into a block.
    Aborted {
        /// The receiver.
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
        error: LineError,
    },
}

impl fmt::Display for Observation<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Request { side, attempt } => write!(f, "{side} STX, attempt {attempt}"),
            Self::Conflict => f.write_str("initialization conflict: both sent STX"),
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
            Self::Accepted { by, delay } => write!(f, "{by} DLE, accepted, {}", Millis(delay)),
            Self::Rejected { by, delay } => write!(f, "{by} NAK, rejected, {}", Millis(delay)),
            Self::Aborted { by } => write!(f, "{by} NAK into the block"),
            Self::Reset { side } => write!(f, "{side} NAK without a question"),
            Self::NoAnswer { silent, waited } => write!(
                f,
                "{silent} does not answer, QVZ exceeded: {}",
                Millis(waited)
            ),
            Self::Gap { by, gap } => {
                write!(f, "{by} pauses in the block, ZVZ exceeded: {}", Millis(gap))
            }
            Self::Stray { side, byte } => write!(f, "{side} stray {byte:02X}"),
            Self::Damaged { side, byte, error } => write!(f, "{side} {error} error in {byte:02X}"),
        }
    }
}

/// `2.000 ms`.
struct Millis(Duration);

impl fmt::Display for Millis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let micros = self.0.as_micros();
        write!(f, "{}.{:03} ms", micros / 1000, micros % 1000)
    }
}

/// `41 42`.
struct Hex<'a>(&'a [u8]);

impl fmt::Display for Hex<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, byte) in self.0.iter().enumerate() {
            let space = if at == 0 { "" } else { " " };
            write!(f, "{space}{byte:02X}")?;
        }
        Ok(())
    }
}

/// An [`Observation`] whose payload is still in the buffer.
#[derive(Clone, Copy, Debug)]
pub(super) enum Mark {
    Block { by: Side, len: usize },
    Other(Observation<'static>),
}

/// Marks of one character: the wait before it, its damage, and at most three steps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Marks([Option<Mark>; 5]);

impl Marks {
    pub(super) fn push(&mut self, mark: Mark) {
        if let Some(free) = self.0.iter_mut().find(|slot| slot.is_none()) {
            *free = Some(mark);
        }
    }
}

/// What one character, or one timeout, means: an iterator over [`Observation`]s in their order.
#[derive(Clone, Debug)]
#[must_use = "a monitor does nothing but observe"]
pub struct Observations<'a> {
    marks: core::array::IntoIter<Option<Mark>, 5>,
    buffer: &'a [u8],
}

impl<'a> Observations<'a> {
    pub(super) fn new(marks: Marks, buffer: &'a [u8]) -> Self {
        Self {
            marks: marks.0.into_iter(),
            buffer,
        }
    }
}

impl<'a> Iterator for Observations<'a> {
    type Item = Observation<'a>;

    fn next(&mut self) -> Option<Observation<'a>> {
        Some(match self.marks.next()?? {
            Mark::Other(observation) => observation,
            Mark::Block { by, len } => Observation::Block {
                by,
                payload: self.buffer.get(..len).unwrap_or_default(),
            },
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.marks.as_slice().iter().flatten().count();
        (left, Some(left))
    }
}

impl FusedIterator for Observations<'_> {}
