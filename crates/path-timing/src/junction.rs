//! Junctions: how the machine goes on from one path to the next.

use crate::Axes;
use crate::number::SMALLEST;
use crate::reciprocals::Reciprocals;

/// How the machine goes on from a path to the next one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(
    clippy::exhaustive_enums,
    reason = "there is no fourth way round a corner"
)]
pub enum Corner<A> {
    /// It stops.
    #[default]
    Stop,
    /// It goes on at the same speed of the parameter where the slopes of all axes agree to nine
    /// digits, as those of a line and of a blend do; else it stops.
    Smooth,
    /// The velocity of each axis may jump by the speed given here, per second: what its motor
    /// starts and stops with, its start-stop speed.
    ///
    /// ```text
    /// w ≤ δᵢ / |p₁ᵢ - p₀ᵢ|
    /// ```
    ///
    /// w is the speed of the parameter, p₀ᵢ and p₁ᵢ are the slopes before and after the corner. With
    /// a limit of jerk that speed is constant on either side of the jump: an axis has only the
    /// acceleration there that its path's bend asks for at that speed, none along a line.
    Jump(A),
}

impl<A> Corner<A> {
    /// The corner of other axes that are led along the same curve: a stop is one for them, too. By
    /// how much the velocity of a tool may jump says nothing of the motors that bring it there.
    #[must_use]
    pub const fn of_other_axes<B>(&self) -> Corner<B> {
        match self {
            Self::Stop => Corner::Stop,
            Self::Smooth | Self::Jump(_) => Corner::Smooth,
        }
    }
}

/// A corner between two paths, as the planner sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Junction<A> {
    Stop,
    /// Both paths have this slope here.
    Smooth(A),
    /// The highest speed of the parameter.
    Jump(f64),
}

/// Difference of slopes that is rounding, relative to the steepest axis, each in units of its
/// speed limit.
const SMOOTH: f64 = 1e-9;

/// Relative rounding of each of the two velocities at a corner.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl<A: Axes> Junction<A> {
    /// The junction between two paths with these slopes at their ends.
    pub(crate) fn new(limits: &Reciprocals<A>, corner: &Corner<A>, before: &A, after: &A) -> Self {
        let allowed = match corner {
            Corner::Stop => return Self::Stop,
            Corner::Smooth => A::zeros(),
            Corner::Jump(allowed) => *allowed,
        };
        let slopes = || before.as_slice().iter().zip(after.as_slice());
        let speeds = || {
            limits
                .axes()
                .iter()
                .map(|limits| limits.speed)
                .zip(slopes())
        };
        let steepest = speeds().fold(0.0_f64, |steepest, (limit, (p0, p1))| {
            steepest.max(p0.abs() * limit).max(p1.abs() * limit)
        });
        let is_smooth =
            |(limit, (p0, p1)): (f64, (&f64, &f64))| (p1 - p0).abs() * limit <= SMOOTH * steepest;
        if speeds().all(is_smooth) {
            return Self::Smooth(*after);
        }
        let speed = allowed.as_slice().iter().zip(slopes());
        let speed = speed.fold(f64::INFINITY, |speed, (allowed, (p0, p1))| {
            speed.min(allowed / ((p1 - p0).abs() + ROUNDING * (p0.abs() + p1.abs())))
        });
        if speed < SMALLEST {
            return Self::Stop;
        }
        Self::Jump(speed)
    }

    /// The highest speed at which it is passed, but for what the paths themselves allow.
    pub(crate) const fn cap(&self) -> f64 {
        match self {
            Self::Stop => 0.0,
            Self::Smooth(_) => f64::INFINITY,
            Self::Jump(speed) => *speed,
        }
    }
}
