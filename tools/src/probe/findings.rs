//! What was found, and what was not.

use core::{fmt, time::Duration};

use proto3964r::{Priority, frame::Check};

use crate::Parity;

/// What was found of a partner; `None` where it cannot be told.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Findings {
    /// Rate in bit/s, and parity.
    pub frame: Option<(u32, ParityFound)>,
    /// From STX to DLE.
    pub answer: Option<Span>,
    /// Times that it answered NAK to STX: it has no receive buffer.
    pub refused: u32,
    /// The silence after which it answers NAK (ZVZ).
    pub zvz: Option<Span>,
    /// The partner's.
    pub priority: Option<Priority>,
    /// From one unanswered STX of its own to the next (QVZ).
    pub qvz: Option<Span>,
    /// Whether its blocks have a BCC.
    pub check: Option<Check>,
    /// Bytes of the longest block of its own that was heard.
    pub longest: Option<usize>,
}

/// What can be told of a parity bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(
    clippy::exhaustive_enums,
    reason = "what a frame can have, and a doubt"
)]
pub enum ParityFound {
    /// Even, or none: the characters that were heard are made so by both.
    EvenOrNone,
    /// Even.
    Even,
    /// Odd.
    Odd,
    /// None.
    None,
}

impl From<Parity> for ParityFound {
    fn from(parity: Parity) -> Self {
        match parity {
            Parity::None => Self::None,
            Parity::Even => Self::Even,
            Parity::Odd => Self::Odd,
        }
    }
}

impl fmt::Display for ParityFound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::EvenOrNone => "even or none",
            Self::Even => "even",
            Self::Odd => "odd",
            Self::None => "none",
        })
    }
}

/// The shortest and the longest of some times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::exhaustive_structs, reason = "two times")]
pub struct Span {
    /// The shortest.
    pub from: Duration,
    /// The longest.
    pub to: Duration,
}

impl Span {
    pub(super) fn widen(span: &mut Option<Self>, time: Duration) {
        let known = span.get_or_insert(Self {
            from: time,
            to: time,
        });
        known.from = known.from.min(time);
        known.to = known.to.max(time);
    }
}

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ms = |time: Duration| time.as_secs_f64() * 1000.0;
        write!(f, "{:.1} to {:.1} ms", ms(self.from), ms(self.to))
    }
}
