//! What is passed at a feed, and where on it the machine is.

use super::change::Change;
use super::phases::State;
use crate::knot::ToolTimes;
use crate::passes::{rest_to_rest_s, segment_s, time_of};
use crate::reciprocals::Reciprocals;
use crate::stepping::leads_to_rest;
use crate::{Axes, Knot};

/// Knots that are passed at a feed times their speeds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Course<'a, A: Axes> {
    pub(crate) knots: &'a [Knot<A>],
    pub(crate) limits: &'a Reciprocals<A>,
    /// By what all times are multiplied.
    pub(crate) stretch: f64,
    /// The highest feed that there may be.
    pub(crate) max_feed: f64,
}

/// Where the machine is on a course.
#[derive(Debug, Clone, Copy)]
pub(crate) struct At {
    /// The knot.
    pub(crate) index: usize,
    pub(crate) speed: f64,
    /// At the knot before.
    pub(crate) before: f64,
}

/// How many times the time from rest a segment to a rest may take.
const SLOW: f64 = 4.0;

impl At {
    /// The knot where a change ends that begins here.
    pub(super) const fn end_of(&self, change: &Change) -> usize {
        self.index.saturating_add(change.left)
    }
}

impl<A: Axes> Course<'_, A> {
    /// What is asked of the tool at the highest feed.
    pub(super) fn tool_times(&self) -> ToolTimes {
        ToolTimes::of_motion(self.max_feed / self.stretch)
    }

    /// The speed at a knot at a feed of 1.
    pub(super) fn planned(&self, index: usize) -> f64 {
        let knot = self.knots.get(index);
        knot.map_or(0.0, |knot| knot.speed / self.stretch)
    }

    /// Time of the table from the knot before.
    pub(super) fn segment_s(&self, index: usize) -> f64 {
        let before = index.checked_sub(1);
        let ends = (
            before.and_then(|before| self.knots.get(before)),
            self.knots.get(index),
        );
        match ends {
            (Some(from), Some(to)) => segment_s(from, to) * self.stretch,
            _ => 0.0,
        }
    }

    /// Whether the machine, held at a knot, is to rest at the next one, too.
    #[cold]
    #[inline(never)]
    pub(super) fn leads_to_rest(&self, at: At) -> bool {
        let ahead = self.knots.get(at.index..).unwrap_or_default();
        let [from, to, ..] = ahead else { return false };
        leads_to_rest(self.limits, [from, to], || self.tool_times())
    }

    /// Whether a rest at this knot is far sooner from a rest at the knot before than from a speed
    /// there: a window ended at that one when its speed was planned.
    #[cold]
    #[inline(never)]
    pub(super) fn crawls_to(&self, index: usize, speed: f64) -> bool {
        let before = index.checked_sub(1);
        let before = before.and_then(|before| self.knots.get(before));
        let (Some(from), Some(to)) = (before, self.knots.get(index)) else {
            return false;
        };
        let from_rest_s = rest_to_rest_s(self.limits, [from, to], &to.tool) * self.stretch;
        time_of(to.ds, [speed, 0.0]) > from_rest_s * SLOW
    }

    /// Speed and acceleration at a knot at a feed.
    pub(super) fn planned_state(&self, index: usize, feed: f64) -> State {
        let speed = feed * self.planned(index);
        if speed <= 0.0 {
            return State::REST;
        }
        self.state_between(At {
            index,
            speed,
            before: feed * self.planned(index.saturating_sub(1)),
        })
    }

    /// Speed and acceleration at a knot, the mean of those before and after it at a constant feed.
    pub(super) fn state_between(&self, at: At) -> State {
        let next = at.index.saturating_add(1);
        let feed = at.speed / self.planned(at.index);
        let after = At {
            index: next,
            speed: feed * self.planned(next),
            before: at.speed,
        };
        let [before, after] = [at, after].map(|at| self.state(at).acceleration);
        State {
            speed: at.speed,
            acceleration: (before + after) * 0.5,
        }
    }

    /// Speed and acceleration along the path.
    pub(super) fn state(&self, at: At) -> State {
        let ds = self.knots.get(at.index).map_or(0.0, |knot| knot.ds);
        let squares = at.speed * at.speed - at.before * at.before;
        State {
            speed: at.speed,
            acceleration: if ds > 0.0 { squares / (2.0 * ds) } else { 0.0 },
        }
    }
}
