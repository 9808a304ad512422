//! Curves of the tool as paths of a machine's axes, to be timed by `path-timing`.

mod around;
mod bound;
mod check;
mod corridor;
mod error;
mod look_beside;
mod nodes;
mod series;
mod stretch;
mod turns;
mod walk;

use path_timing::{Corner, Curve, Path, PathPoint, Span, ToolLimits};

pub use error::PathError;

use crate::matrix::Matrix;
use crate::{Axis, Gradient, Jet, Machine, Refusal};
use corridor::Beside;
use turns::{Turns, at_turns};

/// A curve of the tool as a path of a machine's axes, by the curve's arc length: what
/// [`path_timing::Table`] plans.
///
/// It is made by [`Machine::path`], which has looked at all of it. The next one goes on from it
/// without a stop where the directions of their curves agree, as those of a line and a blend do,
/// unless the curve's own corner is a stop; by how much an axis may jump
/// [`with_corner`](Self::with_corner) says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachinePath<M: Machine<N>, const N: usize> {
    machine: M,
    axes: [Axis; N],
    curve: Curve<N>,
    branch: M::Branch,
    turns: Turns<N>,
    corner: Corner<[f64; N]>,
    /// What places of the curve are off by.
    rounding: f64,
    /// What is known beside all of it.
    beside: Option<Beside<N>>,
}

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// The curve of the tool.
    #[must_use]
    pub const fn curve(&self) -> &Curve<N> {
        &self.curve
    }

    /// The path with another corner at its end, such as the start-stop speeds of its motors in
    /// its axes' units a second. At first it is smooth, or a stop where that of the curve is one.
    #[must_use]
    pub const fn with_corner(mut self, corner: Corner<[f64; N]>) -> Self {
        self.corner = corner;
        self
    }

    /// The branch that it is run on.
    #[must_use]
    pub const fn branch(&self) -> M::Branch {
        self.branch
    }

    /// How far the tool is at the arc length `s` from where it could not be, the branch ends, or
    /// the machine is singular: see [`Machine::clearance`].
    #[must_use]
    pub fn clearance(&self, s: f64) -> f64 {
        self.machine.clearance(self.curve.at(s).point, self.branch)
    }

    /// Positions of the axes with their first and second derivatives by the arc length, exact but
    /// for rounding: what a drive that is fed forward needs.
    ///
    /// # Errors
    /// [`PathError::Unreachable`] outside of the curve.
    pub fn derivatives(&self, s: f64) -> Result<[[f64; N]; 3], PathError<N>> {
        let jets = self.jets::<3>(s)?;
        let positions = at_turns(&self.axes, of(&jets, 0), &self.turns.near(s));
        Ok([positions, of(&jets, 1), of(&jets, 2).map(|half| half * 2.0)])
    }

    /// Taylor coefficients of the axes by s, of the first three, at any turns.
    fn jets<const K: usize>(&self, s: f64) -> Result<[Jet<f64, K>; N], PathError<N>> {
        let at = self.curve.at(s);
        let mut coefficients = [[0.0; K]; N];
        let known = at.point.iter().zip(at.tangent).zip(at.curvature);
        for (coefficients, ((place, first), second)) in coefficients.iter_mut().zip(known) {
            let known = [*place, first, second * 0.5];
            for (coefficient, known) in coefficients.iter_mut().zip(known) {
                *coefficient = known;
            }
        }
        let axes = self
            .machine
            .inverse(coefficients.map(Jet::new), self.branch);
        let point = at.point;
        axes.map_err(|reason| PathError::Unreachable { s, point, reason })
    }

    /// The axes at a place, at any turns, and their slopes by the tool's coordinates.
    fn slopes_at(&self, place: [f64; N]) -> Result<([f64; N], Matrix<N>), Refusal> {
        let axes = self
            .machine
            .inverse(Gradient::variables(place), self.branch)?;
        Ok((
            axes.map(|axis| axis.value()),
            axes.map(|axis| *axis.slopes()),
        ))
    }

    /// Positions less others, each angle at the turn at which that is smallest.
    fn apart(&self, positions: &[f64; N], others: &[f64; N]) -> [f64; N] {
        let mut apart = *positions;
        let pairs = apart.iter_mut().zip(others).zip(&self.axes);
        for ((position, other), axis) in pairs {
            *position = axis.difference(*position - other);
        }
        apart
    }
}

/// The k-th coefficient of each axis.
fn of<const K: usize, const N: usize>(jets: &[Jet<f64, K>; N], k: usize) -> [f64; N] {
    jets.map(|jet| jet.coefficients().get(k).copied().unwrap_or_default())
}

impl<M: Machine<N>, const N: usize> Path for MachinePath<M, N> {
    type Axes = [f64; N];
    type Error = PathError<N>;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; N]>, PathError<N>> {
        let jets = self.jets::<2>(s)?;
        Ok(PathPoint {
            position: at_turns(&self.axes, of(&jets, 0), &self.turns.near(s)),
            slope: of(&jets, 1),
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.curve.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; N]> {
        self.corner
    }

    fn check(&self, span: &Span<[f64; N]>) -> Result<(), PathError<N>> {
        self.check_span(span)
    }

    fn is_too_coarse(&self, reason: &PathError<N>) -> bool {
        // The curve itself is within all ranges: a cubic that is not has left it.
        matches!(
            reason,
            PathError::TooCoarse { .. } | PathError::Limit { .. }
        )
    }
}
