//! Why a header cannot be read, and where.

use core::fmt;

use thiserror::Error;

/// A location in a text, line and column counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Location {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
}

impl Location {
    pub(super) const START: Self = Self { line: 1, column: 1 };

    pub(crate) const fn error(self, kind: HeaderErrorKind) -> HeaderError {
        HeaderError {
            location: self,
            kind,
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, column } = self;
        write!(f, "line {line}, column {column}")
    }
}

/// Why a header cannot be read, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{location}: {kind}")]
#[non_exhaustive]
pub struct HeaderError {
    /// Where.
    pub location: Location,
    /// Why.
    pub kind: HeaderErrorKind,
}

/// Why a header cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum HeaderErrorKind {
    /// A character that cannot stand here.
    #[error("{found:?} where {wanted} must stand")]
    Unexpected {
        /// The character.
        found: char,
        /// What the location needs.
        wanted: &'static str,
    },
    /// The text ends too early.
    #[error("the text ends where {wanted} must stand")]
    UnexpectedEnd {
        /// What the location needs.
        wanted: &'static str,
    },
    /// A comment without end; the location is its start.
    #[error("this comment has no end")]
    OpenComment,
    /// Digits and letters that are no number.
    #[error("this is not a number")]
    NotANumber,
    /// A number past 32 bits.
    #[error("this number has more than 32 bits")]
    TooLarge,
    /// An array of more than two dimensions.
    #[error("the array has more than two dimensions")]
    Dimensions,
    /// Row brackets in an array without row length.
    #[error("a row in an array that is not declared as name[][n]")]
    Row,
    /// A row shorter or longer than declared; the location is its end.
    #[error("a row of {values} values, declared are {declared}")]
    RowLength {
        /// Values in the row.
        values: u32,
        /// The declared row length.
        declared: u32,
    },
    /// An array shorter or longer than declared; the location is its end.
    #[error("an array of {values} values, declared are {declared}")]
    ArrayLength {
        /// Values in the array.
        values: u64,
        /// The product of its declared dimensions; for toggles, the bytes that the reloads need.
        declared: u64,
    },
    /// No array, or none of the wanted name; the location is the end of the text.
    #[error("the text ends without the array")]
    NoArray,
    /// A second array where only one can be meant.
    #[error("a second array: say which one is meant")]
    SecondArray,
    /// A value that the element cannot hold.
    #[error("{value} does not fit into {min}..={max}")]
    Range {
        /// The value.
        value: i64,
        /// The lowest that fits.
        min: i64,
        /// The highest that fits.
        max: i64,
    },
    /// A `#define` that contradicts the caller or the table.
    #[error("{name} is {value}, {wanted} wanted")]
    Define {
        /// The end of its name.
        name: &'static str,
        /// Its value.
        value: i64,
        /// The value that fits.
        wanted: u64,
    },
    /// Bytes that are no frames; the location is that of the last value read, or the end.
    #[error(transparent)]
    Frames(crate::dance::DecodeErrorKind),
    /// Bytes that are no records; the location is that of the last value read, or the end.
    #[error(transparent)]
    Records(crate::engraving::DecodeError),
    /// Axis codes that are no permutation of 0..=3; the location is the start of the table.
    #[error(transparent)]
    AxisCodes(crate::engraving::AxisCodeError),
}
