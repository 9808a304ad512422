//! The rows of a table, computed from its knots.

use core::iter::FusedIterator;

use crate::passes::segment_s;
use crate::{Axes, Knot, Row};

/// The rows of a [`Table`](crate::Table).
#[derive(Debug, Clone)]
pub struct Rows<'a, A: Axes> {
    /// Those that are still to come.
    knots: &'a [Knot<A>],
    before: Option<&'a Knot<A>>,
    stretch: f64,
    time_s: f64,
    leg: usize,
}

impl<'a, A: Axes> Rows<'a, A> {
    /// With all times multiplied.
    pub(crate) const fn new(knots: &'a [Knot<A>], stretch: f64) -> Self {
        Self {
            knots,
            before: None,
            stretch,
            time_s: 0.0,
            leg: 0,
        }
    }
}

impl<A: Axes> Iterator for Rows<'_, A> {
    type Item = Row<A>;

    fn next(&mut self) -> Option<Row<A>> {
        let (knot, later) = self.knots.split_first()?;
        let mut duration_s = 0.0;
        if let Some(before) = self.before {
            duration_s = segment_s(before, knot) * self.stretch;
            self.leg = self.leg.saturating_add(usize::from(before.ends_leg));
        }
        self.time_s += duration_s;
        (self.knots, self.before) = (later, Some(knot));
        Some(Row {
            time_s: self.time_s,
            duration_s,
            leg: self.leg,
            ..knot.row(knot.speed / self.stretch)
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.knots.len(), Some(self.knots.len()))
    }
}

impl<A: Axes> ExactSizeIterator for Rows<'_, A> {}

impl<A: Axes> FusedIterator for Rows<'_, A> {}
