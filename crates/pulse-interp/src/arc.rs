//! Arcs about a centre on the grid.

mod circle;
mod geometry;
mod moves;
mod steps;

pub use moves::ArcMoves;
pub use steps::ArcSteps;

use crate::{Rule, Turn};
use core::cmp::Ordering;
use core::f64::consts::TAU;
use geometry::Sweep;
use thiserror::Error;
use trig_kernels::{atan2, sqrt};

/// Why an arc is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ArcError {
    /// The start is the centre.
    #[error("the start is at the centre: no radius")]
    NoRadius,
    /// The end is the centre, from where no direction is the arc's.
    #[error("the end is at the centre")]
    EndAtCentre,
    /// A radius above 2^30 steps.
    #[error("start ({}, {}): the radius is above {limit} steps", start[0], start[1])]
    RadiusTooLarge {
        /// The start, in steps from the centre.
        start: [i32; 2],
        /// The largest radius, in steps.
        limit: u32,
    },
    /// The end is not on the circle about the centre through the start.
    #[error(
        "end ({}, {}): {off_millisteps} thousandths of a step outside the circle, \
         {tolerance_millisteps} allowed either way",
        end[0], end[1]
    )]
    EndOffCircle {
        /// The end, in steps from the centre.
        end: [i32; 2],
        /// How far the end is from the circle, in thousandths of a step, rounded away from 0;
        /// negative inside.
        off_millisteps: i64,
        /// What was allowed, in thousandths of a step.
        tolerance_millisteps: u32,
    },
}

/// An arc about a centre on the grid; start and end are points in steps from the centre.
///
/// ```text
/// F = x² + y² - R²,   R² = xs² + ys²
/// ```
/// The radius is that of the start, up to 2^30 steps, and need not be whole. Start = end is the
/// full circle. In each quadrant one axis leads inward, the other outward; a point on an axis
/// belongs to the quadrant which the motion enters. Source: \[Stage\].
///
/// The end is always met, and after a known number of steps. Where it is on the circle, the rule
/// alone leads there. Where it is merely near, an axis that has reached its end coordinate stands
/// still while the other goes on, and an end which both have passed is stepped back to.
///
/// # Examples
/// ```
/// use pulse_interp::{Arc, Move, Rule, Turn};
/// use Move::{Left, Up};
/// let quarter = Arc::new([4, 0], [0, 4], Turn::CounterClockwise)?;
/// let steps = quarter.steps(Rule::Published);
/// assert!(steps.eq([Left, Up, Up, Up, Left, Up, Left, Left]));
/// # Ok::<(), pulse_interp::ArcError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Arc {
    start: [i32; 2],
    end: [i32; 2],
    turn: Turn,
    // At most 2^60.
    radius_squared: u64,
}

impl Arc {
    /// The largest radius, in steps.
    pub const MAX_RADIUS: u32 = 1 << 30;

    /// The arc from `start` to an `end` exactly on the same circle.
    ///
    /// # Errors
    /// [`ArcError`]; [`ArcError::EndOffCircle`] for any other end.
    pub fn new(start: [i32; 2], end: [i32; 2], turn: Turn) -> Result<Self, ArcError> {
        Self::near(start, end, turn, 0)
    }

    /// The arc from `start` to an `end` that is at most `tolerance_millisteps` thousandths of a
    /// step off the circle, as ends are that were rounded to whole steps.
    ///
    /// The path leaves the circle by no more than rule and end do.
    ///
    /// # Errors
    /// [`ArcError`].
    pub fn near(
        start: [i32; 2],
        end: [i32; 2],
        turn: Turn,
        tolerance_millisteps: u32,
    ) -> Result<Self, ArcError> {
        let radius_squared = square(start);
        if radius_squared == 0 {
            return Err(ArcError::NoRadius);
        }
        if radius_squared > 1 << 60 {
            return Err(ArcError::RadiusTooLarge {
                start,
                limit: Self::MAX_RADIUS,
            });
        }
        let end_squared = square(end);
        if end_squared == 0 {
            return Err(ArcError::EndAtCentre);
        }
        let off_millisteps = off_millisteps(radius_squared, end_squared);
        if off_millisteps.unsigned_abs() > u64::from(tolerance_millisteps) {
            return Err(ArcError::EndOffCircle {
                end,
                off_millisteps,
                tolerance_millisteps,
            });
        }
        Ok(Self {
            start,
            end,
            turn,
            radius_squared,
        })
    }

    /// The start, in steps from the centre.
    #[must_use]
    pub const fn start(&self) -> [i32; 2] {
        self.start
    }

    /// The end, in steps from the centre.
    #[must_use]
    pub const fn end(&self) -> [i32; 2] {
        self.end
    }

    /// The direction around the centre.
    #[must_use]
    pub const fn turn(&self) -> Turn {
        self.turn
    }

    /// R², in steps².
    #[must_use]
    pub const fn radius_squared(&self) -> u64 {
        self.radius_squared
    }

    /// The length of the arc on its circle, in steps, rounded up: what a ramp along it takes.
    ///
    /// ```text
    /// R φ,   φ = atan2(x ye - y xe, x xe + y ye) counter-clockwise, 0 < φ <= 2π
    /// ```
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "53 bits of products below 2^63; a length below 2^33"
    )]
    #[must_use]
    pub fn length(&self) -> u64 {
        let [x, y] = self.start.map(i64::from);
        let [xe, ye] = self.end.map(i64::from);
        // Below 2^30 · 2^31 each.
        let cross = x.wrapping_mul(ye).wrapping_sub(y.wrapping_mul(xe));
        let dot = x.wrapping_mul(xe).wrapping_add(y.wrapping_mul(ye));
        let across = match self.turn {
            Turn::CounterClockwise => cross,
            Turn::Clockwise => cross.wrapping_neg(),
        };
        let angle = atan2(across as f64, dot as f64);
        let angle = if across < 0 || (across == 0 && dot > 0) {
            angle + TAU
        } else {
            angle
        };
        let length = sqrt(self.radius_squared as f64) * angle;
        let down = length as u64;
        down.wrapping_add(u64::from((down as f64) < length))
    }

    /// The arc as single steps of one axis: in each quadrant as many as |dx| + |dy|, a full circle
    /// of whole radius 8 R.
    ///
    /// At most 1 step off the circle by [`Rule::Published`], 0.7072 by [`Rule::Nearest`].
    pub fn steps(&self, rule: Rule) -> ArcSteps {
        ArcSteps::new(self, &self.sweep(), rule)
    }

    /// The arc as moves to any of eight neighbours: the midpoint arc.
    ///
    /// At most half a step off the circle.
    pub fn moves(&self) -> ArcMoves {
        ArcMoves::new(self, &self.sweep())
    }

    fn sweep(&self) -> Sweep {
        Sweep::new(self.start, self.end, self.turn)
    }
}

/// At most 2^63.
fn square(point: [i32; 2]) -> u64 {
    let [x, y] = point.map(|c| u64::from(c.unsigned_abs()));
    x.wrapping_mul(x).wrapping_add(y.wrapping_mul(y))
}

/// sqrt(end) - sqrt(radius) in thousandths, rounded away from 0; 0 only for equals.
fn off_millisteps(radius_squared: u64, end_squared: u64) -> i64 {
    // In millionths, of which each root loses less than one: 63 bits and 40 make 103.
    const SQUARE: u128 = 1_000_000_000_000;
    let root = |square: u64| u128::from(square).wrapping_mul(SQUARE).isqrt();
    let (end, radius) = (root(end_squared), root(radius_squared));
    let off = i64::try_from(end.abs_diff(radius).div_ceil(1000).max(1)).unwrap_or(i64::MAX);
    match end_squared.cmp(&radius_squared) {
        Ordering::Less => off.wrapping_neg(),
        Ordering::Equal => 0,
        Ordering::Greater => off,
    }
}
