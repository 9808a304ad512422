//! Reading display commands.

use core::iter::FusedIterator;

use super::{Font, LcdCommand};
use crate::cells::{Cell, Rect};
use crate::error::LcdError;
use crate::number::{AreaNumber, Column, Line, NumberError, TextNumber};
use crate::report::Model;
use crate::text::Text;

/// Code of number, line and column 0.
pub(super) const ZERO: u8 = 0x30;
/// End of a stored text of the HBLS.
pub(super) const TEXT_END: u8 = 0x0A;

/// The commands of a display block, one after the other; an error ends them.
///
/// Characters that follow each other are one [`LcdCommand::Text`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LcdCommands<'a> {
    model: Model,
    /// Bytes of the block, the 6Ch included.
    len: usize,
    rest: &'a [u8],
}

impl<'a> LcdCommands<'a> {
    /// The commands after the 6Ch.
    pub(crate) const fn new(model: Model, bytes: &'a [u8]) -> Self {
        let len = bytes.len().saturating_add(1);
        Self {
            model,
            len,
            rest: bytes,
        }
    }

    /// The unit they are for.
    pub(crate) const fn model(&self) -> Model {
        self.model
    }

    /// The bytes that have not been read.
    #[must_use]
    pub const fn as_bytes(&self) -> &'a [u8] {
        self.rest
    }

    fn index(&self) -> usize {
        self.len.saturating_sub(self.rest.len())
    }

    fn byte(&mut self) -> Result<u8, LcdError> {
        let (&byte, rest) = self
            .rest
            .split_first()
            .ok_or(LcdError::Truncated { len: self.len })?;
        self.rest = rest;
        Ok(byte)
    }

    fn number<T>(&mut self, read: fn(u8, u8) -> Result<T, NumberError>) -> Result<T, LcdError> {
        let index = self.index();
        let byte = self.byte()?;
        read(byte, ZERO).map_err(|error| LcdError::Parameter { index, error })
    }

    fn text(&mut self) -> Text<'a> {
        let (text, rest) = Text::split_codes(self.rest);
        self.rest = rest;
        text
    }

    fn cell(&mut self) -> Result<Cell, LcdError> {
        let line = self.number(Line::from_code)?;
        let column = self.number(Column::from_code)?;
        Ok(Cell { line, column })
    }

    fn rect(&mut self) -> Result<Rect, LcdError> {
        let (start, end) = (self.cell()?, self.cell()?);
        Rect { start, end }.check()
    }

    fn font(&mut self) -> Result<Option<Font>, LcdError> {
        if self.model == Model::Hbls {
            return Ok(None);
        }
        let index = self.index();
        match self.byte()? {
            0x50 => Ok(Some(Font::Small)),
            0x51 => Ok(Some(Font::Large)),
            byte => Err(LcdError::NoCommand { index, byte }),
        }
    }

    fn define_text(&mut self) -> Result<LcdCommand<'a>, LcdError> {
        let number = self.number(TextNumber::from_code)?;
        let font = self.font()?;
        let cell = self.cell()?;
        let text = self.text();
        let len = text.len();
        if len > LcdCommand::MAX_TEXT {
            return Err(LcdError::TextTooLong { len });
        }
        if self.model == Model::Hbls {
            let index = self.index();
            let byte = self.byte()?;
            if byte != TEXT_END {
                return Err(LcdError::NoCommand { index, byte });
            }
        }
        Ok(LcdCommand::DefineText {
            number,
            font,
            cell,
            text,
        })
    }

    fn command(&mut self) -> Result<LcdCommand<'a>, LcdError> {
        let text = self.text();
        if !text.is_empty() {
            return Ok(LcdCommand::Text(text));
        }
        let index = self.index();
        let byte = self.byte()?;
        Ok(match byte {
            0x21 => LcdCommand::Next,
            0x22 => LcdCommand::Previous,
            0x23 => LcdCommand::Down,
            0x24 => LcdCommand::Up,
            0x25 => LcdCommand::Home,
            0x26 => LcdCommand::LineStart,
            0x27 => LcdCommand::Goto(self.cell()?),
            0x28 => LcdCommand::Delete,
            0x29 => LcdCommand::DeleteToLineEnd,
            0x2A => LcdCommand::DeleteToDisplayEnd,
            0x2B => LcdCommand::DeleteAll,
            0x2C => LcdCommand::DeleteRect(self.rect()?),
            0x40 | 0x41 => LcdCommand::Inverse(byte == 0x40),
            0x42 | 0x43 => LcdCommand::Flash(byte == 0x42),
            0x48 => self.define_text()?,
            0x49 => LcdCommand::ShowText(self.number(TextNumber::from_code)?),
            0x4A => LcdCommand::DefineArea {
                number: self.number(AreaNumber::from_code)?,
                rect: self.rect()?,
            },
            0x4B => LcdCommand::ClearArea(self.number(AreaNumber::from_code)?),
            0x4C => LcdCommand::InverseArea(self.number(AreaNumber::from_code)?),
            0x4D => LcdCommand::FlashArea(self.number(AreaNumber::from_code)?),
            0x4E => LcdCommand::InverseFlashArea(self.number(AreaNumber::from_code)?),
            0x4F => LcdCommand::NormalArea(self.number(AreaNumber::from_code)?),
            _ => return Err(LcdError::NoCommand { index, byte }),
        })
    }
}

impl<'a> Iterator for LcdCommands<'a> {
    type Item = Result<LcdCommand<'a>, LcdError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let command = self.command();
        if command.is_err() {
            self.rest = &[];
        }
        Some(command)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        // At least one command, or one error; at most one per byte.
        (usize::from(!self.rest.is_empty()), Some(self.rest.len()))
    }
}

impl FusedIterator for LcdCommands<'_> {}
