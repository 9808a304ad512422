//! What a caller chooses for a header: the compiler, and a name that compilers take.

use thiserror::Error;

/// The compiler that a header is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Dialect {
    /// Keil C51: `unsigned char code dance[8]`.
    #[default]
    C51,
    /// SDCC: `const __code unsigned char dance[8]`.
    Sdcc,
}

/// The name of a table: a C identifier of at most 31 characters, which every C compiler tells
/// apart. In upper case it starts the names of the include guard and the `#define`s.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Name<'n>(&'n str);

impl<'n> Name<'n> {
    /// Highest number of characters.
    pub const MAX_LEN: usize = 31;

    /// Checks a name.
    ///
    /// # Errors
    /// [`NameError`] when it is empty, too long, no letters, digits and `_` with a letter first, or
    /// a word of C that no table can have as a name, in C51 or SDCC.
    pub fn new(name: &'n str) -> Result<Self, NameError> {
        let Some(first) = name.chars().next() else {
            return Err(NameError::Empty);
        };
        if !first.is_ascii_alphabetic() {
            return Err(NameError::Character { character: first });
        }
        let wrong = |c: &char| !c.is_ascii_alphanumeric() && *c != '_';
        if let Some(character) = name.chars().find(wrong) {
            return Err(NameError::Character { character });
        }
        match name.len() {
            length if length > Self::MAX_LEN => Err(NameError::TooLong { length }),
            _ if KEYWORDS.split(' ').any(|word| word == name) => Err(NameError::Keyword),
            _ => Ok(Self(name)),
        }
    }

    pub(crate) const fn fixed(name: &'static str) -> Self {
        Self(name)
    }

    /// The name.
    #[must_use]
    pub const fn as_str(self) -> &'n str {
        self.0
    }
}

/// The words of C, then those that C51 and SDCC have besides.
const KEYWORDS: &str = "auto break case char const continue default do double else enum extern \
    float for goto if inline int long register restrict return short signed sizeof static struct \
    switch typedef union unsigned void volatile while \
    alien asm at bdata bit code compact critical data far idata interrupt large naked near pdata \
    reentrant sbit sfr sfr16 sfr32 small using wparam xdata";

/// Why a table cannot have a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum NameError {
    /// No character.
    #[error("the name of a table is empty")]
    Empty,
    /// A character that C does not allow there.
    #[error("{character:?} cannot stand in the name of a table, or not first")]
    Character {
        /// The first such character.
        character: char,
    },
    /// A word that means something else in C.
    #[error("a table cannot have a keyword of the compiler as its name")]
    Keyword,
    /// Too many characters.
    #[error("a table's name of {length} characters, max {}", Name::MAX_LEN)]
    TooLong {
        /// Its length.
        length: usize,
    },
}
