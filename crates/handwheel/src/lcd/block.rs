//! Writing display commands.

use core::fmt;

use super::commands::{TEXT_END, ZERO};
use super::{Font, LcdCommand, LcdCommands};
use crate::cells::{Cell, Rect};
use crate::error::LcdError;
use crate::report::{LCD, MAX_COMMAND, Model};
use crate::text::Text;

/// One telegram of display commands, built up command by command.
///
/// Memory: 144 bytes at most.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct LcdBlock {
    model: Model,
    /// At most [`MAX_COMMAND`], 135.
    len: u8,
    bytes: [u8; MAX_COMMAND],
}

impl LcdBlock {
    /// A block without commands: the 6Ch alone.
    #[must_use]
    pub const fn new(model: Model) -> Self {
        let mut bytes = [0; MAX_COMMAND];
        bytes[0] = LCD;
        Self {
            model,
            len: 1,
            bytes,
        }
    }

    /// The unit it is for.
    pub(crate) const fn model(&self) -> Model {
        self.model
    }

    /// Whether it has no command.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len <= 1
    }

    /// The telegram, 6Ch and all commands.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.len.into()).unwrap_or_default()
    }

    /// The commands, read back.
    #[must_use]
    pub fn commands(&self) -> LcdCommands<'_> {
        LcdCommands::new(self.model, self.as_bytes().get(1..).unwrap_or_default())
    }

    /// Bytes that still fit.
    #[must_use]
    pub fn room(&self) -> usize {
        self.model.max_lcd_block().saturating_sub(self.len.into())
    }

    /// Appends a command.
    ///
    /// # Errors
    /// [`LcdError`]; the block is then as it was.
    pub fn push(&mut self, command: LcdCommand<'_>) -> Result<(), LcdError> {
        let mut next = *self;
        next.write(command)?;
        *self = next;
        Ok(())
    }

    fn write(&mut self, command: LcdCommand<'_>) -> Result<(), LcdError> {
        match command {
            LcdCommand::Text(text) => self.text(text),
            LcdCommand::Next => self.bytes(&[0x21]),
            LcdCommand::Previous => self.bytes(&[0x22]),
            LcdCommand::Down => self.bytes(&[0x23]),
            LcdCommand::Up => self.bytes(&[0x24]),
            LcdCommand::Home => self.bytes(&[0x25]),
            LcdCommand::LineStart => self.bytes(&[0x26]),
            LcdCommand::Goto(cell) => {
                self.bytes(&[0x27])?;
                self.cell(cell)
            }
            LcdCommand::Delete => self.bytes(&[0x28]),
            LcdCommand::DeleteToLineEnd => self.bytes(&[0x29]),
            LcdCommand::DeleteToDisplayEnd => self.bytes(&[0x2A]),
            LcdCommand::DeleteAll => self.bytes(&[0x2B]),
            LcdCommand::DeleteRect(rect) => {
                self.bytes(&[0x2C])?;
                self.rect(rect)
            }
            LcdCommand::Inverse(on) => self.bytes(&[if on { 0x40 } else { 0x41 }]),
            LcdCommand::Flash(on) => self.bytes(&[if on { 0x42 } else { 0x43 }]),
            LcdCommand::DefineText {
                number,
                font,
                cell,
                text,
            } => {
                let len = text.len();
                if len > LcdCommand::MAX_TEXT {
                    return Err(LcdError::TextTooLong { len });
                }
                self.bytes(&[0x48, number.code(ZERO)])?;
                self.font(font)?;
                self.cell(cell)?;
                self.text(text)?;
                match self.model {
                    Model::Hbls => self.bytes(&[TEXT_END]),
                    Model::Hbas => Ok(()),
                }
            }
            LcdCommand::ShowText(number) => self.bytes(&[0x49, number.code(ZERO)]),
            LcdCommand::DefineArea { number, rect } => {
                self.bytes(&[0x4A, number.code(ZERO)])?;
                self.rect(rect)
            }
            LcdCommand::ClearArea(number) => self.bytes(&[0x4B, number.code(ZERO)]),
            LcdCommand::InverseArea(number) => self.bytes(&[0x4C, number.code(ZERO)]),
            LcdCommand::FlashArea(number) => self.bytes(&[0x4D, number.code(ZERO)]),
            LcdCommand::InverseFlashArea(number) => self.bytes(&[0x4E, number.code(ZERO)]),
            LcdCommand::NormalArea(number) => self.bytes(&[0x4F, number.code(ZERO)]),
        }
    }

    fn font(&mut self, font: Option<Font>) -> Result<(), LcdError> {
        match (self.model, font) {
            (Model::Hbls, None) => Ok(()),
            (Model::Hbas, Some(Font::Small)) => self.bytes(&[0x50]),
            (Model::Hbas, Some(Font::Large)) => self.bytes(&[0x51]),
            (model, _) => Err(LcdError::Font { model }),
        }
    }

    fn cell(&mut self, cell: Cell) -> Result<(), LcdError> {
        self.bytes(&[cell.line.code(ZERO), cell.column.code(ZERO)])
    }

    fn rect(&mut self, rect: Rect) -> Result<(), LcdError> {
        let Rect { start, end } = rect.check()?;
        self.cell(start)?;
        self.cell(end)
    }

    fn bytes(&mut self, bytes: &[u8]) -> Result<(), LcdError> {
        self.extend(bytes.iter().copied())
    }

    fn text(&mut self, text: Text<'_>) -> Result<(), LcdError> {
        self.extend(text.codes())
    }

    fn extend(&mut self, bytes: impl ExactSizeIterator<Item = u8>) -> Result<(), LcdError> {
        let max = self.model.max_lcd_block();
        let from = usize::from(self.len);
        let len = from.saturating_add(bytes.len());
        let full = LcdError::Full { len, max };
        let free = self.bytes.get_mut(from..len).ok_or(full)?;
        if len > max {
            return Err(full);
        }
        for (to, byte) in free.iter_mut().zip(bytes) {
            *to = byte;
        }
        self.len = u8::try_from(len).map_err(|_| full)?;
        Ok(())
    }
}

impl fmt::Debug for LcdBlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.commands()).finish()
    }
}
