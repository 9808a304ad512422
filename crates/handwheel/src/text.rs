//! The character set of the display.

use core::fmt;

use crate::error::LcdError;

/// Display code of a character less its ASCII code: inferred from the manual's examples, whose
/// eleven letters all fit.
const ABOVE_ASCII: u8 = 0x60;
/// The space.
const FIRST_CODE: u8 = 0x80;

/// A text for the display, or from a telegram.
///
/// ```text
/// display code = ASCII code + 60h        20h..=7Eh -> 80h..=DEh
/// ```
/// Codes from `DFh` on are the unit's own; they come through unchanged in both directions.
#[derive(Clone, Copy)]
pub struct Text<'a> {
    bytes: &'a [u8],
    /// What makes a display code of a byte.
    offset: u8,
}

impl<'a> Text<'a> {
    /// From printable ASCII.
    ///
    /// # Errors
    /// [`LcdError::Character`] for anything else.
    pub fn new(text: &'a str) -> Result<Self, LcdError> {
        Self::from_ascii(text.as_bytes())
    }

    /// From the bytes of printable ASCII.
    ///
    /// # Errors
    /// [`LcdError::Character`] for anything else.
    pub fn from_ascii(bytes: &'a [u8]) -> Result<Self, LcdError> {
        let offset = ABOVE_ASCII;
        let checked = Self { bytes, offset };
        match (0..).zip(bytes).find(|&(_, &byte)| !is_printable(byte)) {
            None => Ok(checked),
            Some((index, &byte)) => Err(LcdError::Character { index, byte }),
        }
    }

    /// As many display codes as `bytes` begin with, and the rest.
    pub(crate) fn split_codes(bytes: &'a [u8]) -> (Self, &'a [u8]) {
        let end = bytes.iter().position(|&byte| byte < FIRST_CODE);
        let split = end.and_then(|end| bytes.split_at_checked(end));
        let (bytes, rest) = split.unwrap_or((bytes, &[])); // without an end all are codes
        (Self { bytes, offset: 0 }, rest)
    }

    /// Characters.
    #[must_use]
    pub const fn len(self) -> usize {
        self.bytes.len()
    }

    /// Whether there is no character.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.bytes.is_empty()
    }

    /// The codes for the display.
    #[must_use]
    pub fn codes(self) -> impl ExactSizeIterator<Item = u8> + Clone + 'a {
        let offset = self.offset;
        self.bytes.iter().map(move |byte| byte.wrapping_add(offset))
    }

    /// The characters; [`char::REPLACEMENT_CHARACTER`] for the unit's own.
    #[must_use]
    pub fn chars(self) -> impl ExactSizeIterator<Item = char> + Clone + 'a {
        self.codes()
            .map(|code| match code.wrapping_sub(ABOVE_ASCII) {
                ascii @ b' '..=b'~' => char::from(ascii),
                _ => char::REPLACEMENT_CHARACTER,
            })
    }
}

impl PartialEq for Text<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.codes().eq(other.codes())
    }
}

impl Eq for Text<'_> {}

impl fmt::Debug for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Text(\"{self}\")")
    }
}

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.chars()
            .try_for_each(|character| fmt::Write::write_char(f, character))
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Text<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        for character in self.chars() {
            defmt::write!(f, "{=char}", character);
        }
    }
}

/// Whether the display has the character.
pub(crate) fn is_printable(byte: u8) -> bool {
    (b' '..=b'~').contains(&byte)
}
