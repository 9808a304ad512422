//! Levenberg-Marquardt for N parameters and any number of residuals, in fixed memory.

use core::fmt;

use nalgebra::SVector;

use crate::Jacobian;
use crate::number::sqrt;
use crate::rank::Rank;

/// Measurements as a function of changes of N parameters.
///
/// A measurement is a place in space, or one number; its square is that of the distance from what
/// is computed.
pub trait Problem<const N: usize> {
    /// What changed parameters make.
    type Model;

    /// The model with these changes, in the parameters' own units; `None` where there is none.
    fn model(&self, changes: [f64; N]) -> Option<Self::Model>;

    /// The square of what is missing at each measurement; `None` where the model cannot have it.
    fn squares(&self, model: &Self::Model) -> impl Iterator<Item = Option<f64>>;

    /// Adds the rows of each measurement: one, or one for each coordinate. `None` where the model
    /// has no derivative.
    fn add_rows(&self, model: &Self::Model, jacobian: &mut Jacobian<N>) -> Option<()>;
}

/// The residuals still shrink after the largest number of iterations, or there is no derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "an end is just this")]
pub struct NotConverged {
    /// Iterations made.
    pub iterations: u32,
    /// Root mean square of what is missing at the measurements so far.
    pub rms: f64,
}

impl fmt::Display for NotConverged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { iterations, rms } = self;
        write!(
            f,
            "not converged after {iterations} iterations, rms {rms:.6e}"
        )
    }
}

impl core::error::Error for NotConverged {}

/// What [`fit`] has found. All arrays are in the order of the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastSquares<const N: usize> {
    changes: [f64; N],
    rms: f64,
    largest: f64,
    iterations: u32,
    rank: Rank<N>,
}

const MAX_ITERATIONS: u32 = 200;

/// Damping at the start, and where no damping helps any more, in units of the columns' squares.
const FIRST_DAMPING: f64 = 1e-3;
const MAX_DAMPING: f64 = 1e12;

/// Relative decrease of the sum below which another iteration is not worth its time.
const SMALL_DECREASE: f64 = 1e-9;

/// The model with the smallest sum of squares, from no changes on, and how well it fits.
///
/// `span` is what a computed value is rounded by, in machine epsilons, such as the size of the
/// machine; `units` is what a change of each parameter is measured in: the span for a length, 1 for
/// an angle. Parameters that the measurements do not determine stay near their values.
///
/// # Errors
/// [`NotConverged`]; its `rms` is not a number where the problem cannot be computed without
/// changes, or what is left is not a number, such as in a span of 0.
pub fn fit<const N: usize, P: Problem<N>>(
    problem: &P,
    span: f64,
    units: [f64; N],
) -> Result<(P::Model, LeastSquares<N>), NotConverged> {
    let in_units = |changes: &SVector<f64, N>| {
        let units = SVector::<f64, N>::from(units);
        <[f64; N]>::from(changes.component_mul(&units))
    };
    let mut changes = SVector::<f64, N>::zeros();
    let refused = |iterations, rms| NotConverged { iterations, rms };
    let mut model = problem
        .model([0.0; N])
        .ok_or_else(|| refused(0, f64::NAN))?;
    let mut scales = SVector::<f64, N>::zeros();
    let mut damping = FIRST_DAMPING;
    let mut iterations = 0;
    loop {
        let mut rows = Jacobian::new(span, units);
        let added = problem.add_rows(&model, &mut rows);
        let left = Left::of(problem, &model, span);
        let Some(left) = left.filter(|_| added.is_some() && iterations < MAX_ITERATIONS) else {
            return Err(refused(
                iterations,
                left.map_or(f64::NAN, |left| left.rms() * span),
            ));
        };
        iterations += 1;
        scales = scales.sup(&rows.scales());
        let mut better = None;
        // Where residuals are rounding it is chance that reduces their sum.
        while better.is_none() && left.sum > left.rounding() && damping <= MAX_DAMPING {
            let next = changes + rows.step(damping, &scales);
            better = problem
                .model(in_units(&next))
                .and_then(|model| Some((Left::of(problem, &model, span)?, model, next)))
                .filter(|(less, ..)| less.sum < left.sum);
            damping = if better.is_some() {
                damping / 10.0
            } else {
                damping * 10.0
            };
        }
        let is_worth_it = |less: &Left| left.sum - less.sum > left.sum * SMALL_DECREASE;
        let is_last = !better.as_ref().is_some_and(|(less, ..)| is_worth_it(less));
        let mut now = left;
        if let Some((less, better, next)) = better {
            (now, model, changes) = (less, better, next);
        }
        if is_last {
            let fit = LeastSquares {
                changes: in_units(&changes),
                rms: now.rms() * span,
                largest: sqrt(now.largest) * span,
                iterations,
                rank: Rank::new(&rows, now.sum, units),
            };
            return Ok((model, fit));
        }
    }
}

/// What is left at the measurements, in spans.
#[derive(Clone, Copy)]
struct Left {
    /// Of the squares, and the largest square.
    sum: f64,
    largest: f64,
    count: f64,
}

impl Left {
    /// `None` where the model cannot have a measurement, or what is left is no number.
    fn of<const N: usize, P: Problem<N>>(problem: &P, model: &P::Model, span: f64) -> Option<Self> {
        let none = Self {
            sum: 0.0,
            largest: 0.0,
            count: 0.0,
        };
        let all = problem.squares(model).try_fold(none, |all, square| {
            let square = square? / span / span;
            Some(Self {
                sum: all.sum + square,
                largest: all.largest.max(square),
                count: all.count + 1.0,
            })
        });
        all.filter(|all| all.sum.is_finite())
    }

    /// What the sum is where each measurement is met to a machine epsilon of the span.
    fn rounding(self) -> f64 {
        self.count * f64::EPSILON * f64::EPSILON
    }

    fn rms(self) -> f64 {
        // No measurement at all is no residual.
        sqrt(self.sum / self.count.max(1.0))
    }
}

impl<const N: usize> LeastSquares<N> {
    /// What was added to each parameter, in its unit.
    #[must_use]
    pub const fn changes(&self) -> &[f64; N] {
        &self.changes
    }

    /// The standard deviation of each parameter, in its unit, from the residuals; `None` for those
    /// that the measurements do not determine.
    #[must_use]
    pub fn deviations(&self) -> [Option<f64>; N] {
        self.rank.deviations()
    }

    /// Root mean square of the distances that are left.
    #[must_use]
    pub const fn rms(&self) -> f64 {
        self.rms
    }

    /// The largest distance that is left.
    #[must_use]
    pub const fn largest(&self) -> f64 {
        self.largest
    }

    /// Iterations made.
    #[must_use]
    pub const fn iterations(&self) -> u32 {
        self.iterations
    }

    /// How many independent combinations of the parameters the measurements determine; N is all.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.rank.rank()
    }

    /// Smallest over largest singular value of the scaled Jacobian: how well the worst combination
    /// is determined. Zero within rounding where the rank is less than N.
    ///
    /// Noise can make a parameter look determined that the measurements hardly see: this number and
    /// the size of the changes show it.
    #[must_use]
    pub fn conditioning(&self) -> f64 {
        self.rank.conditioning()
    }

    /// For each parameter, whether the measurements leave it open, alone or together with others.
    pub(crate) fn free(&self) -> [bool; N] {
        self.rank.free()
    }

    /// Changes of the parameters that, to first order, move none of the computed values: a basis of
    /// the null space.
    pub fn null_space(&self) -> impl Iterator<Item = [f64; N]> + use<N> {
        self.rank.null_space()
    }
}
