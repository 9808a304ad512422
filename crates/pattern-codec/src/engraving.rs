//! The pattern bytes of the glass engraver: two kinds of record, three bytes each, without
//! header, end mark or check value [Engraver 2000].
//!
//! ```text
//! FAST  one axis, rapid, tool out of the glass
//!   byte 0    D7 direction | D6 D5 axis code | D4..D0 = 11111
//!   byte 1,2  pulse count 0..=65535
//!
//! SLOW  disc first, then elbow and shoulder together
//!   byte 0    D7 direction | D6 D5 zero | D4..D0 disc pulses 0..=30
//!   byte 1    the same for elbow
//!   byte 2    the same for shoulder
//! ```
//!
//! | case | decoded | encoded |
//! |---|---|---|
//! | low five bits of a record's first byte all ones | the record is FAST | |
//! | low five bits all ones in the elbow or shoulder byte | error | cannot be built |
//! | D7 set | negative direction | the same |
//! | D7 set on a zero count | zero; [`Located::is_canonical`] is `false` | D7 clear |
//! | D6 or D5 set in a SLOW byte | strict: error; lenient: ignored | both clear |
//! | FAST 0; SLOW 0, 0, 0 | a record without motion | the same; [`Builder`] emits none |
//! | fewer than three bytes left | error | cannot happen |
//! | more pulses than one record holds | | split by [`Builder`] |
//!
//! The source leaves open which axis has which code and in which order the two count bytes
//! stand: both are settings of [`Format`]. All 2^24 records of three bytes have a meaning or an
//! error under every format.

mod axis;
mod build;
mod decode;
mod format;
mod pattern_header;
mod record;
mod reload_header;
mod split;
mod statistics;

pub use axis::{Axis, PerAxis};
pub use build::{Builder, PositionOverflow, RepeatedAxis};
pub use decode::{DecodeError, DecodeErrorKind, Decoder, Located, Records};
pub use format::{AxisCodeError, AxisCodes, ByteOrder, Format, Strictness};
pub use pattern_header::{PatternData, PatternHeader};
pub use record::{Fast, JointPulses, PulsesError, Record, Slow};
pub use reload_header::{ReloadData, ReloadHeader, TimerPeriod};
pub use statistics::Statistics;
