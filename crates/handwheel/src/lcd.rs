//! The display: commands, blocks of them, and reading them back.

mod block;
mod commands;

pub use block::LcdBlock;
pub use commands::LcdCommands;

use crate::cells::{Cell, Rect};
use crate::error::{LcdError, MAX_TEXT};
use crate::number::{AreaNumber, TextNumber};
use crate::text::Text;

/// The size of a text that the HBAS stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the unit has two")]
pub enum Font {
    /// 50h: 8 lines of 16 characters. Which of the two codes is which is inferred from their order.
    Small,
    /// 51h: 4 lines of 8 characters.
    Large,
}

/// A command for the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LcdCommand<'a> {
    /// Characters at the cursor.
    Text(Text<'a>),
    /// 21h: the cursor goes to the next cell.
    Next,
    /// 22h: to the previous cell.
    Previous,
    /// 23h: one line down.
    Down,
    /// 24h: one line up.
    Up,
    /// 25h: to line 0, column 0.
    Home,
    /// 26h: to column 0.
    LineStart,
    /// 27h: to a cell.
    Goto(Cell),
    /// 28h: clears the cell under the cursor.
    Delete,
    /// 29h: clears to the end of the line.
    DeleteToLineEnd,
    /// 2Ah: clears to the end of the display.
    DeleteToDisplayEnd,
    /// 2Bh: clears the display.
    DeleteAll,
    /// 2Ch: clears a rectangle.
    DeleteRect(Rect),
    /// 40h on, 41h off: what follows is inverse.
    Inverse(bool),
    /// 42h on, 43h off: what follows flashes.
    Flash(bool),
    /// 48h: stores a text of up to [`MAX_TEXT`](Self::MAX_TEXT) characters in the unit.
    DefineText {
        /// Its number.
        number: TextNumber,
        /// Its size; on the HBAS alone, and always there.
        font: Option<Font>,
        /// Where it begins.
        cell: Cell,
        /// The characters.
        text: Text<'a>,
    },
    /// 49h: shows a stored text.
    ShowText(TextNumber),
    /// 4Ah: stores an area in the unit.
    DefineArea {
        /// Its number.
        number: AreaNumber,
        /// Its cells.
        rect: Rect,
    },
    /// 4Bh: clears a stored area.
    ClearArea(AreaNumber),
    /// 4Ch: shows a stored area inverse.
    InverseArea(AreaNumber),
    /// 4Dh: flashes a stored area.
    FlashArea(AreaNumber),
    /// 4Eh: shows a stored area inverse and flashing.
    InverseFlashArea(AreaNumber),
    /// 4Fh: shows a stored area as it was.
    NormalArea(AreaNumber),
}

impl LcdCommand<'_> {
    /// Characters of a text that the unit stores, at most.
    pub const MAX_TEXT: usize = MAX_TEXT;
}

impl Rect {
    /// Checks that no corner lies above or left of the other.
    fn check(self) -> Result<Self, LcdError> {
        let Self { start, end } = self;
        if end.line < start.line || end.column < start.column {
            return Err(LcdError::Corners { rect: self });
        }
        Ok(self)
    }
}
