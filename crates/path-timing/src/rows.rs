//! The rows of a table, computed from its knots.

use core::iter::FusedIterator;

use crate::leg::Leg;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot, Legs, PathPoint, Row, Table};

/// A knot as a point of its path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node<A: Axes> {
    /// Slopes by time: velocities on arrival.
    pub(crate) point: PathPoint<A>,
    /// Velocities with which the next segment begins, where they jump.
    pub(crate) jump: Option<A>,
    /// Time to the next node.
    pub(crate) duration_s: f64,
}

impl<A: Axes> Node<A> {
    /// The start of the next segment.
    pub(crate) fn departure(&self) -> PathPoint<A> {
        let position = self.point.position;
        self.jump
            .map_or(self.point, |slope| PathPoint { position, slope })
    }
}

/// The knots of a table one after the other; the last of a leg and the first of the next are one.
#[derive(Debug, Clone)]
pub(crate) struct Nodes<'a, L: Legs> {
    /// Those that are still to come.
    legs: L,
    /// The one that the next knot is on.
    leg: Option<Leg<L::Leg>>,
    knots: &'a [Knot],
    limits: Reciprocals<L::Axes>,
    stretch: f64,
}

impl<'a, L: Legs> Nodes<'a, L> {
    pub(crate) fn new(table: &Table<'a, L, L::Axes>) -> Self {
        Self {
            legs: table.legs.clone(),
            leg: None,
            knots: table.knots,
            limits: table.limits,
            stretch: table.stretch,
        }
    }

    /// The leg that the next knot is on, from 0.
    pub(crate) fn leg(&self) -> usize {
        self.leg.as_ref().map_or(0, |leg| leg.number)
    }

    /// Begins the next leg.
    fn begin(&mut self) -> Result<(), L::Error> {
        let number = self
            .leg
            .as_ref()
            .map_or(0, |leg| leg.number.saturating_add(1));
        let path = self.legs.next();
        let next = self.legs.clone().next();
        let leg = path.map(|path| Leg::new(number, path, next.as_ref(), &self.limits));
        self.leg = leg.transpose()?;
        Ok(())
    }

    pub(crate) fn next(&mut self) -> Result<Option<Node<L::Axes>>, L::Error> {
        if self.leg.is_none() {
            self.begin()?;
        }
        let (Some((knot, later)), Some(leg)) = (self.knots.split_first(), &self.leg) else {
            return Ok(None);
        };
        let mut point = leg.point(knot.s)?;
        let speed = knot.speed / self.stretch;
        point.slope = point.slope.scaled(speed);
        let (mut duration_s, mut jump) = (knot.duration_s, None);
        self.knots = later;
        if let (true, Some((first, rest))) = (knot.s >= leg.length(), later.split_first()) {
            let jumps = leg.joint().is_jump();
            duration_s = first.duration_s;
            self.knots = rest;
            self.begin()?;
            if let (true, Some(leg)) = (jumps, &self.leg) {
                jump = Some(leg.point(0.0)?.slope.scaled(speed));
            }
        }
        Ok(Some(Node {
            point,
            jump,
            duration_s: duration_s * self.stretch,
        }))
    }
}

/// The rows of a [`Table`]. A row is an error only where the path refuses a point that it has
/// given while the table was planned.
#[derive(Debug, Clone)]
pub struct Rows<'a, L: Legs> {
    nodes: Nodes<'a, L>,
    /// The second row of a corner where velocities jump.
    jump: Option<Row<L::Axes>>,
    time_s: f64,
    /// Of the segment before the next row.
    duration_s: f64,
    remaining: usize,
}

impl<'a, L: Legs> Rows<'a, L> {
    pub(crate) fn new(table: &Table<'a, L, L::Axes>) -> Self {
        Self {
            nodes: Nodes::new(table),
            jump: None,
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
        if let Some(row) = self.jump.take() {
            return Some(Ok(row));
        }
        let node = match self.nodes.next() {
            Ok(node) => node?,
            Err(error) => return Some(Err(error)),
        };
        self.time_s += self.duration_s;
        let row = Row {
            time_s: self.time_s,
            duration_s: self.duration_s,
            position: node.point.position,
            velocity: node.point.slope,
        };
        self.duration_s = node.duration_s;
        self.jump = node.jump.map(|velocity| row.with_jump(velocity));
        Some(Ok(row))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.remaining, Some(self.remaining))
    }
}

impl<L: Legs> ExactSizeIterator for Rows<'_, L> {}

impl<L: Legs> FusedIterator for Rows<'_, L> {}
