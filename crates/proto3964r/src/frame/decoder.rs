//! From the characters behind the STX to a payload.

use thiserror::Error;

use super::{Check, scan::plain_run};
use crate::ascii::{DLE, ETX};

/// What happens when a single DLE stands in front of anything but DLE and ETX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum IllegalDle {
    /// Note the error and go on to the end of the block, then reject it. Siemens CP 440 manual.
    #[default]
    RejectAtEnd,
    /// Reject the block at once, as ``ProtoCore`` does.
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
        /// The character behind DLE ETX.
        received: u8,
    },
    /// A single DLE in front of something other than DLE and ETX.
    #[error("10h in front of {byte:02X}h after {offset} payload bytes")]
    IllegalDle {
        /// The character behind the DLE.
        byte: u8,
        /// Payload bytes in front of it.
        offset: u16,
    },
    /// The payload does not fit into the buffer.
    #[error("the block is longer than {capacity} bytes")]
    TooLong {
        /// Bytes that the buffer holds.
        capacity: u16,
    },
}

/// What the decoder waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum State {
    Data,
    AfterDle,
    Bcc,
}

/// What [`Decoder::feed`] did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
#[expect(
    clippy::exhaustive_structs,
    reason = "what was eaten and what came of it: nothing to add"
)]
pub struct Fed {
    /// Bytes taken from the input. Less than all of them only when a block ended.
    pub consumed: usize,
    /// The end of a block: length of its payload, or what is wrong with it.
    pub block: Option<Result<usize, FrameError>>,
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
/// assert_eq!(decoder.feed(&[0x10], &mut payload).block, None);
/// let fed = decoder.feed(&[0x10, 0x03, 0x10, 0x03, 0x10, 0x02], &mut payload);
/// assert_eq!((fed.consumed, fed.block), (5, Some(Ok(2))));
/// assert_eq!(payload[..2], [0x10, 0x03]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Decoder {
    progress: Progress,
    rules: Rules,
}

impl Decoder {
    /// A decoder in front of the first character of a body, strict about DLE.
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

    /// The same decoder with another rule for a DLE in front of an illegal character.
    #[must_use]
    pub const fn with_illegal_dle(mut self, rule: IllegalDle) -> Self {
        self.rules.illegal_dle = rule;
        self
    }

    /// Forgets the block that was begun.
    pub fn reset(&mut self) {
        self.progress = Progress::START;
    }

    /// Payload bytes of the block so far.
    #[must_use]
    pub fn len(&self) -> usize {
        usize::from(self.progress.len)
    }

    /// Whether no payload byte of the block has come yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.progress.len == 0
    }

    /// What is wrong with the block so far.
    #[must_use]
    pub fn fault(&self) -> Option<FrameError> {
        self.progress.fault
    }

    /// Takes one character; `Some` when it ended the block.
    ///
    /// The value is the length of the payload.
    ///
    /// # Errors
    /// The inner [`FrameError`] when the block is no good: the first error in it.
    #[inline]
    pub fn push(&mut self, byte: u8, buffer: &mut [u8]) -> Option<Result<usize, FrameError>> {
        self.progress.push(self.rules, byte, buffer)
    }

    /// Takes characters up to the end of the input or of the block, whichever comes first.
    #[inline]
    pub fn feed(&mut self, bytes: &[u8], buffer: &mut [u8]) -> Fed {
        self.progress.feed(self.rules, bytes, buffer)
    }
}

/// What a decoder is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Rules {
    pub(crate) check: Check,
    pub(crate) illegal_dle: IllegalDle,
}

/// How far a decoder has come. The rules are the same in every call.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Progress {
    fault: Option<FrameError>,
    len: u16,
    bcc: u8,
    state: State,
}

impl Progress {
    /// In front of the first character.
    pub(crate) const START: Self = Self {
        fault: None,
        len: 0,
        bcc: 0,
        state: State::Data,
    };

    pub(crate) fn is_faulty(&self) -> bool {
        self.fault.is_some()
    }

    /// Payload bytes in the buffer.
    #[cfg(test)]
    pub(crate) fn stored(&self) -> usize {
        usize::from(self.len)
    }

    /// Whether the next character may be data.
    #[inline]
    pub(crate) fn is_in_data(&self) -> bool {
        self.state == State::Data
    }

    /// Takes a data byte other than DLE; `false`, and nothing taken, when it does not fit. Only
    /// while [`is_in_data`](Self::is_in_data).
    #[inline]
    pub(crate) fn push_plain(&mut self, byte: u8, buffer: &mut [u8]) -> bool {
        match buffer.get_mut(usize::from(self.len)) {
            Some(slot) if self.len < u16::MAX => {
                *slot = byte;
                self.len = self.len.wrapping_add(1);
                self.bcc ^= byte;
                true
            }
            _ => false,
        }
    }

    /// Whether nothing but the BCC is missing.
    pub(crate) fn awaits_bcc(&self) -> bool {
        self.state == State::Bcc
    }

    /// Whether the block consists of a single DLE so far.
    pub(crate) fn is_lone_dle(&self) -> bool {
        self.state == State::AfterDle && self.len == 0 && self.bcc == DLE && !self.is_faulty()
    }

    #[inline]
    pub(crate) fn push(
        &mut self,
        rules: Rules,
        byte: u8,
        buffer: &mut [u8],
    ) -> Option<Result<usize, FrameError>> {
        if self.state == State::Data {
            self.bcc ^= byte;
            if byte == DLE {
                self.state = State::AfterDle;
            } else {
                self.store(byte, buffer);
            }
            return None;
        }
        self.push_control(rules, byte, buffer)
    }

    #[inline]
    pub(crate) fn feed(&mut self, rules: Rules, bytes: &[u8], buffer: &mut [u8]) -> Fed {
        let mut rest = bytes;
        while let Some((&byte, behind)) = rest.split_first() {
            if self.state == State::Data && byte != DLE {
                rest = self.take_run(rest, buffer);
            } else {
                rest = behind;
                let block = self.push(rules, byte, buffer);
                if block.is_some() {
                    return Fed {
                        consumed: bytes.len() - rest.len(),
                        block,
                    };
                }
            }
        }
        Fed {
            consumed: bytes.len(),
            block: None,
        }
    }

    /// Copies the run in front of the next DLE and returns what is behind it.
    #[inline]
    fn take_run<'b>(&mut self, bytes: &'b [u8], buffer: &mut [u8]) -> &'b [u8] {
        let (len, xor) = plain_run(bytes);
        let Some((run, rest)) = bytes.split_at_checked(len) else {
            return &[];
        };
        self.bcc ^= xor;
        let free = buffer.get_mut(usize::from(self.len)..).unwrap_or_default();
        let fits = run
            .len()
            .min(free.len())
            .min(usize::from(u16::MAX - self.len));
        if let (Some(to), Some(from), Ok(step)) =
            (free.get_mut(..fits), run.get(..fits), u16::try_from(fits))
        {
            to.copy_from_slice(from);
            self.len = self.len.wrapping_add(step);
        }
        if fits < run.len() {
            self.too_long();
        }
        rest
    }

    fn push_control(
        &mut self,
        rules: Rules,
        byte: u8,
        buffer: &mut [u8],
    ) -> Option<Result<usize, FrameError>> {
        if self.state == State::Bcc {
            if byte != self.bcc {
                self.note(FrameError::Bcc {
                    computed: self.bcc,
                    received: byte,
                });
            }
            return Some(self.end());
        }
        self.bcc ^= byte;
        self.state = State::Data;
        match byte {
            DLE => self.store(DLE, buffer),
            ETX if rules.check == Check::None => return Some(self.end()),
            ETX => self.state = State::Bcc,
            _ if rules.illegal_dle == IllegalDle::Accept => self.store(byte, buffer),
            _ => {
                self.note(FrameError::IllegalDle {
                    byte,
                    offset: self.len,
                });
                if rules.illegal_dle == IllegalDle::RejectAtOnce {
                    return Some(self.end());
                }
            }
        }
        None
    }

    #[inline]
    fn store(&mut self, byte: u8, buffer: &mut [u8]) {
        match buffer.get_mut(usize::from(self.len)) {
            Some(slot) if self.len < u16::MAX => {
                *slot = byte;
                self.len = self.len.wrapping_add(1);
            }
            _ => self.too_long(),
        }
    }

    /// The buffer is full: what it holds is its capacity.
    #[cold]
    fn too_long(&mut self) {
        self.note(FrameError::TooLong { capacity: self.len });
    }

    fn note(&mut self, error: FrameError) {
        self.fault.get_or_insert(error);
    }

    fn end(&mut self) -> Result<usize, FrameError> {
        let result = match self.fault {
            None => Ok(usize::from(self.len)),
            Some(error) => Err(error),
        };
        *self = Self::START;
        result
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
    /// The bytes stop in front of the end of the block.
    #[error("no end of the block within {len} bytes")]
    Incomplete {
        /// Bytes that were looked at.
        len: usize,
    },
}

/// Reads one whole body into `buffer`; returns the payload and what stands behind the body.
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
    let fed = Decoder::new(check).feed(body, buffer);
    let incomplete = DecodeError::Incomplete { len: body.len() };
    let len = fed.block.ok_or(incomplete)??;
    Ok((
        buffer.get(..len).ok_or(incomplete)?,
        body.get(fed.consumed..).ok_or(incomplete)?,
    ))
}
