//! Records as a C header, and back.

use core::fmt::{self, Write};
use core::iter::FusedIterator;

use super::{
    Axis, AxisCodes, ByteOrder, DecodeError, Decoder, Format, PerAxis, Record, Statistics,
};
use crate::c_header::{
    ArrayValues, BYTE, Bytes, Checked, Dialect, Element, HeaderError, HeaderErrorKind, Layout,
    Source, Table, Value, WriteError,
};

/// Writes records as a C header.
///
/// ```
/// use pattern_codec::engraving::{Axis, Builder, Format, PatternData, PatternHeader};
///
/// let format = Format::default();
/// let records = Builder::new().fast(Axis::Vertical, -400)?;
/// let mut text = String::new();
/// PatternHeader::new(format).write(records.clone(), &mut text)?;
/// assert!(text.contains("unsigned char code pattern[3] = {\n  0xFF, 0x01, 0x90\n};"));
///
/// let data = PatternData::read(&text, format)?;
/// assert!(data.records().eq(records));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// The `#define`s, each after the name of the table in upper case: `RECORDS` and `BYTES`; the axis
/// codes `ELBOW_CODE`, `SHOULDER_CODE`, `DISC_CODE`, `VERTICAL_CODE`; `HIGH_BYTE_FIRST`, 1 or 0.
/// One record a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "plain settings, to be written as a literal on top of the default"
)]
pub struct PatternHeader<'n> {
    /// Name of the table, a C identifier of at most 31 characters.
    pub name: &'n str,
    /// The compiler that reads it.
    pub dialect: Dialect,
    /// The format of the records.
    pub format: Format,
}

/// Ends of the names of the axis codes.
const CODES: PerAxis<&str> = PerAxis {
    elbow: "ELBOW_CODE",
    shoulder: "SHOULDER_CODE",
    disc: "DISC_CODE",
    vertical: "VERTICAL_CODE",
};

impl PatternHeader<'_> {
    /// The table `pattern` for C51, in a format.
    #[must_use]
    pub const fn new(format: Format) -> Self {
        Self {
            name: "pattern",
            dialect: Dialect::C51,
            format,
        }
    }

    /// Writes the header. The records are gone through twice, because the totals stand first.
    ///
    /// # Errors
    /// [`WriteError`]: a name that C does not take, no records, more bytes than an 8051 addresses,
    /// or the writer's error.
    pub fn write<I, W>(&self, records: I, out: &mut W) -> Result<(), WriteError>
    where
        I: IntoIterator<Item = Record>,
        I::IntoIter: Clone,
        W: Write,
    {
        let records = records.into_iter();
        let statistics: Statistics = records.clone().collect();
        let Statistics {
            fast_records: fast,
            slow_records: slow,
            pulses,
            ..
        } = statistics;
        let (count, bytes) = (statistics.records(), statistics.bytes());
        let comment = format_args!(
            "{count} records, {fast} FAST and {slow} SLOW, {bytes} bytes.\n   \
             Pulses: elbow {}, shoulder {}, disc {}, vertical {}.",
            pulses.elbow, pulses.shoulder, pulses.disc, pulses.vertical
        );
        let Format {
            axis_codes,
            byte_order,
            ..
        } = self.format;
        let [elbow, shoulder, disc, vertical] =
            Axis::ALL.map(|axis| (*CODES.get(axis), axis_codes.code(axis).into()));
        let defines = [
            ("RECORDS", count),
            ("BYTES", bytes),
            elbow,
            shoulder,
            disc,
            vertical,
            (
                "HIGH_BYTE_FIRST",
                (byte_order == ByteOrder::BigEndian).into(),
            ),
        ];
        let values = records.flat_map(|record| {
            let [first, second, third] = record.encode(&self.format).map(Value::Byte);
            [(true, first), (false, second), (false, third)]
        });
        let table = |layout: &mut Layout<'_, '_, W>| {
            layout.empty_line()?;
            layout.table(Element::UnsignedChar, "", bytes, values)
        };
        let Self { name, dialect, .. } = *self;
        Table { name, dialect }.write(bytes, comment, &defines, table, out)
    }
}

/// The records of a C header, checked as a whole when it is read.
///
/// The header may be one of [`PatternHeader`] or written by hand. Values are -128..=255, two's
/// complement.
#[derive(Debug, Clone)]
pub struct PatternData<'t> {
    name: &'t str,
    format: Format,
    records: Checked<TableRecords<'t>>,
}

impl<'t> PatternData<'t> {
    /// Reads a header with one array. Axis codes and byte order that it does not define, and the
    /// strictness, are those of `format`.
    ///
    /// # Errors
    /// [`HeaderError`] names a location and what is wrong there.
    pub fn read(text: &'t str, format: Format) -> Result<Self, HeaderError> {
        Self::find(text, None, format)
    }

    /// Reads the array of that name; there may be others.
    ///
    /// # Errors
    /// As [`PatternData::read`].
    pub fn read_array(text: &'t str, name: &str, format: Format) -> Result<Self, HeaderError> {
        Self::find(text, Some(name), format)
    }

    fn find(text: &'t str, wanted: Option<&str>, format: Format) -> Result<Self, HeaderError> {
        let (source, values) = Source::find(text, wanted, BYTE)?;
        let format = read_format(&source, &values, format)?;
        let records = TableRecords {
            decoder: Decoder::new(format),
            table: Bytes(values),
        };
        let (records, _) = Checked::new(
            records,
            |records| &records.table.0,
            HeaderErrorKind::Records,
        )?;
        let count = records.left();
        source.agree("RECORDS", count)?;
        source.agree("BYTES", count.saturating_mul(Record::LEN as u64))?;
        Ok(Self {
            name: source.name,
            format,
            records,
        })
    }

    /// The name of the array.
    #[must_use]
    pub const fn name(&self) -> &'t str {
        self.name
    }

    /// The format of the records.
    #[must_use]
    pub const fn format(&self) -> Format {
        self.format
    }

    /// The number of records.
    #[must_use]
    pub const fn record_count(&self) -> u64 {
        self.records.left()
    }

    /// The records, straight from the text.
    #[must_use]
    pub fn records(&self) -> impl FusedIterator<Item = Record> + Clone + fmt::Debug + use<'t> {
        self.records.clone()
    }
}

/// A format with the axis codes and the byte order that a header defines.
fn read_format(
    source: &Source<'_>,
    table: &ArrayValues<'_>,
    format: Format,
) -> Result<Format, HeaderError> {
    let mut codes = format.axis_codes.codes();
    for axis in Axis::ALL {
        let code = codes.get_mut(axis);
        *code = source.setting(CODES.get(axis), *code, (0, 3), |value| {
            u8::try_from(value).ok().filter(|code| *code <= 3)
        })?;
    }
    let start = table.location;
    let codes =
        AxisCodes::new(codes).map_err(|error| start.error(HeaderErrorKind::AxisCodes(error)))?;
    let order = |value| match value {
        0 => Some(ByteOrder::LittleEndian),
        1 => Some(ByteOrder::BigEndian),
        _ => None,
    };
    let byte_order = source.setting("HIGH_BYTE_FIRST", format.byte_order, (0, 1), order)?;
    Ok(format.with_axis_codes(codes).with_byte_order(byte_order))
}

/// The records of an array of bytes.
#[derive(Debug, Clone)]
struct TableRecords<'t> {
    decoder: Decoder,
    table: Bytes<'t>,
}

impl Iterator for TableRecords<'_> {
    type Item = Result<Record, DecodeError>;

    fn next(&mut self) -> Option<Self::Item> {
        for byte in self.table.by_ref() {
            if let Some(located) = self.decoder.decode(&mut [byte].as_slice()) {
                return Some(located.map(|located| located.record));
            }
        }
        self.decoder.clone().finish().err().map(Err)
    }
}
