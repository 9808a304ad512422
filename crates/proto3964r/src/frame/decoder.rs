//! From the characters after the STX to a payload.

use core::mem;

use thiserror::Error;

use super::Check;
use crate::ascii::{DLE, ETX};

/// What happens when a single DLE stands before anything but DLE and ETX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum IllegalDle {
    /// Note the error and go on to the end of the block, then reject it. Siemens CP 440 manual.
    #[default]
    RejectAtEnd,
    /// Reject the block at once, as `ProtoCore` does. What is left of it may then read as STX and a
    /// block of its own, which passes the BCC once in 256.
    RejectAtOnce,
    /// Drop the DLE and keep the character, as the former Linux line discipline did.
    Accept,
}

/// Why a block that came to its end is no good.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FrameError {
    /// The block check character differs.
    #[error("BCC {received:02X}h received, {computed:02X}h computed")]
    Bcc {
        /// The XOR of what was received.
        computed: u8,
        /// The character after DLE ETX.
        received: u8,
    },
    /// A single DLE before something other than DLE and ETX.
    #[error("10h before {byte:02X}h after {offset} payload bytes")]
    IllegalDle {
        /// The character after the DLE.
        byte: u8,
        /// Payload bytes before it.
        offset: u16,
    },
    /// The payload does not fit into the buffer.
    #[error("the block is longer than {capacity} bytes")]
    TooLong {
        /// Bytes that the buffer holds.
        capacity: u16,
    },
}

/// Reads bodies, in pieces of any size, into a buffer that the caller passes with each call.
///
/// Pass the same buffer until the block has ended. The decoder then starts over by itself: the
/// next byte is the first one of the next body. What does not fit is swallowed up to the end of
/// the block and reported there; blocks hold at most 65535 bytes.
///
/// # Examples
/// ```
/// use proto3964r::frame::{Check, Decoder};
///
/// let mut decoder = Decoder::new(Check::Bcc);
/// let mut payload = [0; 16];
/// assert_eq!(decoder.feed(&[0x10], &mut payload), (1, None));
/// let (taken, end) = decoder.feed(&[0x10, 0x03, 0x10, 0x03, 0x10, 0x02], &mut payload);
/// assert_eq!((taken, end), (5, Some(Ok(2))));
/// assert_eq!(payload[..2], [0x10, 0x03]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[expect(
    missing_copy_implementations,
    reason = "a copy would be a second reader of one line"
)]
pub struct Decoder {
    progress: Progress,
    rules: Rules,
}

impl Decoder {
    /// A decoder before the first character of a body, strict about DLE.
    #[must_use]
    pub const fn new(check: Check) -> Self {
        Self {
            progress: Progress::START,
            rules: Rules {
                check,
                illegal_dle: IllegalDle::RejectAtEnd,
            },
        }
    }

    /// The same decoder with another rule for a DLE before an illegal character.
    #[must_use]
    pub const fn with_illegal_dle(mut self, rule: IllegalDle) -> Self {
        self.rules.illegal_dle = rule;
        self
    }

    /// Takes one character; `Some` when it ended the block.
    ///
    /// The value is the length of the payload.
    ///
    /// # Errors
    /// The inner [`FrameError`] when the block is no good: the first error in it.
    pub fn push(&mut self, byte: u8, buffer: &mut [u8]) -> Option<Result<usize, FrameError>> {
        let end = self.progress.push(self.rules, byte, bounded(buffer))?;
        Some(end.map(usize::from))
    }

    /// Takes characters up to the end of the input or of the block, whichever comes first; returns
    /// how many, and what [`push`](Self::push) says of the last one.
    #[must_use = "what follows the end of a block is not taken"]
    pub fn feed(
        &mut self,
        bytes: &[u8],
        buffer: &mut [u8],
    ) -> (usize, Option<Result<usize, FrameError>>) {
        let (taken, end) = self.progress.feed(self.rules, bytes, bounded(buffer));
        (taken, end.map(|end| end.map(usize::from)))
    }

    /// Payload bytes in the buffer. They are the caller's now: the next ones are written from the
    /// front again, so that a block of any length can be read in pieces.
    ///
    /// Lengths and offsets then count from here.
    pub const fn take_payload(&mut self) -> usize {
        mem::replace(&mut self.progress.len, 0) as usize
    }

    /// The XOR of the characters of the block so far; before its BCC, what that has to be.
    #[must_use]
    pub const fn bcc(&self) -> u8 {
        self.progress.bcc
    }

    /// Whether nothing but the BCC of the block is missing.
    #[must_use]
    pub const fn awaits_bcc(&self) -> bool {
        matches!(self.progress.next, Next::Bcc)
    }

    /// The first error of the block so far.
    #[must_use]
    pub const fn fault(&self) -> Option<FrameError> {
        self.progress.fault()
    }
}

/// As much of a buffer as a block can fill.
fn bounded(buffer: &mut [u8]) -> &mut [u8] {
    let len = buffer.len().min(usize::from(u16::MAX));
    buffer.split_at_mut(len).0
}

/// What a decoder is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Rules {
    pub(crate) check: Check,
    pub(crate) illegal_dle: IllegalDle,
}

/// What the next character is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Next {
    Data,
    /// The character after a DLE.
    AfterDle,
    Bcc,
}

/// How far a decoder has come. Rules and buffer, of at most 65535 bytes, are the same in every
/// call.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Progress {
    fault: Option<FrameError>,
    len: u16,
    bcc: u8,
    next: Next,
}

impl Progress {
    /// Before the first character.
    pub(crate) const START: Self = Self {
        fault: None,
        len: 0,
        bcc: 0,
        next: Next::Data,
    };

    /// The first fault so far.
    pub(crate) const fn fault(&self) -> Option<FrameError> {
        self.fault
    }

    /// Payload bytes in the buffer.
    #[cfg(test)]
    pub(crate) fn stored(&self) -> usize {
        usize::from(self.len)
    }

    /// Whether the block consists of a single DLE so far.
    pub(crate) fn is_lone_dle(&self) -> bool {
        self.next == Next::AfterDle && self.len == 0 && self.bcc == DLE && self.fault.is_none()
    }

    /// Takes one character; `Some` when it ended the block.
    #[inline]
    pub(crate) fn push(
        &mut self,
        rules: Rules,
        byte: u8,
        buffer: &mut [u8],
    ) -> Option<Result<u16, FrameError>> {
        if self.push_data(byte, buffer) {
            None
        } else {
            self.control(rules, byte, buffer)
        }
    }

    /// Takes a data byte, or half of a doubled DLE; `false`, and nothing taken, for what is no data
    /// or the first that does not fit.
    #[inline]
    pub(crate) fn push_data(&mut self, byte: u8, buffer: &mut [u8]) -> bool {
        match (self.next, byte) {
            (Next::Data, DLE) => self.next = Next::AfterDle,
            (Next::Data, _) | (Next::AfterDle, DLE) => {
                match buffer.get_mut(usize::from(self.len)) {
                    Some(slot) => {
                        *slot = byte;
                        self.len += 1;
                    }
                    None if self.fault.is_none() => return false,
                    None => {}
                }
                self.next = Next::Data;
            }
            _ => return false,
        }
        self.bcc ^= byte;
        true
    }

    #[inline]
    pub(crate) fn feed(
        &mut self,
        rules: Rules,
        bytes: &[u8],
        buffer: &mut [u8],
    ) -> (usize, Option<Result<u16, FrameError>>) {
        let mut rest = bytes;
        loop {
            let taken = self.take_data(rest, buffer);
            let Some((&byte, after)) = rest.get(taken..).and_then(<[u8]>::split_first) else {
                return (bytes.len(), None);
            };
            rest = after;
            let end = self.push(rules, byte, buffer);
            if end.is_some() {
                return (bytes.len() - rest.len(), end);
            }
        }
    }

    /// [`push_data`](Self::push_data) for many, up to what is no data; returns how many. Data that
    /// do not fit are taken too.
    #[inline]
    fn take_data(&mut self, bytes: &[u8], buffer: &mut [u8]) -> usize {
        if self.next != Next::Data {
            return 0;
        }
        // None is free in a full buffer.
        let free = buffer.get_mut(usize::from(self.len)..).unwrap_or_default();
        let mut slots = free.iter_mut();
        let (mut len, mut bcc, mut is_too_long) = (self.len, self.bcc, false);
        let mut rest = bytes.iter();
        while let Some(&byte) = rest.next() {
            bcc ^= byte;
            if byte == DLE {
                if rest.as_slice().first() != Some(&DLE) {
                    self.next = Next::AfterDle;
                    break;
                }
                rest.next();
                bcc ^= DLE;
            }
            match slots.next() {
                Some(slot) => {
                    *slot = byte;
                    len += 1;
                }
                None => is_too_long = true,
            }
        }
        (self.len, self.bcc) = (len, bcc);
        if is_too_long {
            // The buffer is full: what it holds is its capacity.
            self.note(FrameError::TooLong { capacity: len });
        }
        bytes.len() - rest.len()
    }

    /// Takes what is no data: the end of the block, or an error.
    #[cold]
    fn control(
        &mut self,
        rules: Rules,
        byte: u8,
        buffer: &mut [u8],
    ) -> Option<Result<u16, FrameError>> {
        let (len, computed) = (self.len, self.bcc);
        self.bcc ^= byte;
        match (mem::replace(&mut self.next, Next::Data), byte) {
            (Next::Bcc, received) => {
                if received != computed {
                    self.note(FrameError::Bcc { computed, received });
                }
                return Some(self.end());
            }
            // The buffer is full: what it holds is its capacity.
            (Next::Data, _) | (_, DLE) => self.note(FrameError::TooLong { capacity: len }),
            (_, ETX) if rules.check == Check::None => return Some(self.end()),
            (_, ETX) => self.next = Next::Bcc,
            _ if rules.illegal_dle == IllegalDle::Accept => {
                self.bcc ^= byte;
                return self.push(rules, byte, buffer);
            }
            _ => {
                self.note(FrameError::IllegalDle { byte, offset: len });
                if rules.illegal_dle == IllegalDle::RejectAtOnce {
                    return Some(self.end());
                }
            }
        }
        None
    }

    fn note(&mut self, error: FrameError) {
        self.fault.get_or_insert(error);
    }

    fn end(&mut self) -> Result<u16, FrameError> {
        let Self { fault, len, .. } = mem::replace(self, Self::START);
        match fault {
            None => Ok(len),
            Some(error) => Err(error),
        }
    }
}

/// Why [`decode`] gave no payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DecodeError {
    /// The block came to its end and is no good.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The bytes stop before the end of the block.
    #[error("no end of the block within {len} bytes")]
    Incomplete {
        /// Bytes that were looked at.
        len: usize,
    },
}

/// Reads one whole body into `buffer`; returns the payload and what stands after the body.
///
/// # Errors
/// [`DecodeError::Frame`] for a block that is no good, [`DecodeError::Incomplete`] for one
/// without an end.
///
/// # Examples
/// ```
/// use proto3964r::frame::{Check, decode};
///
/// let mut buffer = [0; 8];
/// let (payload, rest) = decode(&[0x41, 0x10, 0x03, 0x52], Check::Bcc, &mut buffer)?;
/// assert_eq!((payload, rest), (&b"A"[..], &[][..]));
/// # Ok::<(), proto3964r::frame::DecodeError>(())
/// ```
pub fn decode<'i, 'b>(
    body: &'i [u8],
    check: Check,
    buffer: &'b mut [u8],
) -> Result<(&'b [u8], &'i [u8]), DecodeError> {
    let (taken, end) = Decoder::new(check).feed(body, buffer);
    let incomplete = DecodeError::Incomplete { len: body.len() };
    let len = end.ok_or(incomplete)??;
    Ok((
        buffer.get(..len).ok_or(incomplete)?,
        body.get(taken..).ok_or(incomplete)?,
    ))
}
