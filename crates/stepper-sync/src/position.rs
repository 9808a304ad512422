//! Where the axes are, in whole steps.

mod scale;

pub use scale::{ScaleError, StepCarry, StepScale};

use crate::Direction;
use thiserror::Error;

/// Why a move is refused. The position stays as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PositionError {
    /// The move would pass a limit.
    #[error("axis {axis}: {steps} steps from {position} pass the limit {limit}")]
    LimitPassed {
        /// Index of the axis.
        axis: usize,
        /// Position before the move, in steps.
        position: i32,
        /// Steps of the move.
        steps: i32,
        /// The limit passed, in steps.
        limit: i32,
    },
    /// The target is outside the limits.
    #[error("axis {axis}: target {target} is past the limit {limit}")]
    TargetPastLimit {
        /// Index of the axis.
        axis: usize,
        /// Target, in steps.
        target: i32,
        /// The limit passed, in steps.
        limit: i32,
    },
    /// The distance to the target does not fit one move of ±(2^31 - 1) steps.
    #[error("axis {axis}: from {position} to {target} is more than 2147483647 steps")]
    MoveTooLong {
        /// Index of the axis.
        axis: usize,
        /// Position before the move, in steps.
        position: i32,
        /// Target, in steps.
        target: i32,
    },
    /// Limits that do not contain the position, are reversed, or reach -2^31.
    #[error("axis {axis}: limits {min}..={max} do not hold the position {position}")]
    Limits {
        /// Index of the axis.
        axis: usize,
        /// Lower limit given, in steps.
        min: i32,
        /// Upper limit given, in steps.
        max: i32,
        /// Position, in steps.
        position: i32,
    },
    /// No axis of this index.
    #[error("axis {axis} of {axes}")]
    NoSuchAxis {
        /// Index given.
        axis: usize,
        /// Number of axes.
        axes: usize,
    },
}

/// Positions of N axes: the sum of all signed steps since home.
///
/// Every sum is checked against the limits of its axis, by default ±(2^31 - 1) steps, and nothing
/// is moved when one axis fails. So the move home, the negative sum, always exists.
///
/// # Examples
/// ```
/// use stepper_sync::Position;
/// let mut position = Position::home();
/// position.apply([30, -7])?;
/// assert_eq!(position.move_to([25, 0])?, [-5, 7]);
/// assert_eq!(position.homing(), [-25, 0]);
/// # Ok::<(), stepper_sync::PositionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Position<const N: usize> {
    axes: [Axis; N],
}

/// Steps of one axis; never `i32::MIN`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Axis {
    steps: i32,
    min: i32,
    max: i32,
}

impl Axis {
    /// The limit on the side of `steps`, when `position` is past it.
    fn limit_passed(self, position: i64) -> Option<i32> {
        if position > i64::from(self.max) {
            Some(self.max)
        } else if position < i64::from(self.min) {
            Some(self.min)
        } else {
            None
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "within the limits, of 32 bits"
    )]
    fn moved(self, axis: usize, steps: i32) -> Result<Self, PositionError> {
        // The sum of two i32 fits.
        let position = i64::from(self.steps).wrapping_add(i64::from(steps));
        match self.limit_passed(position) {
            None => Ok(Self {
                steps: position as i32,
                ..self
            }),
            Some(limit) => Err(PositionError::LimitPassed {
                axis,
                position: self.steps,
                steps,
                limit,
            }),
        }
    }

    fn steps_to(self, axis: usize, target: i32) -> Result<i32, PositionError> {
        if let Some(limit) = self.limit_passed(i64::from(target)) {
            return Err(PositionError::TargetPastLimit {
                axis,
                target,
                limit,
            });
        }
        target
            .checked_sub(self.steps)
            .filter(|&steps| steps != i32::MIN)
            .ok_or(PositionError::MoveTooLong {
                axis,
                position: self.steps,
                target,
            })
    }
}

impl<const N: usize> Default for Position<N> {
    fn default() -> Self {
        Self::home()
    }
}

impl<const N: usize> Position<N> {
    /// All axes at home, at 0.
    #[must_use]
    pub const fn home() -> Self {
        Self {
            axes: [Axis {
                steps: 0,
                min: -i32::MAX,
                max: i32::MAX,
            }; N],
        }
    }

    /// The same position with limits of one axis, in steps from home.
    ///
    /// # Errors
    /// [`PositionError::Limits`] when the position is outside or `min` is -2^31;
    /// [`PositionError::NoSuchAxis`].
    pub fn with_limits(mut self, axis: usize, min: i32, max: i32) -> Result<Self, PositionError> {
        let entry = self
            .axes
            .get_mut(axis)
            .ok_or(PositionError::NoSuchAxis { axis, axes: N })?;
        let position = entry.steps;
        if min == i32::MIN || position < min || position > max {
            return Err(PositionError::Limits {
                axis,
                min,
                max,
                position,
            });
        }
        (entry.min, entry.max) = (min, max);
        Ok(self)
    }

    /// Steps from home, per axis.
    #[must_use]
    pub fn steps(&self) -> [i32; N] {
        self.axes.map(|axis| axis.steps)
    }

    /// Records a move of signed steps.
    ///
    /// # Errors
    /// [`PositionError::LimitPassed`]; no axis is moved then.
    pub fn apply(&mut self, steps: [i32; N]) -> Result<(), PositionError> {
        let mut axes = self.axes;
        for (index, (axis, n)) in axes.iter_mut().zip(steps).enumerate() {
            *axis = axis.moved(index, n)?;
        }
        self.axes = axes;
        Ok(())
    }

    /// Records one step of one axis, at the [`High`](crate::Level::High) edge of its pulse.
    ///
    /// # Errors
    /// [`PositionError::LimitPassed`], [`PositionError::NoSuchAxis`].
    pub fn step(&mut self, axis: usize, direction: Direction) -> Result<(), PositionError> {
        let entry = self
            .axes
            .get_mut(axis)
            .ok_or(PositionError::NoSuchAxis { axis, axes: N })?;
        let steps = match direction {
            Direction::Positive => 1,
            Direction::Negative => -1,
        };
        *entry = entry.moved(axis, steps)?;
        Ok(())
    }

    /// Records a move to absolute targets and returns its signed steps.
    ///
    /// Targets rounded from the absolute position ([`StepScale`]) carry their rounding along: the
    /// error never adds up.
    ///
    /// # Errors
    /// [`PositionError::TargetPastLimit`], [`PositionError::MoveTooLong`]; no axis is moved then.
    pub fn move_to(&mut self, targets: [i32; N]) -> Result<[i32; N], PositionError> {
        let mut moves = [0; N];
        for (index, ((axis, target), steps)) in
            self.axes.iter().zip(targets).zip(&mut moves).enumerate()
        {
            *steps = axis.steps_to(index, target)?;
        }
        self.apply(moves)?;
        Ok(moves)
    }

    /// The move that brings all axes home: the negative sums.
    #[must_use]
    pub fn homing(&self) -> [i32; N] {
        // No position is i32::MIN.
        self.axes.map(|axis| axis.steps.wrapping_neg())
    }
}
