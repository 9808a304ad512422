//! Straight lines in a plane.

mod moves;
mod steps;

pub use moves::LineMoves;
pub use steps::LineSteps;

use crate::{Factor, Move, Rule};
use thiserror::Error;

/// Why a line is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LineError {
    /// -2^31 has no positive counterpart.
    #[error("axis {axis}: {steps} steps, more than {limit} either way")]
    TooLong {
        /// Index of the axis: 0 for X, 1 for Y.
        axis: usize,
        /// Steps asked for.
        steps: i32,
        /// Largest number of steps either way.
        limit: i32,
    },
}

/// A line from where the axes stand to a point `[x, y]` away, in steps.
///
/// ```text
/// F = y xe - x ye,   |F| = distance to the line * its length
/// ```
/// A step of x takes |ye| from F, a step of y adds |xe|, in every quadrant with absolute values.
/// Range ±(2^31 - 1) steps per axis. Source: \[Stage\].
///
/// # Examples
/// ```
/// use pulse_interp::{Line, Move, Rule};
/// let line = Line::new([-3, 1])?;
/// use Move::{Left, Up};
/// assert!(line.steps(Rule::Published).eq([Left, Up, Left, Left]));
/// assert!(line.steps(Rule::Nearest).eq([Left, Left, Up, Left]));
/// assert!(line.moves().eq([Left, Move::UpLeft, Left]));
/// # Ok::<(), pulse_interp::LineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Line {
    to: [i32; 2],
}

impl Line {
    /// The line to `to`, in steps from where the axes stand.
    ///
    /// # Errors
    /// [`LineError::TooLong`] for -2^31.
    pub fn new(to: [i32; 2]) -> Result<Self, LineError> {
        match first_too_long(&to) {
            Some((axis, steps)) => Err(LineError::TooLong {
                axis,
                steps,
                limit: i32::MAX,
            }),
            None => Ok(Self { to }),
        }
    }

    /// The end, in steps from the start.
    #[must_use]
    pub const fn to(&self) -> [i32; 2] {
        self.to
    }

    /// The length of the line, in steps, rounded up: what a ramp along it takes.
    #[must_use]
    pub fn length(&self) -> u64 {
        let square = self.square();
        let down = square.isqrt();
        down.wrapping_add(u64::from(down.wrapping_mul(down) < square))
    }

    /// The line as single steps of one axis, |xe| + |ye| of them.
    ///
    /// At most 1 step off the line by [`Rule::Published`], 0.7072 by [`Rule::Nearest`].
    pub fn steps(&self, rule: Rule) -> LineSteps {
        LineSteps::new(self, rule)
    }

    /// The line as moves to any of eight neighbours, max(|xe|, |ye|) of them: Bresenham's line.
    ///
    /// At most half a step off the line.
    pub fn moves(&self) -> LineMoves {
        LineMoves::new(self)
    }

    /// What the interval of each of [`steps`](Self::steps) is multiplied with so that the path is
    /// as fast as a straight axis, from 0.7071 along a diagonal to 1.
    ///
    /// ```text
    /// sqrt(xe² + ye²) / (|xe| + |ye|)
    /// ```
    #[must_use]
    pub fn step_factor(&self) -> Factor {
        let [x, y] = self.lengths();
        Factor::ratio(self.square(), u64::from(x).wrapping_add(u64::from(y)))
    }

    /// The same for [`moves`](Self::moves), from 1 to 1.4142 along a diagonal.
    ///
    /// ```text
    /// sqrt(xe² + ye²) / max(|xe|, |ye|)
    /// ```
    #[must_use]
    pub fn move_factor(&self) -> Factor {
        let [x, y] = self.lengths();
        Factor::ratio(self.square(), u64::from(x.max(y)))
    }

    /// Below 2^63.
    fn square(&self) -> u64 {
        let [x, y] = self.lengths().map(u64::from);
        x.wrapping_mul(x).wrapping_add(y.wrapping_mul(y))
    }

    const fn lengths(&self) -> [u32; 2] {
        let [x, y] = self.to;
        [x.unsigned_abs(), y.unsigned_abs()]
    }

    /// Lengths and moves of both axes.
    const fn axes(&self) -> [(i32, Move); 2] {
        let [x, y] = self.to;
        // Neither is i32::MIN.
        [
            (
                x.wrapping_abs(),
                if x < 0 { Move::Left } else { Move::Right },
            ),
            (y.wrapping_abs(), if y < 0 { Move::Down } else { Move::Up }),
        ]
    }
}

/// The first axis with -2^31 steps.
pub(crate) fn first_too_long(to: &[i32]) -> Option<(usize, i32)> {
    let mut axes = to.iter().copied().enumerate();
    axes.find(|&(_, steps)| steps == i32::MIN)
}

/// The size hint of an iterator with `left` items: exact wherever `usize` holds it.
pub(crate) fn size_of_rest(left: u64) -> (usize, Option<usize>) {
    match usize::try_from(left) {
        Ok(left) => (left, Some(left)),
        Err(_) => (usize::MAX, None),
    }
}
