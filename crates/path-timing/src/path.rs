//! Paths: positions and slopes of all axes at a parameter.

use core::fmt::{self, Debug};

use crate::{Axes, Corner, Span, ToolLimits};

/// Positions and slopes of all axes at a point of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "a point has no more to it")]
pub struct PathPoint<A: Axes> {
    /// Position q of each axis, in its unit.
    pub position: A,
    /// Slope dq/ds of each axis, per unit of the parameter.
    pub slope: A,
}

/// Positions of all axes as a smooth function of a parameter s.
///
/// The slope must be the derivative of the position, and continuous. The parameter may be anything
/// that grows along the path; where it is the arc length of the tool's path, the speed of the
/// parameter is the feed. Where one path goes on to the next without a stop, the parameters of both
/// run at the same speed.
pub trait Path {
    /// `[f64; N]` for N axes.
    type Axes: Axes;
    /// Why the machine cannot be at a point.
    type Error;

    /// The parameter at the end of the path; it is 0 at the start.
    fn length(&self) -> f64;

    /// Axes at the parameter `s`, 0 to [`length`](Self::length): the same for the same `s`.
    ///
    /// # Errors
    /// Why the machine cannot be there.
    fn point(&self, s: f64) -> Result<PathPoint<Self::Axes>, Self::Error>;

    /// Feed and acceleration of the tool along the path, where the parameter is its arc length, or
    /// grows by no less. Nothing but the axes limits it otherwise.
    fn tool(&self) -> Option<ToolLimits> {
        None
    }

    /// How far the tool goes by the parameter at `s`, |dP/ds|: 1 where that is the arc length. Asked
    /// for only where [`tool`](Self::tool) limits an acceleration, which is the tool's own then.
    fn tool_rate(&self, s: f64) -> f64 {
        let _ = s;
        1.0
    }

    /// How the machine goes on to the next path at the end of this one.
    fn corner(&self) -> Corner<Self::Axes> {
        Corner::Stop
    }

    /// Whether the machine may run the cubics of all axes between two knots: within the ranges of
    /// its joints and its workspace. Every planner asks for each segment before anything moves.
    ///
    /// # Errors
    /// Why it may not.
    fn check(&self, span: &Span<Self::Axes>) -> Result<(), Self::Error> {
        let _ = span;
        Ok(())
    }

    /// Whether [`check`](Self::check) has refused a segment only for its length, so that shorter
    /// ones may pass: every planner halves it, down to where it does, and no other.
    fn is_too_coarse(&self, reason: &Self::Error) -> bool {
        let _ = reason;
        false
    }
}

impl<P: Path> Path for &P {
    type Axes = P::Axes;
    type Error = P::Error;

    fn length(&self) -> f64 {
        (**self).length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<P::Axes>, P::Error> {
        (**self).point(s)
    }

    fn tool(&self) -> Option<ToolLimits> {
        (**self).tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        (**self).tool_rate(s)
    }

    fn corner(&self) -> Corner<P::Axes> {
        (**self).corner()
    }

    fn check(&self, span: &Span<P::Axes>) -> Result<(), P::Error> {
        (**self).check(span)
    }

    fn is_too_coarse(&self, reason: &P::Error) -> bool {
        (**self).is_too_coarse(reason)
    }
}

/// A path by a function.
#[derive(Clone, Copy)]
pub struct PathFn<F, A> {
    length: f64,
    point: F,
    tool: Option<ToolLimits>,
    corner: Corner<A>,
}

impl<A: Axes, E, F: Fn(f64) -> Result<PathPoint<A>, E>> PathFn<F, A> {
    /// The path of `point` from 0 to `length`.
    pub const fn new(length: f64, point: F) -> Self {
        Self {
            length,
            point,
            tool: None,
            corner: Corner::Stop,
        }
    }

    /// The path at a feed.
    #[must_use]
    pub fn with_tool(self, tool: ToolLimits) -> Self {
        Self {
            tool: Some(tool),
            ..self
        }
    }

    /// The path with another corner than a stop at its end.
    #[must_use]
    pub fn with_corner(self, corner: Corner<A>) -> Self {
        Self { corner, ..self }
    }
}

impl<A: Axes, E, F: Fn(f64) -> Result<PathPoint<A>, E>> Path for PathFn<F, A> {
    type Axes = A;
    type Error = E;

    fn length(&self) -> f64 {
        self.length
    }

    fn point(&self, s: f64) -> Result<PathPoint<A>, E> {
        (self.point)(s)
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.tool
    }

    fn corner(&self) -> Corner<A> {
        self.corner
    }
}

impl<F, A> Debug for PathFn<F, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PathFn")
            .field("length", &self.length)
            .finish_non_exhaustive()
    }
}
