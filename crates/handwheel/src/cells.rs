//! Places on the display.

use crate::number::{Column, Line};

/// A character cell of the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "a cell has these two, no more")]
pub struct Cell {
    /// From the top.
    pub line: Line,
    /// From the left.
    pub column: Column,
}

/// A rectangle of character cells, its corners included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "a rectangle has these two, no more"
)]
pub struct Rect {
    /// The upper left corner.
    pub start: Cell,
    /// The lower right corner.
    pub end: Cell,
}
