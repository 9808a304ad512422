//! What a caller chooses for a header: the compiler, and a name that compilers take.

use super::write_error::{MAX_NAME, WriteError};

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

/// Refuses what is no C identifier, too long, or a word that no table can have as a name in C51 or
/// SDCC.
pub(super) fn check_name(name: &str) -> Result<(), WriteError> {
    let Some(first) = name.chars().next() else {
        return Err(WriteError::NameEmpty);
    };
    if !first.is_ascii_alphabetic() {
        return Err(WriteError::NameCharacter { character: first });
    }
    let wrong = |c: &char| !c.is_ascii_alphanumeric() && *c != '_';
    if let Some(character) = name.chars().find(wrong) {
        return Err(WriteError::NameCharacter { character });
    }
    match name.len() {
        length if length > MAX_NAME => Err(WriteError::NameTooLong { length }),
        _ if KEYWORDS.split(' ').any(|word| word == name) => Err(WriteError::NameKeyword),
        _ => Ok(()),
    }
}

/// The words of C, then those that C51 and SDCC have besides.
const KEYWORDS: &str = "auto break case char const continue default do double else enum extern \
    float for goto if inline int long register restrict return short signed sizeof static struct \
    switch typedef union unsigned void volatile while \
    alien asm at bdata bit code compact critical data far idata interrupt large naked near pdata \
    reentrant sbit sfr sfr16 sfr32 small using wparam xdata";
