//! Why a header is not written.

use core::fmt;

use thiserror::Error;

/// Highest number of characters in a name; every C compiler distinguishes names of that length.
pub(super) const MAX_NAME: usize = 31;

/// Why a header is not written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WriteError {
    /// A name without a character.
    #[error("the name of a table is empty")]
    NameEmpty,
    /// A character that C does not allow there.
    #[error("{character:?} cannot stand in the name of a table, or not first")]
    NameCharacter {
        /// The first such character.
        character: char,
    },
    /// A word that means something else in C.
    #[error("a table cannot have a keyword of the compiler as its name")]
    NameKeyword,
    /// Too many characters.
    #[error("a table's name of {length} characters, max {MAX_NAME}")]
    NameTooLong {
        /// Its length.
        length: usize,
    },
    /// Nothing to write: C has no empty arrays.
    #[error("a table without values")]
    Empty,
    /// More than the address space of code memory.
    #[error("a table of {bytes} bytes, an 8051 addresses {limit}")]
    TooLong {
        /// Bytes of the table.
        bytes: u64,
        /// The highest number of them.
        limit: u64,
    },
    /// The writer refused.
    #[error("the header could not be written")]
    Format,
}

impl From<fmt::Error> for WriteError {
    fn from(_: fmt::Error) -> Self {
        Self::Format
    }
}
