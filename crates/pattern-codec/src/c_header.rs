//! C headers that the firmware compiles in: tables of numbers for C51 and SDCC, written and read
//! without heap.
//!
//! What is written stands in [`dance::DataHeader`](crate::dance::DataHeader),
//! [`engraving::PatternHeader`](crate::engraving::PatternHeader) and
//! [`engraving::ReloadHeader`](crate::engraving::ReloadHeader). All of them have a comment with the
//! totals, an include guard, `#define`s that say how to read the table, and the table in `code`
//! memory.
//!
//! [`items`] is the reader below them: an iterator over the text of a header, also of one that was
//! written by hand.
//!
//! | in the text | read as |
//! |---|---|
//! | `/* */`, `//`, blanks, line ends of any kind, `\` at the end of a line | nothing |
//! | `#define NAME 12`, `#define NAME (-0x0C)` | [`Item::Define`] |
//! | any other directive | nothing: both branches of an `#if` are read |
//! | `... name[8] = {`, `... name[][8] = {` | [`Item::Array`], its words in any order |
//! | a number in an array: decimal, `0x`, `0b`, octal with a leading 0; sign, `U` and `L`, round brackets | [`Item::Value`] |
//! | `{` and `}` around a row of `name[][8]` | nothing; the row must have its 8 values |
//! | `}` after the values | [`Item::End`]; a declared length must be met |
//! | another declaration: a function, a structure, a variable | nothing |
//!
//! Every error names line and column, both counted from 1; a column is one character.

mod error;
mod items;
mod read;
mod scan;
mod style;
mod write;
mod write_error;

pub use error::{HeaderError, HeaderErrorKind, Location};
pub use items::{Item, items};
pub use style::Dialect;
pub use write_error::WriteError;

pub(crate) use read::{ArrayValues, BYTE, Bytes, Checked, Source, WORD};
pub(crate) use write::{Element, Layout, Table, Value};
