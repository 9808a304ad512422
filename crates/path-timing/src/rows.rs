//! The rows of a table, computed from its knots.

use core::iter::FusedIterator;

use crate::leg::Leg;
use crate::{Axes, Knot, Legs, Place, Row, Table};

/// A knot as a place of its path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node<A: Axes> {
    /// Slopes by time: velocities.
    pub(crate) place: Place<A>,
    /// Time to the next node.
    pub(crate) duration_s: f64,
}

/// The knots of a table one after the other; the last of a leg and the first of the next are one.
#[derive(Debug, Clone)]
pub(crate) struct Nodes<'a, L: Legs> {
    /// Those that are still to come.
    legs: L,
    knots: &'a [Knot],
    /// The one that the next knot is on.
    leg: Option<Leg<L::Leg>>,
    stretch: f64,
}

impl<'a, L: Legs> Nodes<'a, L> {
    pub(crate) fn new(table: &Table<'a, L, L::Axes>) -> Self {
        let mut nodes = Self {
            legs: table.legs.clone(),
            knots: table.knots,
            leg: None,
            stretch: table.stretch,
        };
        nodes.begin();
        nodes
    }

    /// The leg that the next knot is on, from 0.
    pub(crate) fn leg(&self) -> usize {
        self.leg.as_ref().map_or(0, |leg| leg.number)
    }

    /// Begins the next leg.
    fn begin(&mut self) {
        let number = self
            .leg
            .as_ref()
            .map_or(0, |leg| leg.number.saturating_add(1));
        self.leg = self.legs.next().map(|path| Leg::new(number, path));
    }

    pub(crate) fn next(&mut self) -> Result<Option<Node<L::Axes>>, L::Error> {
        let (Some((knot, later)), Some(leg)) = (self.knots.split_first(), &self.leg) else {
            return Ok(None);
        };
        let mut place = leg.place(knot.s)?;
        let speed = knot.speed / self.stretch;
        place.slope = place.slope.scaled(speed);
        let mut duration_s = knot.duration_s;
        self.knots = later;
        if let (true, Some((first, rest))) = (knot.s >= 1.0, later.split_first()) {
            duration_s = first.duration_s;
            self.knots = rest;
            self.begin();
        }
        Ok(Some(Node {
            place,
            duration_s: duration_s * self.stretch,
        }))
    }
}

/// The rows of a [`Table`]. A row is an error only where the path refuses a place that it has
/// given while the table was planned.
#[derive(Debug, Clone)]
pub struct Rows<'a, L: Legs> {
    nodes: Nodes<'a, L>,
    time_s: f64,
    /// Of the segment before the next row.
    duration_s: f64,
    remaining: usize,
}

impl<'a, L: Legs> Rows<'a, L> {
    pub(crate) fn new(table: &Table<'a, L, L::Axes>) -> Self {
        Self {
            nodes: Nodes::new(table),
            time_s: 0.0,
            duration_s: 0.0,
            remaining: table.len(),
        }
    }

    /// The leg, from 0, on which the segment before the next row lies; past the last row 0.
    #[must_use]
    pub fn leg(&self) -> usize {
        self.nodes.leg()
    }
}

impl<L: Legs> Iterator for Rows<'_, L> {
    type Item = Result<Row<L::Axes>, L::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.remaining = self.remaining.checked_sub(1)?;
        let node = match self.nodes.next() {
            Ok(node) => node?,
            Err(error) => return Some(Err(error)),
        };
        self.time_s += self.duration_s;
        let row = Row {
            time_s: self.time_s,
            duration_s: self.duration_s,
            position: node.place.position,
            velocity: node.place.slope,
        };
        self.duration_s = node.duration_s;
        Some(Ok(row))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.remaining, Some(self.remaining))
    }
}

impl<L: Legs> ExactSizeIterator for Rows<'_, L> {}

impl<L: Legs> FusedIterator for Rows<'_, L> {}
