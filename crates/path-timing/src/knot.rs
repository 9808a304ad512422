//! A knot: a point of a path at which its speed is chosen.

use crate::junction::Junction;
use crate::{Axes, PathPoint, Row, ToolLimits};

/// Memory for one row: of a [`Table`](crate::Table) while it is planned and as long as it lives,
/// and of the window of a [`LookAhead`](crate::LookAhead).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot<A: Axes> {
    /// Positions, and slopes on arrival.
    pub(crate) point: PathPoint<A>,
    /// Parameter of its leg on arrival.
    pub(crate) s: f64,
    /// Length of the segment before, times its stretch κ; 0 where only the slopes are others than
    /// at the knot before.
    pub(crate) ds: f64,
    /// Limits of the tool on the segment before.
    pub(crate) tool: SegmentTool,
    /// Whether its leg ends here.
    pub(crate) ends_leg: bool,
    /// The highest speed of the parameter, by a corner: 0 at a stop.
    pub(crate) cap: f64,
    /// Speed of the parameter: the highest from which the rest can be run, then the one planned.
    pub(crate) speed: f64,
    /// Speed at the next knot that goes with the highest here, as a ratio.
    pub(crate) ratio: f64,
    /// The highest speed at a feed below the highest; in a table within torques, which has no other
    /// feed, its [`share`](Self::share).
    pub(crate) wanted: f64,
    /// The parameter at which it is to stand instead.
    pub(crate) moved_s: f64,
    /// With a limit of jerk: its row of the system that the speeds are found by.
    pub(crate) equation: Equation,
}

/// Limits of the tool on a segment, infinite where there are none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SegmentTool {
    /// Largest speed of the parameter.
    pub(crate) feed: f64,
    /// What the parameter may speed up by where the tool goes as far by it at both ends, r each:
    /// the tool's acceleration by r.
    pub(crate) acceleration: f64,
    /// How that changes: (r₁ - r₀) / (r₀ + r₁).
    pub(crate) change: f64,
}

impl SegmentTool {
    pub(crate) const NONE: Self = Self {
        feed: f64::INFINITY,
        acceleration: f64::INFINITY,
        change: 0.0,
    };

    /// Of a tool that goes so far by the parameter at both ends.
    pub(crate) fn new(tool: &ToolLimits, rates: impl FnOnce() -> [f64; 2]) -> Self {
        let none = Self {
            feed: tool.feed,
            ..Self::NONE
        };
        let Some(acceleration) = tool.acceleration else {
            return none;
        };
        let [from, to] = rates();
        let sum = from + to;
        Self {
            acceleration: 2.0 * acceleration / sum,
            change: (to - from) / sum,
            ..none
        }
    }

    /// With both limits multiplied.
    pub(crate) fn times(self, times: ToolTimes) -> Self {
        Self {
            feed: self.feed * times.feed,
            acceleration: self.acceleration * times.acceleration,
            ..self
        }
    }

    pub(crate) fn is_none(&self) -> bool {
        self.feed >= f64::INFINITY
    }
}

/// By what the limits of a tool are multiplied.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ToolTimes {
    pub(crate) feed: f64,
    pub(crate) acceleration: f64,
}

impl ToolTimes {
    pub(crate) const ONE: Self = Self {
        feed: 1.0,
        acceleration: 1.0,
    };

    /// The feed alone.
    pub(crate) const fn of_feed(feed: f64) -> Self {
        Self { feed, ..Self::ONE }
    }

    /// Where the whole of a motion is so many times as fast, if that is more than once.
    pub(crate) fn of_motion(times: f64) -> Self {
        let feed = times.max(1.0);
        Self {
            feed,
            acceleration: feed * feed,
        }
    }
}

impl<A: Axes> Default for Knot<A> {
    fn default() -> Self {
        Self {
            point: PathPoint {
                position: A::zeros(),
                slope: A::zeros(),
            },
            s: 0.0,
            ds: 0.0,
            tool: SegmentTool::NONE,
            ends_leg: false,
            cap: f64::INFINITY,
            speed: 0.0,
            ratio: 0.0,
            wanted: 0.0,
            moved_s: 0.0,
            equation: Equation::default(),
        }
    }
}

impl<A: Axes> Knot<A> {
    /// A knot at which the machine begins.
    pub(crate) fn start(point: PathPoint<A>) -> Self {
        Self {
            point,
            cap: 0.0,
            ..Self::default()
        }
    }

    /// In a table within torques: the share of them that the segment before is planned with.
    pub(crate) const fn share(&self) -> f64 {
        self.wanted
    }

    pub(crate) const fn set_share(&mut self, share: f64) {
        self.wanted = share;
    }

    /// The parameter at which the segment after it begins.
    pub(crate) const fn next_start(&self) -> f64 {
        if self.ends_leg { 0.0 } else { self.s }
    }

    /// The knot passed at a speed of the parameter.
    pub(crate) fn row(&self, speed: f64) -> Row<A> {
        Row {
            time_s: 0.0,
            duration_s: 0.0,
            position: self.point.position,
            velocity: self.point.slope.scaled(speed),
            leg: 0,
            s: self.s,
        }
    }

    /// Joins the end of a leg to the next, which begins with the slopes `start`. The knot after it,
    /// where velocities jump.
    pub(crate) fn join(&mut self, junction: &Junction<A>, start: &PathPoint<A>) -> Option<Self> {
        match junction {
            Junction::Stop => self.cap = 0.0,
            Junction::Smooth(slope) => self.point.slope = *slope,
            Junction::Jump(speed) => {
                self.cap = *speed;
                return Some(Self {
                    cap: *speed,
                    ..Self::start(*start)
                });
            }
        }
        None
    }
}

/// A knot's row of the Newton system, whose matrix is symmetric with two diagonals on each side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Equation {
    /// The matrix at the knot; factorised, the pivot.
    pub(crate) diagonal: f64,
    /// The matrix beside it, towards the next two knots; factorised, those of the unit triangle.
    pub(crate) next: [f64; 2],
    /// The right side; solved, the step of the square of the speed.
    pub(crate) right: f64,
}
