//! The writer that all tables share: comment, include guard, `#define`s and arrays.

use core::fmt::{self, Write};

use super::style::check_name;
use super::{Dialect, WriteError};

/// Name and compiler of a table; in upper case the name starts those of the include guard and the
/// `#define`s.
#[derive(Clone, Copy)]
pub(crate) struct Table<'n> {
    pub(crate) name: &'n str,
    pub(crate) dialect: Dialect,
}

impl Table<'_> {
    /// A header with tables of `bytes` bytes: what the comment says of them, the ends and values of
    /// the `#define`s, and the tables.
    pub(crate) fn write<W: Write>(
        self,
        bytes: u64,
        comment: fmt::Arguments<'_>,
        defines: &[(&str, u64)],
        tables: impl FnOnce(&mut Layout<'_, '_, W>) -> fmt::Result,
        out: &mut W,
    ) -> Result<(), WriteError> {
        let Self { name, dialect } = self;
        check_name(name)?;
        check_size(bytes)?;
        let upper = Upper(name);
        writeln!(out, "/* {name}: {comment} */")?;
        write!(out, "#ifndef {upper}_H\n#define {upper}_H\n\n")?;
        for (end, value) in defines {
            writeln!(out, "#define {upper}_{end} {value}")?;
        }
        tables(&mut Layout { name, dialect, out })?;
        Ok(out.write_str("\n#endif\n")?)
    }
}

/// Code memory that an 8051 addresses, in bytes.
const CODE_SPACE: u64 = 65_536;

/// Refuses a table of a size that no firmware can hold.
const fn check_size(bytes: u64) -> Result<(), WriteError> {
    match bytes {
        0 => Err(WriteError::Empty),
        1..=CODE_SPACE => Ok(()),
        _ => Err(WriteError::TooLong {
            bytes,
            limit: CODE_SPACE,
        }),
    }
}

/// A name in upper case.
struct Upper<'n>(&'n str);

impl fmt::Display for Upper<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut upper = self.0.chars().map(|c| c.to_ascii_uppercase());
        upper.try_for_each(|c| f.write_char(c))
    }
}

/// Type of a table's elements.
#[derive(Clone, Copy)]
pub(crate) enum Element {
    SignedChar,
    UnsignedChar,
    UnsignedInt,
}

/// A value as it stands in a table.
#[derive(Clone, Copy)]
pub(crate) enum Value {
    /// In decimal, in a column of four.
    Signed(i8),
    /// In decimal.
    Count(u8),
    /// In hexadecimal.
    Byte(u8),
    /// In hexadecimal.
    Word(u16),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Signed(value) => write!(f, "{value:4}"),
            Self::Count(value) => write!(f, "{value}"),
            Self::Byte(value) => write!(f, "0x{value:02X}"),
            Self::Word(value) => write!(f, "0x{value:04X}"),
        }
    }
}

/// Where the tables of a header are written.
pub(crate) struct Layout<'n, 'w, W: Write> {
    name: &'n str,
    dialect: Dialect,
    out: &'w mut W,
}

impl<W: Write> Layout<'_, '_, W> {
    /// What is said of the table that follows, after an empty line.
    pub(crate) fn comment(&mut self, comment: fmt::Arguments<'_>) -> fmt::Result {
        write!(self.out, "\n/* {comment} */\n")
    }

    pub(crate) fn empty_line(&mut self) -> fmt::Result {
        self.out.write_char('\n')
    }

    /// An array of `length` elements, with the end of its name. Some of its values begin a row.
    pub(crate) fn table(
        &mut self,
        element: Element,
        end: &str,
        length: u64,
        values: impl Iterator<Item = (bool, Value)>,
    ) -> fmt::Result {
        let Self { name, dialect, out } = self;
        let element = match element {
            Element::SignedChar => "signed char",
            Element::UnsignedChar => "unsigned char",
            Element::UnsignedInt => "unsigned int",
        };
        match dialect {
            Dialect::C51 => write!(out, "{element} code {name}{end}[{length}] = {{")?,
            Dialect::Sdcc => write!(out, "const __code {element} {name}{end}[{length}] = {{")?,
        }
        let mut before_row = "\n  ";
        for (begins_row, value) in values {
            let between = if begins_row { before_row } else { ", " };
            write!(out, "{between}{value}")?;
            before_row = ",\n  ";
        }
        out.write_str("\n};\n")
    }
}
