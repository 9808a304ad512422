use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc, Digest};
use thiserror::Error;

use crate::engraving::{AxisCodeError, AxisCodes, ByteOrder, Format, PerAxis, RECORD_LEN};

/// Length of the header in bytes.
pub const HEADER_LEN: usize = 16;
/// Length of the trailer, the CRC-32 behind the payload, in bytes.
pub const TRAILER_LEN: usize = 4;

const MAGIC: [u8; 4] = *b"\x89P2P";
const VERSION: u8 = 1;
const ENGRAVING: u8 = 1;

/// One table of 1 KiB. The variant with 16 tables is faster, but takes 16 KiB of flash.
static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// What a container says about its payload.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Header {
    content: Content,
    payload_len: u32,
}

impl Header {
    /// The header of so many engraving records.
    ///
    /// # Errors
    /// [`TooLong`] when their bytes are more than 32 bits can count.
    pub fn engraving(format: &Format, records: u64) -> Result<Self, TooLong> {
        let payload_len = records
            .checked_mul(RECORD_LEN as u64)
            .and_then(|bytes| u32::try_from(bytes).ok())
            .ok_or(TooLong { records })?;
        // The mode is the reader's own business and not stored.
        let content = Content::Engraving(Format {
            mode: Format::default().mode,
            ..*format
        });
        Ok(Self {
            content,
            payload_len,
        })
    }

    /// Kind and settings of the payload.
    #[must_use]
    pub const fn content(&self) -> Content {
        self.content
    }

    /// Length of the payload in bytes.
    #[must_use]
    pub const fn payload_len(&self) -> u32 {
        self.payload_len
    }

    /// The bytes of the header, and the check value so far for the payload to go on from.
    pub(super) fn encode(&self) -> ([u8; HEADER_LEN], Checksum) {
        let Content::Engraving(format) = self.content;
        let codes = format.axis_codes.codes();
        let axes = codes.theta1 | codes.theta2 << 2 | codes.theta3 << 4 | codes.vertical << 6;
        let order = match format.byte_order {
            ByteOrder::BigEndian => 0,
            ByteOrder::LittleEndian => 1,
        };
        let settings = [VERSION, ENGRAVING, axes, order];
        let fields = [MAGIC, settings, self.payload_len.to_be_bytes()];
        let checksum = Checksum::of(fields.as_flattened());
        let [magic, settings, length] = fields;
        let words = [magic, settings, length, checksum.value().to_be_bytes()];
        let mut bytes = [0; HEADER_LEN];
        for (byte, value) in bytes.iter_mut().zip(words.as_flattened()) {
            *byte = *value;
        }
        (bytes, checksum)
    }

    /// Checks and reads the bytes of a header.
    pub(super) fn decode(bytes: &[u8; HEADER_LEN]) -> Result<(Self, Checksum), HeaderError> {
        let [magic, settings, length, stored] = words(bytes);
        if magic != MAGIC {
            return Err(HeaderError::Magic { found: magic });
        }
        let checksum = Checksum::of([magic, settings, length].as_flattened());
        let stored = u32::from_be_bytes(stored);
        let computed = checksum.value();
        if stored != computed {
            return Err(HeaderError::Damaged { stored, computed });
        }
        let [version, content, axes, order] = settings;
        if version != VERSION {
            return Err(HeaderError::Version { found: version });
        }
        if content != ENGRAVING {
            return Err(HeaderError::Content { found: content });
        }
        let axis_codes = AxisCodes::new(PerAxis {
            theta1: axes & 3,
            theta2: axes >> 2 & 3,
            theta3: axes >> 4 & 3,
            vertical: axes >> 6,
        })?;
        let byte_order = match order {
            0 => ByteOrder::BigEndian,
            1 => ByteOrder::LittleEndian,
            found => return Err(HeaderError::ByteOrder { found }),
        };
        let payload_len = u32::from_be_bytes(length);
        if !payload_len.is_multiple_of(3) {
            return Err(HeaderError::PartialRecord { payload_len });
        }
        let format = Format::default()
            .with_axis_codes(axis_codes)
            .with_byte_order(byte_order);
        let header = Self {
            content: Content::Engraving(format),
            payload_len,
        };
        Ok((header, checksum))
    }
}

/// The four words of a header.
const fn words(bytes: &[u8; HEADER_LEN]) -> [[u8; 4]; 4] {
    let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = *bytes;
    [[a, b, c, d], [e, f, g, h], [i, j, k, l], [m, n, o, p]]
}

/// What a payload is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Content {
    /// Engraving records in this format, whose mode is the default one.
    Engraving(Format),
}

/// The CRC-32 of what has passed so far.
#[derive(Clone)]
pub(super) struct Checksum(Digest<'static, u32>);

impl Checksum {
    fn of(bytes: &[u8]) -> Self {
        let mut this = Self(CRC.digest());
        this.update(bytes);
        this
    }

    pub(super) fn update(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    pub(super) fn value(&self) -> u32 {
        self.0.clone().finalize()
    }
}

impl fmt::Debug for Checksum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Checksum({:#010X})", self.value())
    }
}

/// More records than a container holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{records} records are more than the {} of one container", u32::MAX.div_euclid(3))]
#[non_exhaustive]
pub struct TooLong {
    /// The records asked for.
    pub records: u64,
}

/// Why sixteen bytes are no header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum HeaderError {
    /// This is another kind of file.
    #[error("no container: it starts with {found:02X?}, not with {MAGIC:02X?}")]
    Magic {
        /// The first four bytes.
        found: [u8; 4],
    },
    /// The header's check value does not match.
    #[error("damaged header: its CRC-32 is {computed:#010X}, but {stored:#010X} stands in it")]
    Damaged {
        /// The check value in the header.
        stored: u32,
        /// The check value of the header.
        computed: u32,
    },
    /// Made by a later version of this format.
    #[error("container version {found}, only {VERSION} is known")]
    Version {
        /// The version in the header.
        found: u8,
    },
    /// A kind of payload that is not known here.
    #[error("content kind {found}, only {ENGRAVING} (engraving records) is known")]
    Content {
        /// The kind in the header.
        found: u8,
    },
    /// The axis codes are not distinct.
    #[error("header byte 6: {0}")]
    AxisCodes(#[from] AxisCodeError),
    /// The byte order is neither of the two.
    #[error("header byte 7: byte order {found} is neither 0 nor 1")]
    ByteOrder {
        /// The value in the header.
        found: u8,
    },
    /// The payload is not made of whole records.
    #[error("header byte 8: a payload of {payload_len} bytes is no whole number of 3-byte records")]
    PartialRecord {
        /// The length in the header.
        payload_len: u32,
    },
}
