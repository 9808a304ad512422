use core::fmt::Write;
use core::iter::FusedIterator;

use super::{Axis, AxisCodes, ByteOrder, Decoder, Format, PerAxis, RECORD_LEN, Record, Statistics};
use crate::c_header::{
    BYTE, Bytes, Dialect, Element, HeaderError, HeaderErrorKind, Layout, Name, WriteError, agree,
    array, check_size, setting,
};
use crate::size_hint::size_of_rest;

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
/// The `#define`s, each behind the name of the table in upper case: `RECORDS` and `BYTES`; the axis
/// codes `THETA1_CODE`, `THETA2_CODE`, `THETA3_CODE`, `VERTICAL_CODE`; `HIGH_BYTE_FIRST`, 1 or 0.
/// One record a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PatternHeader<'n> {
    name: Name<'n>,
    dialect: Dialect,
    format: Format,
}

/// Ends of the names of the axis codes.
const CODES: [(Axis, &str); 4] = [
    (Axis::Theta1, "THETA1_CODE"),
    (Axis::Theta2, "THETA2_CODE"),
    (Axis::Theta3, "THETA3_CODE"),
    (Axis::Vertical, "VERTICAL_CODE"),
];

impl<'n> PatternHeader<'n> {
    /// The table `pattern` for C51, in a format.
    #[must_use]
    pub const fn new(format: Format) -> Self {
        Self {
            name: Name::fixed("pattern"),
            dialect: Dialect::C51,
            format,
        }
    }

    /// With another name of the table.
    #[must_use]
    pub const fn with_name(self, name: Name<'n>) -> Self {
        Self { name, ..self }
    }

    /// For another compiler.
    #[must_use]
    pub const fn with_dialect(self, dialect: Dialect) -> Self {
        Self { dialect, ..self }
    }

    /// Writes the header. The records are gone through twice, because the totals stand first.
    ///
    /// # Errors
    /// [`WriteError`]: no records, more bytes than an 8051 addresses, or the writer's error.
    pub fn write<I, W>(&self, records: I, out: &mut W) -> Result<(), WriteError>
    where
        I: IntoIterator<Item = Record>,
        I::IntoIter: Clone,
        W: Write,
    {
        let records = records.into_iter();
        let statistics: Statistics = records.clone().collect();
        let bytes = statistics.bytes();
        check_size(bytes)?;
        let (name, dialect, codes) = (self.name, self.dialect, self.format.axis_codes);
        totals(name, &statistics, out)?;
        let mut layout = Layout { name, dialect, out };
        layout.open_guard()?;
        layout.define("RECORDS", statistics.records())?;
        layout.define("BYTES", bytes)?;
        for (axis, end) in CODES {
            layout.define(end, codes.code(axis).into())?;
        }
        let high_byte_first = self.format.byte_order == ByteOrder::BigEndian;
        layout.define("HIGH_BYTE_FIRST", high_byte_first.into())?;
        layout.out.write_char('\n')?;
        layout.open_table(Element::UnsignedChar, "", bytes)?;
        let mut between = "  ";
        for record in records {
            let [first, second, third] = record.encode(&self.format);
            let out = &mut layout.out;
            write!(out, "{between}0x{first:02X}, 0x{second:02X}, 0x{third:02X}")?;
            between = ",\n  ";
        }
        layout.close_table()?;
        Ok(layout.close_guard()?)
    }
}

fn totals<W: Write>(
    name: Name<'_>,
    statistics: &Statistics,
    out: &mut W,
) -> Result<(), WriteError> {
    let Statistics {
        fast_records: fast,
        slow_records: slow,
        pulses,
        ..
    } = statistics;
    let (name, records, bytes) = (name.as_str(), statistics.records(), statistics.bytes());
    writeln!(
        out,
        "/* {name}: {records} records, {fast} FAST and {slow} SLOW, {bytes} bytes."
    )?;
    let PerAxis {
        theta1,
        theta2,
        theta3,
        vertical,
    } = pulses;
    writeln!(
        out,
        "   Pulses: theta1 {theta1}, theta2 {theta2}, theta3 {theta3}, vertical {vertical}. */"
    )?;
    Ok(())
}

/// The records of a C header, checked as a whole when it is read.
///
/// The header may be one of [`PatternHeader`] or written by hand. Values are -128..=255, two's
/// complement.
#[derive(Debug, Clone)]
pub struct PatternData<'t> {
    name: &'t str,
    format: Format,
    records: u64,
    table: Bytes<'t>,
}

impl<'t> PatternData<'t> {
    /// Reads a header with one array. Axis codes and byte order that it does not define, and the
    /// mode, are those of `format`.
    ///
    /// # Errors
    /// [`HeaderError`] names a place and what is wrong there.
    pub fn read(text: &'t str, format: Format) -> Result<Self, HeaderError> {
        Self::of(text, None, format)
    }

    /// Reads the array of that name; there may be others.
    ///
    /// # Errors
    /// As [`PatternData::read`].
    pub fn read_array(text: &'t str, name: &str, format: Format) -> Result<Self, HeaderError> {
        Self::of(text, Some((name, "")), format)
    }

    fn of(
        text: &'t str,
        wanted: Option<(&str, &str)>,
        format: Format,
    ) -> Result<Self, HeaderError> {
        let (name, values) = array(text, wanted, BYTE)?;
        let start = values.place;
        let mut codes = format.axis_codes.codes();
        for (axis, end) in CODES {
            let code = codes.get_mut(axis);
            *code = setting(text, name, end, *code, (0, 3), |value| {
                u8::try_from(value).ok().filter(|code| *code <= 3)
            })?;
        }
        let codes = AxisCodes::new(codes)
            .map_err(|error| start.error(HeaderErrorKind::AxisCodes(error)))?;
        let order = |value| match value {
            0 => Some(ByteOrder::LittleEndian),
            1 => Some(ByteOrder::BigEndian),
            _ => None,
        };
        let byte_order = format.byte_order;
        let byte_order = setting(text, name, "HIGH_BYTE_FIRST", byte_order, (0, 1), order)?;
        let mut data = Self {
            name,
            format: format.with_axis_codes(codes).with_byte_order(byte_order),
            records: 0,
            table: Bytes(values),
        };
        data.records = data.check()?;
        agree(text, name, "RECORDS", data.records)?;
        agree(
            text,
            name,
            "BYTES",
            data.records.saturating_mul(RECORD_LEN as u64),
        )?;
        Ok(data)
    }

    /// Goes through all records and counts them.
    fn check(&self) -> Result<u64, HeaderError> {
        let mut decoder = Decoder::new(self.format);
        let mut table = self.table.clone();
        let mut records = 0_u64;
        let wrong = loop {
            let Some(byte) = table.next() else {
                break decoder.finish().err();
            };
            match decoder.decode(&mut [byte].as_slice()) {
                None => {}
                Some(Ok(_)) => records = records.saturating_add(1),
                Some(Err(error)) => break Some(error),
            }
        };
        let Bytes(values) = table;
        let wrong = wrong.map(|error| values.place.error(HeaderErrorKind::Records(error)));
        values.error.or(wrong).map_or(Ok(records), Err)
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

    /// The records, straight from the text.
    pub fn records(&self) -> PatternRecords<'t> {
        PatternRecords {
            decoder: Decoder::new(self.format),
            table: self.table.clone(),
            left: self.records,
        }
    }
}

/// The records of a header, made by [`PatternData::records`].
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct PatternRecords<'t> {
    decoder: Decoder,
    table: Bytes<'t>,
    left: u64,
}

impl PatternRecords<'_> {
    /// Records still to come.
    #[must_use]
    pub const fn remaining(&self) -> u64 {
        self.left
    }
}

impl Iterator for PatternRecords<'_> {
    type Item = Record;

    fn next(&mut self) -> Option<Record> {
        self.left = self.left.checked_sub(1)?;
        loop {
            let byte = self.table.next()?;
            if let Some(located) = self.decoder.decode(&mut [byte].as_slice()) {
                // No error comes: the text has been read once.
                return located.ok().map(|located| located.record);
            }
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.left)
    }
}

impl FusedIterator for PatternRecords<'_> {}
