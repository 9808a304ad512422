//! A segment of a table and where on its path it is.

use crate::{Axes, Row};

/// A segment of a table: from one row to the next on the same leg, every axis running the
/// [`Cubic`](crate::Cubic) between them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "both ends of a segment")]
pub struct Span<A: Axes> {
    /// Parameter of the path at both ends.
    pub s: [f64; 2],
    /// The rows at both ends.
    pub rows: [Row<A>; 2],
}
