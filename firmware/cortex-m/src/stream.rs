//! A stream of segments that always has an end: what a PC sends while the board plays.
//!
//! Each batch goes on from the one before and has a tail with it: the steps that bring the machine
//! to rest on its path from there. The next batch takes the tail's place if it comes in time; else
//! the tail is played. So a line that breaks at any moment leaves the machine at rest, on the path,
//! with every step counted, and the PC goes on from there.

use proto3964r::{Config, Line, Priority};
use pvt_steps::{Segment, SegmentError};
use stepper_sync::Direction;

/// Batches that the board holds: the one that is played, and those that wait.
pub const WINDOW: usize = 3;
/// The most segments of a joint in a part of a batch.
pub const MAX_SEGMENTS: usize = 64;
/// The most bytes of a batch.
pub const MAX_BATCH: usize = 8192;
/// Bytes of what the board says.
pub const REPORT: usize = 11;

/// The line between both ends, which can wait long, as nothing is lost on it: each has a clock of
/// its own, and a simulated board's runs ahead of the PC's or behind it, as processors are free.
#[must_use]
pub const fn line(priority: Priority) -> Config {
    Config {
        qvz_ms: 60_000,
        zvz_ms: 60_000,
        ..Config::siemens_3964r(priority, Line::Instant)
    }
}

/// What each joint does.
pub type Joints<T> = [T; 2];

/// Before the segments of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Head {
    /// Counts from 0, without a gap.
    pub number: u16,
    /// Whether it starts from rest: at the beginning, or after the tail of the batch before.
    pub from_rest: bool,
    /// Whether it ends at rest: it has no tail.
    pub is_last: bool,
    /// When it begins and ends, in ticks of the plan.
    pub ticks: [u64; 2],
}

/// What the board says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    pub event: Event,
    /// The batch.
    pub number: u16,
    /// Steps of each joint since the start, when it is said.
    pub steps: Joints<i32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The batch is over and the next one runs: there is room for one more.
    Played,
    /// The batch and its tail are over, and the machine rests. Batches after it are dropped.
    Rests,
}

impl Head {
    const LEN: usize = 19;

    fn bytes(self) -> [u8; Self::LEN] {
        let mut bytes = [0; Self::LEN];
        bytes[..2].copy_from_slice(&self.number.to_le_bytes());
        bytes[2] = u8::from(self.from_rest) | u8::from(self.is_last) << 1;
        bytes[3..11].copy_from_slice(&self.ticks[0].to_le_bytes());
        bytes[11..].copy_from_slice(&self.ticks[1].to_le_bytes());
        bytes
    }

    fn of(bytes: &[u8; Self::LEN]) -> Self {
        let u64_at = |at: usize| u64::from_le_bytes(core::array::from_fn(|i| bytes[at + i]));
        Self {
            number: u16::from_le_bytes([bytes[0], bytes[1]]),
            from_rest: bytes[2] & 1 != 0,
            is_last: bytes[2] & 2 != 0,
            ticks: [u64_at(3), u64_at(11)],
        }
    }
}

impl Report {
    #[must_use]
    pub fn bytes(self) -> [u8; REPORT] {
        let mut bytes = [0; REPORT];
        bytes[0] = match self.event {
            Event::Played => b'p',
            Event::Rests => b'r',
        };
        bytes[1..3].copy_from_slice(&self.number.to_le_bytes());
        bytes[3..7].copy_from_slice(&self.steps[0].to_le_bytes());
        bytes[7..].copy_from_slice(&self.steps[1].to_le_bytes());
        bytes
    }

    /// The report of a telegram, none if it is no report.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let bytes: &[u8; REPORT] = bytes.try_into().ok()?;
        let i32_at = |at: usize| i32::from_le_bytes(core::array::from_fn(|i| bytes[at + i]));
        Some(Self {
            event: match bytes[0] {
                b'p' => Event::Played,
                b'r' => Event::Rests,
                _ => return None,
            },
            number: u16::from_le_bytes([bytes[1], bytes[2]]),
            steps: [i32_at(3), i32_at(7)],
        })
    }
}

/// Why a telegram is no batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BatchError {
    /// It ends too early.
    Truncated,
    /// A part of it has too many segments.
    TooMany,
    Segment(SegmentError),
}

/// A batch as bytes: the segments of both joints, then those of their tails.
///
/// ```text
/// number u16 | flags u8 | begin u64 | end u64 | 4 lengths u16 | shoulder | elbow | their tails
/// ```
pub fn encode<'b>(head: Head, parts: &[&[u8]; 4], buffer: &'b mut [u8]) -> &'b [u8] {
    let mut len = 0;
    let mut put = |bytes: &[u8]| {
        buffer[len..len + bytes.len()].copy_from_slice(bytes);
        len += bytes.len();
    };
    put(&head.bytes());
    for part in parts {
        put(&(part.len() as u16).to_le_bytes());
    }
    parts.iter().for_each(|part| put(part));
    &buffer[..len]
}

/// The segments of one joint in one part.
#[derive(Clone, Copy, Debug)]
pub struct Part([Option<Segment>; MAX_SEGMENTS]);

impl Part {
    fn decode(mut wire: &[u8]) -> Result<Self, BatchError> {
        let mut segments = [None; MAX_SEGMENTS];
        for place in &mut segments {
            if wire.is_empty() {
                return Ok(Self(segments));
            }
            let (segment, rest) = Segment::decode(wire).map_err(BatchError::Segment)?;
            (*place, wire) = (Some(segment), rest);
        }
        if wire.is_empty() {
            Ok(Self(segments))
        } else {
            Err(BatchError::TooMany)
        }
    }

    #[inline]
    pub fn get(&self, index: usize) -> Option<&Segment> {
        self.0.get(index)?.as_ref()
    }

    /// Ticks since the joint's last step before, and direction of each step.
    pub fn steps(&self) -> impl Iterator<Item = (u64, Direction)> {
        self.0.iter().map_while(Option::as_ref).flat_map(|segment| {
            let mut player = pvt_steps::SegmentPlayer::new();
            let first = player.load(segment);
            let next = core::iter::from_fn(move || player.next()).map(u64::from);
            let direction = segment.direction();
            core::iter::once(first)
                .chain(next)
                .map(move |ticks| (ticks, direction))
        })
    }
}

/// A batch, decoded.
#[derive(Clone, Debug)]
pub struct Batch {
    pub head: Head,
    pub steps: Joints<Part>,
    pub tail: Joints<Part>,
}

impl Batch {
    /// # Errors
    /// [`BatchError`].
    pub fn decode(bytes: &[u8]) -> Result<Self, BatchError> {
        let (head, rest) = bytes.split_first_chunk().ok_or(BatchError::Truncated)?;
        let (lens, mut rest) = rest.split_first_chunk::<8>().ok_or(BatchError::Truncated)?;
        let mut part = |index: usize| {
            let len = u16::from_le_bytes([lens[2 * index], lens[2 * index + 1]]);
            let (own, later) = rest
                .split_at_checked(len.into())
                .ok_or(BatchError::Truncated)?;
            rest = later;
            Part::decode(own)
        };
        Ok(Self {
            head: Head::of(head),
            steps: [part(0)?, part(1)?],
            tail: [part(2)?, part(3)?],
        })
    }
}
