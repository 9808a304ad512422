//! Bytes to records, from a slice or from chunks of any size.

use core::iter::FusedIterator;
use thiserror::Error;

use super::record::{AXIS_BITS, COUNT_BITS, NEGATIVE};
use super::{Axis, ByteOrder, Fast, Format, Record, Slow, Strictness};

impl Format {
    /// The record of three bytes.
    ///
    /// # Errors
    /// [`DecodeError`] with an offset of 0..=2: 31 pulses of elbow or shoulder in a SLOW record; D6
    /// or D5 set in a SLOW byte in [`Strictness::Strict`].
    #[inline]
    pub fn decode(&self, bytes: [u8; Record::LEN]) -> Result<Record, DecodeError> {
        let [first, second, third] = bytes;
        if first & COUNT_BITS == COUNT_BITS {
            let axis = self.axis_codes.axis(first >> 5);
            let count = match self.byte_order {
                ByteOrder::BigEndian => u16::from_be_bytes([second, third]),
                ByteOrder::LittleEndian => u16::from_le_bytes([second, third]),
            };
            let fast = Fast::from_count(axis, first & NEGATIVE != 0, count);
            return Ok(Record::Fast(fast));
        }
        let axis_bits = (first | second | third) & AXIS_BITS != 0;
        let count = second & COUNT_BITS == COUNT_BITS || third & COUNT_BITS == COUNT_BITS;
        if (axis_bits || count)
            && let Some(error) = slow_error(self.strictness, bytes)
        {
            return Err(error);
        }
        Ok(Record::Slow(Slow::from_bytes(bytes)))
    }

    /// The canonical spelling of three bytes: `encode(decode(bytes))`. It differs where a zero
    /// count has a direction bit and, in [`Strictness::Lenient`], where a SLOW byte has D6 or D5
    /// set.
    ///
    /// # Errors
    /// As [`Format::decode`].
    pub fn canonical(&self, bytes: [u8; Record::LEN]) -> Result<[u8; Record::LEN], DecodeError> {
        Ok(self.decode(bytes)?.encode(self))
    }

    /// The records of a slice, each with its offset.
    pub const fn records<'a>(&self, bytes: &'a [u8]) -> Records<'a> {
        Records {
            format: *self,
            rest: bytes,
            offset: 0,
        }
    }

    #[inline]
    fn decode_at(&self, offset: u64, bytes: [u8; Record::LEN]) -> Result<Located, DecodeError> {
        match self.decode(bytes) {
            Ok(record) => Ok(Located {
                offset,
                bytes,
                record,
            }),
            Err(error) => Err(error.after(offset)),
        }
    }
}

/// The first error of a SLOW record.
#[cold]
fn slow_error(
    strictness: Strictness,
    [disc, elbow, shoulder]: [u8; Record::LEN],
) -> Option<DecodeError> {
    [
        (0, Axis::Disc, disc),
        (1, Axis::Elbow, elbow),
        (2, Axis::Shoulder, shoulder),
    ]
    .into_iter()
    .find_map(|(offset, axis, byte)| {
        let kind = if byte & COUNT_BITS == COUNT_BITS {
            DecodeErrorKind::SlowCount { axis, byte }
        } else if strictness == Strictness::Strict && byte & AXIS_BITS != 0 {
            DecodeErrorKind::SlowAxisBits { axis, byte }
        } else {
            return None;
        };
        Some(DecodeError { offset, kind })
    })
}

/// A record, its bytes as they were, and their offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Located {
    /// Offset of the first byte.
    pub offset: u64,
    /// The bytes as they were, in whatever spelling.
    pub bytes: [u8; Record::LEN],
    /// What they mean.
    pub record: Record,
}

impl Located {
    /// Whether the bytes are the ones that [`Record::encode`] writes.
    #[must_use]
    pub fn is_canonical(&self, format: &Format) -> bool {
        self.record.encode(format) == self.bytes
    }
}

/// Decoding iterator over a slice, made by [`Format::records`]. It copies nothing but the three
/// bytes of the record that is being read.
///
/// In [`Strictness::Strict`] the iterator ends after the first error, in [`Strictness::Lenient`] it
/// goes on three bytes later. One or two bytes too many at the end are an error in both.
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Records<'a> {
    format: Format,
    rest: &'a [u8],
    offset: u64,
}

impl Iterator for Records<'_> {
    type Item = Result<Located, DecodeError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let offset = self.offset;
        let Some((bytes, rest)) = self.rest.split_first_chunk() else {
            let held = Held::of(self.rest);
            self.rest = &[];
            return held.truncation(offset).map(Err);
        };
        self.rest = rest;
        self.offset = after(offset);
        let item = self.format.decode_at(offset, *bytes);
        if item.is_err() && self.format.strictness == Strictness::Strict {
            self.rest = &[];
        }
        Some(item)
    }

    /// Exact in [`Strictness::Lenient`]; in [`Strictness::Strict`] an error may end the records
    /// early.
    fn size_hint(&self) -> (usize, Option<usize>) {
        let max = self.rest.chunks(Record::LEN).len();
        let min = match self.format.strictness {
            Strictness::Strict => max.min(1),
            Strictness::Lenient => max,
        };
        (min, Some(max))
    }
}

impl FusedIterator for Records<'_> {}

/// Decoder of a byte stream that arrives in chunks of any size. It keeps at most two bytes.
///
/// ```
/// use pattern_codec::engraving::{Decoder, Format};
///
/// let mut decoder = Decoder::new(Format::default());
/// let mut records = 0;
/// for mut chunk in [&[0x1F, 0x01][..], &[0x00, 0x00, 0x8A], &[0x1E]] {
///     while let Some(located) = decoder.decode(&mut chunk) {
///         let _record = located?.record;
///         records += 1;
///     }
/// }
/// assert_eq!(decoder.finish()?, 6);
/// assert_eq!(records, 2);
/// # Ok::<(), pattern_codec::engraving::DecodeError>(())
/// ```
#[derive(Debug, Clone)]
#[expect(
    missing_copy_implementations,
    reason = "a copy that decodes on its own would be a mistake"
)]
pub struct Decoder {
    format: Format,
    /// Offset of the record that is being read.
    offset: u64,
    held: Held,
    failed: Option<DecodeError>,
}

impl Decoder {
    /// A decoder at offset 0.
    #[must_use]
    pub const fn new(format: Format) -> Self {
        Self {
            format,
            offset: 0,
            held: Held::None,
            failed: None,
        }
    }

    /// Takes bytes off the front of `input` up to the end of the next record and decodes it.
    ///
    /// `None` when `input` is used up: go on with the next chunk, or call [`Decoder::finish`].
    /// After an error in [`Strictness::Strict`] it is `None` for ever and `input` stays as it is.
    #[inline]
    pub fn decode(&mut self, input: &mut &[u8]) -> Option<Result<Located, DecodeError>> {
        if self.failed.is_some() {
            return None;
        }
        let bytes = self.held.complete(input)?;
        let item = self.format.decode_at(self.offset, bytes);
        self.offset = after(self.offset);
        if self.format.strictness == Strictness::Strict {
            self.failed = item.err();
        }
        Some(item)
    }

    /// Ends the stream: the number of bytes decoded.
    ///
    /// # Errors
    /// [`DecodeErrorKind::Truncated`] when the last record is incomplete; in [`Strictness::Strict`]
    /// the error that ended decoding, so that it cannot be lost.
    pub const fn finish(self) -> Result<u64, DecodeError> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        match self.held.truncation(self.offset) {
            Some(error) => Err(error),
            None => Ok(self.offset),
        }
    }
}

/// The first bytes of an incomplete record.
#[derive(Debug, Clone, Copy)]
enum Held {
    None,
    One(u8),
    Two(u8, u8),
}

impl Held {
    /// What the end of a slice leaves over; of more than two bytes only the first two.
    const fn of(bytes: &[u8]) -> Self {
        match *bytes {
            [] => Self::None,
            [first] => Self::One(first),
            [first, second, ..] => Self::Two(first, second),
        }
    }

    /// The next record, if `input` completes it.
    #[inline]
    fn complete(&mut self, input: &mut &[u8]) -> Option<[u8; Record::LEN]> {
        let (record, rest) = match (*self, *input) {
            (Self::None, &[first, second, third, ref rest @ ..])
            | (Self::One(first), &[second, third, ref rest @ ..])
            | (Self::Two(first, second), &[third, ref rest @ ..]) => {
                *self = Self::None;
                (Some([first, second, third]), rest)
            }
            (Self::None, bytes) => {
                *self = Self::of(bytes);
                (None, [].as_slice())
            }
            (Self::One(first), &[second]) => {
                *self = Self::Two(first, second);
                (None, [].as_slice())
            }
            (Self::One(_) | Self::Two(..), []) => (None, [].as_slice()),
        };
        *input = rest;
        record
    }

    const fn truncation(self, offset: u64) -> Option<DecodeError> {
        let (first, present) = match self {
            Self::None => return None,
            Self::One(first) => (first, 1),
            Self::Two(first, _) => (first, 2),
        };
        let kind = DecodeErrorKind::Truncated { first, present };
        Some(DecodeError { offset, kind })
    }
}

/// The offset of the next record. No stream reaches 2^64 bytes.
#[inline]
const fn after(offset: u64) -> u64 {
    offset.wrapping_add(3)
}

/// Bytes that are no record, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("pattern byte {offset}: {kind}")]
#[non_exhaustive]
pub struct DecodeError {
    /// Offset of the wrong byte; of the first byte of the record when it is truncated.
    pub offset: u64,
    /// What is wrong.
    pub kind: DecodeErrorKind,
}

impl DecodeError {
    /// The same error in a record that starts at `start`.
    #[inline]
    const fn after(self, start: u64) -> Self {
        Self {
            offset: start.wrapping_add(self.offset),
            kind: self.kind,
        }
    }
}

/// What is wrong with a record's bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DecodeErrorKind {
    /// The mark of a FAST record, 31 pulses, as the count of elbow or shoulder in a SLOW record.
    #[error("{byte:#04X} has 31 pulses for {axis} in a SLOW record, which holds at most 30")]
    SlowCount {
        /// The axis of the byte.
        axis: Axis,
        /// The byte.
        byte: u8,
    },
    /// D6 or D5 set in a SLOW byte, [`Strictness::Strict`] only.
    #[error("{byte:#04X} has D6 or D5 set for {axis} in a SLOW record")]
    SlowAxisBits {
        /// The axis of the byte.
        axis: Axis,
        /// The byte.
        byte: u8,
    },
    /// The bytes end inside a record.
    #[error("the record that starts with {first:#04X} is cut off after {present} of 3 bytes")]
    Truncated {
        /// The first byte of the record.
        first: u8,
        /// How many of its bytes are there, 1 or 2.
        present: u8,
    },
}
