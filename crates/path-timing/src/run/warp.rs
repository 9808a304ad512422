//! Changes of the feed with limited jerk.

use super::is_rest;
use crate::demand::Demand;
use crate::reciprocals::Reciprocals;
use crate::rows::{Node, Nodes};
use crate::{Legs, Row};

/// A change of the feed over the segments up to a later row: smooth in time, slow where the feed is
/// high, for there the table leaves little of the jerk.
///
/// ```text
/// f = f₀ + (f₁ - f₀) g(x)        x = t / T
/// g = xⁿ (n + 1 - n x)           to a lower feed;  1 - g(1 - x) to a higher one
/// ```
///
/// The integral of f is the table's own time. A stop ends, and a start begins, without a step of the
/// acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Warp {
    from: f64,
    pub(super) to: f64,
    shape: Shape,
    /// T.
    duration_s: f64,
    /// x and the table's time at the row handed out last.
    x: f64,
    table_s: f64,
    /// Segments to go.
    pub(super) left: u32,
}

/// n.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shape {
    /// 2, the same from both ends.
    Even,
    /// 4.
    Late,
}

impl Shape {
    const ALL: [Self; 2] = [Self::Even, Self::Late];

    /// g and its integral from 0.
    fn values(self, x: f64) -> [f64; 2] {
        let square = x * x;
        let (power, n) = match self {
            Self::Even => (square, 2.0),
            Self::Late => (square * square, 4.0),
        };
        [
            power * (n + 1.0 - n * x),
            power * x * (1.0 - n * x / (n + 2.0)),
        ]
    }
}

/// Halvings that find x to its last digit.
const ROUNDS: u32 = 60;

impl Warp {
    /// The change over a number of segments that take `table_s` at a feed of 1.
    fn new([from, to]: [f64; 2], shape: Shape, segments: u32, table_s: f64) -> Self {
        let mut warp = Self {
            from,
            to,
            shape,
            duration_s: 1.0,
            x: 0.0,
            table_s: 0.0,
            left: segments,
        };
        let [_, mean] = warp.values(1.0);
        warp.duration_s = table_s / mean;
        warp
    }

    /// The feed, and its integral from 0 by x.
    fn values(&self, x: f64) -> [f64; 2] {
        let [g, integral] = if self.to < self.from {
            self.shape.values(x)
        } else {
            let [[_, whole], [g, rest]] = [1.0, 1.0 - x].map(|x| self.shape.values(x));
            [1.0 - g, x - (whole - rest)]
        };
        let change = self.to - self.from;
        [self.from + change * g, self.from * x + change * integral]
    }

    /// x at a time of the table: the integral grows.
    fn position(&self, table_s: f64) -> f64 {
        let wanted = table_s / self.duration_s;
        let (mut low, mut high) = (self.x, 1.0);
        for _ in 0..ROUNDS {
            let x = (low + high) * 0.5;
            let [_, reached] = self.values(x);
            if reached < wanted {
                low = x;
            } else {
                high = x;
            }
        }
        high
    }

    /// The feed at the next row, and the time to it, over a segment that takes `table_s` at 1.
    pub(super) fn step(&mut self, table_s: f64) -> (f64, f64) {
        self.left = self.left.saturating_sub(1);
        self.table_s += table_s;
        let before = self.x;
        if self.left == 0 {
            self.x = 1.0;
            return (self.to, (1.0 - before) * self.duration_s);
        }
        self.x = self.position(self.table_s);
        let [feed, _] = self.values(self.x);
        (feed, (self.x - before) * self.duration_s)
    }
}

/// Where a change of the feed begins: a row and the motion that led there.
#[derive(Debug)]
pub(super) struct Start<'r, 'a, L: Legs> {
    pub(super) limits: &'r Reciprocals<L::Axes>,
    /// The motion up to the row.
    pub(super) demand: &'r Demand<L::Axes>,
    pub(super) feed: f64,
    /// The row handed out last and those that have been fetched after it.
    pub(super) fetched: [Option<Node<L::Axes>>; 3],
    /// Those after them.
    pub(super) nodes: &'r Nodes<'a, L>,
}

/// What became of a trial.
enum Trial {
    Holds(Warp),
    /// A limit is passed.
    Fails,
    /// The path comes to rest before.
    TooLong(u32),
}

/// The number of segments to try next, by half as many more.
fn longer(segments: u32) -> u32 {
    segments.saturating_add(segments.div_ceil(2))
}

/// Halvings of a feed that nothing moves at.
const HALVINGS: u32 = 64;

impl<L: Legs> Start<'_, '_, L> {
    /// The shortest change to another feed, of those over 1, 2, 3, 5, 8 .. segments, that keeps all
    /// limits and can be followed by a constant feed.
    pub(super) fn change(&self, to: f64) -> Result<Option<Warp>, L::Error> {
        let mut segments = 1_u32;
        loop {
            match self.trial(to, segments)? {
                Trial::Holds(warp) => return Ok(Some(warp)),
                Trial::Fails => segments = longer(segments),
                Trial::TooLong(_) => return Ok(None),
            }
        }
    }

    /// The same from rest, where there must be one: where the path is too short for the feed, the
    /// one that ends with it, of the highest feed of halves of it.
    pub(super) fn resume(&self, to: f64) -> Result<Option<Warp>, L::Error> {
        let mut feed = to;
        for _ in 0..HALVINGS {
            let mut segments = 1_u32;
            loop {
                match self.trial(feed, segments)? {
                    Trial::Holds(warp) => return Ok(Some(warp)),
                    Trial::Fails => segments = longer(segments),
                    Trial::TooLong(available) => {
                        if let Trial::Holds(warp) = self.trial(feed, available)? {
                            return Ok(Some(warp));
                        }
                        break;
                    }
                }
            }
            feed *= 0.5;
        }
        Ok(None)
    }

    fn trial(&self, to: f64, segments: u32) -> Result<Trial, L::Error> {
        let mut table_s = 0.0;
        let mut ahead = self.ahead();
        for number in 0..segments {
            let Some(node) = ahead.next()? else {
                return Ok(Trial::TooLong(number));
            };
            if number > 0 && is_rest(&node.point) {
                return Ok(Trial::TooLong(number));
            }
            table_s += node.duration_s;
        }
        for shape in Shape::ALL {
            let warp = Warp::new([self.feed, to], shape, segments, table_s);
            if self.holds(warp)? {
                return Ok(Trial::Holds(warp));
            }
        }
        Ok(Trial::Fails)
    }

    /// Whether the rows of a change, and the first after it, keep all limits.
    fn holds(&self, mut warp: Warp) -> Result<bool, L::Error> {
        let last = warp;
        let mut demand = self.demand.fresh();
        let mut ahead = self.ahead();
        let Some(mut node) = ahead.next()? else {
            return Ok(false);
        };
        let mut from = Row::new(&node.point, self.feed, 0.0, 0.0);
        while warp.left > 0 {
            let (feed, duration_s) = warp.step(node.duration_s);
            let Some(next) = ahead.next()? else {
                return Ok(false);
            };
            let to = Row::new(&next.point, feed, 0.0, duration_s);
            demand.add(self.limits, &from, &to);
            // Written so that NaN does not hold.
            let holds = demand.stretch() <= 1.0;
            if !holds {
                return Ok(false);
            }
            (node, from) = (next, to);
        }
        if last.to <= 0.0 || is_rest(&node.point) {
            demand.stop(self.limits);
        } else if let Some(next) = ahead.next()? {
            let duration_s = node.duration_s / last.to;
            let to = Row::new(&next.point, last.to, 0.0, duration_s);
            demand.add(self.limits, &from, &to);
        }
        Ok(demand.stretch() <= 1.0)
    }

    fn ahead(&self) -> Ahead<'_, L> {
        Ahead {
            fetched: self.fetched.into_iter().flatten(),
            nodes: self.nodes.clone(),
        }
    }
}

/// The rows from the one handed out last on.
struct Ahead<'a, L: Legs> {
    fetched: core::iter::Flatten<core::array::IntoIter<Option<Node<L::Axes>>, 3>>,
    nodes: Nodes<'a, L>,
}

impl<L: Legs> Ahead<'_, L> {
    fn next(&mut self) -> Result<Option<Node<L::Axes>>, L::Error> {
        match self.fetched.next() {
            Some(node) => Ok(Some(node)),
            None => self.nodes.next(),
        }
    }
}
