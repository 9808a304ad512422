//! A container around the pattern bytes, which alone have no mark, no length and no check.
//!
//! ```text
//! offset  bytes
//!      0      4  magic 89h 50h 32h 50h
//!      4      1  version, 1
//!      5      1  content, 1 = engraving records
//!      6      1  axis codes: theta1 in D1 D0, theta2 D3 D2, theta3 D5 D4, vertical D7 D6
//!      7      1  byte order of FAST counts: 0 high byte first, 1 low byte first
//!      8      4  length n of the payload in bytes
//!     12      4  CRC-32 of bytes 0..12
//!     16      n  payload
//!   16+n      4  CRC-32 of bytes 0..12 and the payload
//! ```
//! Numbers stand high byte first. CRC-32 is CRC-32/ISO-HDLC, the one of Ethernet and zip: it finds
//! every error burst of up to 32 bits, and every flip of up to two bits in a payload below 512 MiB.
//!
//! The length stands in front so that a reader knows what comes, the check value at the end so
//! that a writer need not hold or foresee the payload. The header has a check value of its own so
//! that a damaged length is called that, and not a truncation.
//!
//! Writing in constant memory, with a first pass that counts:
//! ```
//! use pattern_codec::container::{Header, Writer};
//! use pattern_codec::engraving::{Axis, Builder, Format, Statistics};
//!
//! let format = Format::default();
//! let records = Builder::new().fast(Axis::Vertical, 100_000)?;
//! let statistics: Statistics = records.clone().collect();
//!
//! let (header, mut writer) = Writer::new(Header::engraving(&format, statistics.records())?);
//! let mut file = header.to_vec();
//! for record in records {
//!     let bytes = record.encode(&format);
//!     writer.update(&bytes)?;
//!     file.extend(bytes);
//! }
//! file.extend(writer.finish()?);
//! assert_eq!(file.len(), 16 + 6 + 4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! Reading: [`open`] for a slice, [`Verifier`] for a stream that does not fit into memory. Both
//! check the whole before anything is decoded.

mod header;
mod read;
mod write;

pub use header::{Content, HEADER_LEN, Header, HeaderError, TRAILER_LEN, TooLong};
pub use read::{Container, ContainerError, Verifier, open};
pub use write::{LengthMismatch, Writer};
