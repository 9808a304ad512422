//! What is wrong with a text or a command for the display.

use thiserror::Error;

use crate::cells::Rect;
use crate::number::NumberError;
use crate::report::Model;

/// Characters of a text that the unit stores, at most.
pub(crate) const MAX_TEXT: usize = 30;

/// Why a display command cannot be written or read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LcdError {
    /// The block has no room for it.
    #[error("the block would have {len} bytes, the unit takes {max}")]
    Full {
        /// Bytes with the command.
        len: usize,
        /// Bytes that the unit takes.
        max: usize,
    },
    /// A character that the display cannot show.
    #[error("byte {index} of the text, {byte:02X}h, is not printable ASCII")]
    Character {
        /// Its index.
        index: usize,
        /// The byte.
        byte: u8,
    },
    /// A text longer than the unit stores.
    #[error("the text has {len} characters, the unit stores {MAX_TEXT}")]
    TextTooLong {
        /// Characters.
        len: usize,
    },
    /// A font where the unit has none, or none where it must be.
    #[error("the font must be given on the HBAS, and there alone; this is the {model:?}")]
    Font {
        /// The unit.
        model: Model,
    },
    /// A corner lies above or left of the other.
    #[error("the rectangle ends before it starts: {rect:?}")]
    Corners {
        /// The rectangle.
        rect: Rect,
    },
    /// A byte that is no command.
    #[error("byte {index} of the block: {byte:02X}h is no command")]
    NoCommand {
        /// Its index; the 6Ch has 0.
        index: usize,
        /// The byte.
        byte: u8,
    },
    /// A parameter outside its range.
    #[error("byte {index} of the block: {error}")]
    Parameter {
        /// Its index; the 6Ch has 0.
        index: usize,
        /// The range.
        error: NumberError,
    },
    /// The block ends within a command.
    #[error("the block ends after {len} bytes, within a command")]
    Truncated {
        /// Bytes of the block.
        len: usize,
    },
}
