//! What the display shows.

use core::fmt;

use handwheel::{Cell, Column, LcdBlock, LcdCommand, Line, Model, Text};

/// Lines of the display. Printed for the HBAS (small font); the HBLS is taken to have as many.
pub(crate) const LINES: usize = 8;
/// Characters of a line.
pub(crate) const COLUMNS: usize = 16;

/// Bytes of a goto before the characters.
const GOTO: usize = 3;

/// A full display of printable ASCII.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Screen {
    lines: [[u8; COLUMNS]; LINES],
}

impl Screen {
    /// Spaces everywhere.
    pub const BLANK: Self = Self {
        lines: [[b' '; COLUMNS]; LINES],
    };

    /// The lines from the top, 16 characters each.
    #[must_use]
    pub fn lines(&self) -> impl ExactSizeIterator<Item = &str> {
        self.lines
            .iter()
            .map(|line| core::str::from_utf8(line).unwrap_or_default())
    }

    /// Writes from `column` on; what does not fit on the line is cut off, anything but printable
    /// ASCII becomes `?`.
    pub fn put(&mut self, line: usize, column: usize, text: &str) {
        let line = self.lines.get_mut(line).into_iter().flatten();
        for (to, byte) in line.skip(column).zip(text.bytes()) {
            let is_printable = matches!(byte, b' '..=b'~');
            *to = if is_printable { byte } else { b'?' };
        }
    }

    /// Writes a decimal that ends before `end`, with `decimals` of its digits after the point;
    /// stars where `width` is too small.
    pub(crate) fn put_number(&mut self, line: usize, end: usize, width: usize, value: Decimal) {
        let Some(cells) = self.lines.get_mut(line) else {
            return;
        };
        let Some(cells) = cells.get_mut(end.saturating_sub(width)..end) else {
            return;
        };
        if value.fill(cells).is_none() {
            cells.fill(b'*');
        }
    }
}

/// A number with a fixed count of decimals.
#[derive(Clone, Copy)]
pub(crate) struct Decimal {
    pub(crate) value: i32,
    pub(crate) decimals: u8,
    /// A plus before what is not negative.
    pub(crate) signed: bool,
}

impl Decimal {
    /// Right-aligned; `None` when it does not fit.
    fn fill(self, cells: &mut [u8]) -> Option<()> {
        let mut rest = self.value.unsigned_abs();
        let mut places = cells.iter_mut().rev();
        let mut written = 0_u8;
        while rest > 0 || written <= self.decimals {
            if written == self.decimals && written > 0 {
                *places.next()? = b'.';
            }
            let digit = u8::try_from(rest % 10).ok()?;
            *places.next()? = b'0'.wrapping_add(digit);
            rest /= 10;
            written = written.saturating_add(1);
        }
        if self.value < 0 {
            *places.next()? = b'-';
        } else if self.signed {
            *places.next()? = b'+';
        }
        places.for_each(|cell| *cell = b' ');
        Some(())
    }
}

impl fmt::Debug for Screen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.lines()).finish()
    }
}

/// One line per row, each ended by a line feed.
impl fmt::Display for Screen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.lines().try_for_each(|line| writeln!(f, "{line}"))
    }
}

/// What a pendant is known to show; makes the blocks that change it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// 0 where it is not known.
    cells: [[u8; COLUMNS]; LINES],
}

impl Default for Shown {
    fn default() -> Self {
        Self::UNKNOWN
    }
}

impl Shown {
    /// Nothing is known: after power-on, and after a block that failed.
    pub const UNKNOWN: Self = Self {
        cells: [[0; COLUMNS]; LINES],
    };

    /// The block that brings the display towards `screen`, `None` when it shows it already. One
    /// block may not reach: ask again when it has been answered.
    #[must_use]
    pub fn update(&mut self, screen: &Screen, model: Model) -> Option<LcdBlock> {
        let mut block = LcdBlock::new(model);
        for (line, (shown, wanted)) in (0..).zip(self.cells.iter_mut().zip(&screen.lines)) {
            let differs = |column: &usize| shown.get(*column) != wanted.get(*column);
            let Some(first) = (0..COLUMNS).find(differs) else {
                continue;
            };
            let last = (0..COLUMNS).rfind(differs).unwrap_or(first);
            let span = first..last.saturating_add(1);
            let (Some(from), Some(to)) = (wanted.get(span.clone()), shown.get_mut(span)) else {
                continue;
            };
            if block.room() < GOTO.saturating_add(from.len()) {
                break;
            }
            push(&mut block, line, first, from)?;
            to.copy_from_slice(from);
        }
        (!block.is_empty()).then_some(block)
    }
}

/// A screen has nothing but lines, columns and characters that exist: never `None`.
fn push(block: &mut LcdBlock, line: u8, column: usize, bytes: &[u8]) -> Option<()> {
    let line = Line::new(line).ok()?;
    let column = Column::new(u8::try_from(column).ok()?).ok()?;
    let text = Text::from_ascii(bytes).ok()?;
    block.push(LcdCommand::Goto(Cell { line, column })).ok()?;
    block.push(LcdCommand::Text(text)).ok()
}
