//! Paths: where all axes are at a parameter, and which way they go there.

use core::fmt::{self, Debug};

use crate::{Axes, ToolLimits};

/// Axes at a place of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "a place has no more to it")]
pub struct Place<A: Axes> {
    /// Position q of each axis, in its unit.
    pub position: A,
    /// Slope dq/ds of each axis, per unit of the parameter.
    pub slope: A,
}

/// Positions of all axes as a smooth function of a parameter s.
///
/// The slope must be the derivative of the position, and continuous. The parameter may be anything
/// that grows along the path; where it is the tool's way, a speed along the path is the feed.
pub trait Path {
    /// `[f64; N]` for N axes.
    type Axes: Axes;
    /// Why the machine cannot be at a place.
    type Error;

    /// The parameter at the end of the path; it is 0 at the start.
    fn length(&self) -> f64;

    /// Axes at the parameter `s`, 0 to [`length`](Self::length): the same for the same `s`.
    ///
    /// # Errors
    /// Why the machine cannot be there.
    fn place(&self, s: f64) -> Result<Place<Self::Axes>, Self::Error>;

    /// What the tool may do along the path, where the parameter is its way: the feed. Nothing but
    /// the axes limits it otherwise.
    fn tool(&self) -> Option<ToolLimits> {
        None
    }
}

impl<P: Path> Path for &P {
    type Axes = P::Axes;
    type Error = P::Error;

    fn length(&self) -> f64 {
        (**self).length()
    }

    fn place(&self, s: f64) -> Result<Place<P::Axes>, P::Error> {
        (**self).place(s)
    }

    fn tool(&self) -> Option<ToolLimits> {
        (**self).tool()
    }
}

/// A path by a function.
#[derive(Clone, Copy)]
pub struct PathFn<F> {
    length: f64,
    place: F,
    tool: Option<ToolLimits>,
}

impl<A: Axes, E, F: Fn(f64) -> Result<Place<A>, E>> PathFn<F> {
    /// The path of `place` from 0 to `length`.
    pub const fn new(length: f64, place: F) -> Self {
        Self {
            length,
            place,
            tool: None,
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
}

impl<A: Axes, E, F: Fn(f64) -> Result<Place<A>, E>> Path for PathFn<F> {
    type Axes = A;
    type Error = E;

    fn length(&self) -> f64 {
        self.length
    }

    fn place(&self, s: f64) -> Result<Place<A>, E> {
        (self.place)(s)
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.tool
    }
}

impl<F> Debug for PathFn<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PathFn")
            .field("length", &self.length)
            .finish_non_exhaustive()
    }
}

/// Paths one after the other, from rest to rest each: any iterator over [`Path`]s that can be
/// cloned and run backwards. Each begins at the very position at which the one before ends.
pub trait Legs: DoubleEndedIterator<Item = Self::Leg> + Clone {
    /// One of the paths.
    type Leg: Path<Axes = Self::Axes, Error = Self::Error> + Clone + Debug;
    /// `[f64; N]` for N axes.
    type Axes: Axes;
    /// Why the machine cannot be at a place.
    type Error;
}

impl<P: Path + Clone + Debug, L: DoubleEndedIterator<Item = P> + Clone> Legs for L {
    type Leg = P;
    type Axes = P::Axes;
    type Error = P::Error;
}
