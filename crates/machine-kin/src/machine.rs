//! Machines: their axes, and the inverse kinematics that all else follows from.

use core::f64::consts::{PI, TAU};
use core::fmt::Debug;
use core::ops::RangeInclusive;

use path_timing::Curve;

use crate::matrix::{Enclosure, both};
use crate::path::{MachinePath, PathError};
use crate::{Gradient, Interval, Number, Refusal};

/// An axis of a machine: its name in messages, and the range of its positions.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Axis {
    pub(crate) name: &'static str,
    pub(crate) min: f64,
    pub(crate) max: f64,
    pub(crate) is_angle: bool,
}

impl Axis {
    /// A carriage, a cord, a belt: in the unit of length. An end may be infinite.
    #[must_use]
    pub const fn linear(name: &'static str, range: RangeInclusive<f64>) -> Self {
        Self {
            name,
            min: *range.start(),
            max: *range.end(),
            is_angle: false,
        }
    }

    /// A joint or a table, in radians: what the inverse says of it counts but for whole turns, the
    /// path goes on without a jump. An end may be infinite.
    #[must_use]
    pub const fn angle(name: &'static str, range: RangeInclusive<f64>) -> Self {
        Self {
            is_angle: true,
            ..Self::linear(name, range)
        }
    }

    /// Whether its positions count but for whole turns.
    #[must_use]
    pub const fn is_angle(&self) -> bool {
        self.is_angle
    }

    /// Its name.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// Its range.
    #[must_use]
    pub const fn range(&self) -> RangeInclusive<f64> {
        self.min..=self.max
    }

    /// A difference of two positions, at the turn at which it is smallest.
    pub(crate) fn difference(&self, apart: f64) -> f64 {
        if self.is_angle && apart.abs() > PI {
            apart - libm::round(apart / TAU) * TAU
        } else {
            apart
        }
    }

    /// A position that is nearest to the middle of the range.
    pub(crate) fn middle(&self) -> f64 {
        let middle = self.min * 0.5 + self.max * 0.5;
        if middle.is_finite() {
            return middle;
        }
        let end = if self.min.is_finite() {
            self.min
        } else {
            self.max
        };
        if end.is_finite() { end } else { 0.0 }
    }

    /// By how much a position may be beyond an end: rounding, and a path that touches it.
    pub(crate) fn beyond(&self, low: f64, high: f64) -> Option<f64> {
        let slack = |end: f64| RANGE_SLACK * (1.0 + end.abs());
        // Written so that NaN is beyond.
        let is_above = self.min == f64::NEG_INFINITY || low >= self.min - slack(self.min);
        let is_below = self.max == f64::INFINITY || high <= self.max + slack(self.max);
        if is_above && is_below {
            return None;
        }
        let is_lower = self.min - low > high - self.max;
        Some(if is_lower { low } else { high })
    }
}

/// By how much an axis may pass an end of its range, as a fraction of it and of 1.
const RANGE_SLACK: f64 = 1e-9;

/// A machine with `N` axes that move a tool of `N` coordinates: its inverse kinematics, written
/// once for all [`Number`]s.
///
/// Coordinates of the tool are lengths: an orientation is one at a radius, as in
/// [`Scara`](crate::Scara). What is not written as a number of type `T` is exact: the geometry.
pub trait Machine<const N: usize>: Clone + Debug {
    /// Which of several solutions, by name: `()` where there is one.
    type Branch: Copy + Debug + PartialEq;

    /// The axes, in the order of [`inverse`](Self::inverse).
    fn axes(&self) -> [Axis; N];

    /// Where the axes have to be for the tool to be at `tool`.
    ///
    /// # Errors
    /// [`Refusal`] where the tool cannot be there, by what [`Number`]'s functions refuse.
    fn inverse<T: Number>(&self, tool: [T; N], branch: Self::Branch) -> Result<[T; N], Refusal>;

    /// Ranges of the tool's coordinates, where they have ends of their own: what is not a matter of
    /// any axis, such as the frame of a CoreXY.
    fn area(&self) -> [RangeInclusive<f64>; N] {
        [(); N].map(|()| f64::NEG_INFINITY..=f64::INFINITY)
    }

    /// The path of the axes that brings the tool along `curve` on one branch, each angle beginning
    /// at the turn nearest to the middle of its range.
    ///
    /// All of the curve is looked at before anything is handed out, piece by piece: by intervals,
    /// no piece of it has a place that cannot be reached, at which the branch ends, that is
    /// singular, or at which an axis leaves its range. Pieces that cannot be decided are halved,
    /// down to 1e-9 of the curve, and what is undecided then is refused.
    ///
    /// # Errors
    /// [`PathError`]; the place named is the first along the curve.
    fn path(
        &self,
        curve: Curve<N>,
        branch: Self::Branch,
    ) -> Result<MachinePath<Self, N>, PathError<N>> {
        self.path_from(curve, branch, self.axes().map(|axis| axis.middle()))
    }

    /// As [`path`](Self::path), each angle beginning at the turn nearest to `previous`: where the
    /// path before ended.
    ///
    /// # Errors
    /// [`PathError`]; the place named is the first along the curve.
    fn path_from(
        &self,
        curve: Curve<N>,
        branch: Self::Branch,
        previous: [f64; N],
    ) -> Result<MachinePath<Self, N>, PathError<N>> {
        MachinePath::new(self.clone(), curve, branch, previous)
    }

    /// How far the tool can go from a place, in each coordinate and all directions, before it may
    /// come to where it cannot be, the branch ends, or the machine is singular: proven by
    /// intervals, so that the true distance is larger. 0 where that is so already, infinite where
    /// it never is.
    fn clearance(&self, tool: [f64; N], branch: Self::Branch) -> f64 {
        let is_free = |by: f64| is_regular(self, tool, by, branch, DEEPEST);
        let size = tool.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let mut free = 0.0;
        let mut by = (size + f64::MIN_POSITIVE) * LEAST_CLEARANCE;
        while is_free(by) {
            (free, by) = (by, by * 2.0);
            if by > size * MOST_CLEARANCE {
                return f64::INFINITY;
            }
        }
        // Three digits in two are enough.
        let mut step = free * 0.5;
        for _ in 0..6 {
            if is_free(free + step) {
                free += step;
            }
            step *= 0.5;
        }
        free
    }
}

/// The smallest clearance that is looked for, and that from which on it is infinite, as fractions
/// of the largest coordinate.
const LEAST_CLEARANCE: f64 = 1e-9;
const MOST_CLEARANCE: f64 = 1e6;

/// How often a box is halved in each coordinate where it cannot be decided.
const DEEPEST: u32 = 2;

/// Whether the inverse is defined and regular within a distance of a place in each coordinate.
fn is_regular<M: Machine<N>, const N: usize>(
    machine: &M,
    tool: [f64; N],
    by: f64,
    branch: M::Branch,
    deepest: u32,
) -> bool {
    let slopes = slopes_within(machine, tool, by, branch);
    if slopes.is_ok_and(|slopes| Enclosure::new(&slopes).is_some()) {
        return true;
    }
    let Some(deepest) = deepest.checked_sub(1) else {
        return false;
    };
    // The corners of a box around, each the middle of an eighth, or what it is in N dimensions.
    let half = by * 0.5;
    (0..1_u32 << N).all(|corner| {
        let mut middle = tool;
        for (number, x) in middle.iter_mut().enumerate() {
            let is_above = corner >> number & 1 == 1;
            *x += if is_above { half } else { -half };
        }
        // Rounding of the middle is within what boxes overlap by.
        is_regular(machine, middle, half * (1.0 + OVERLAP), branch, deepest)
    })
}

/// By how much boxes are larger than half of the one that they make up.
const OVERLAP: f64 = 1e-6;

/// All Jacobians of the inverse within a distance of a place in each coordinate.
///
/// ```text
/// J(p + e) ∈ J(p) + [∂J/∂p] e
/// ```
fn slopes_within<M: Machine<N>, const N: usize>(
    machine: &M,
    tool: [f64; N],
    by: f64,
    branch: M::Branch,
) -> Result<[[Interval; N]; N], Refusal> {
    let here = Gradient::variables(tool.map(Interval::from));
    let around = Gradient::variables(tool.map(|x| Interval::around(x, by)));
    let here = machine.inverse(here, branch)?.map(|axis| *axis.slopes());
    let around = machine.inverse(Gradient::variables(around), branch)?;
    let change = around.map(|axis| {
        axis.slopes().map(|slope| {
            let sum = slope.slopes().iter().map(Interval::magnitude).sum::<f64>();
            Interval::around(0.0, sum * by)
        })
    });
    Ok(both(&here, &change, Interval::UNKNOWN, |slope, change| {
        slope + change
    }))
}
