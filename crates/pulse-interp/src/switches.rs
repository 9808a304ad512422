//! Limit switches.

use crate::Direction;
use core::fmt;
use thiserror::Error;

/// An end of an axis' travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "an axis has two ends")]
pub enum TravelEnd {
    /// Where steps count down to.
    Lower,
    /// Where steps count up to.
    Upper,
}

impl fmt::Display for TravelEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
        })
    }
}

/// Why an axis must not step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SwitchError {
    /// The switch at this end of travel is closed.
    #[error("the {end} limit switch is closed at {position_steps} steps")]
    Hit {
        /// The end of travel.
        end: TravelEnd,
        /// Where the axis stands, in steps.
        position_steps: i32,
    },
    /// Both switches of the axis are closed, which no position can do: a wire, or the supply.
    #[error("both limit switches are closed at {position_steps} steps")]
    BothClosed {
        /// Where the axis stands, in steps.
        position_steps: i32,
    },
}

/// The levels of an axis' two limit switches.
///
/// # Examples
/// ```
/// use pulse_interp::{Direction, Switches};
/// let switches = Switches { lower: true, upper: false };
/// // Away from the closed switch, not further into it.
/// assert!(switches.permit(Direction::Positive, -3).is_ok());
/// let hit = switches.permit(Direction::Negative, -3).unwrap_err();
/// assert_eq!(hit.to_string(), "the lower limit switch is closed at -3 steps");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "an axis has two ends")]
pub struct Switches {
    /// Whether the switch where steps count down to is closed.
    pub lower: bool,
    /// Whether the switch where steps count up to is closed.
    pub upper: bool,
}

impl Switches {
    /// Whether an axis at `position_steps` may step this way: asked before each step, it stops the
    /// axis at once.
    ///
    /// # Errors
    /// [`SwitchError`], with where the axis stands.
    pub const fn permit(
        self,
        direction: Direction,
        position_steps: i32,
    ) -> Result<(), SwitchError> {
        let end = match (self.lower, self.upper, direction) {
            (true, true, _) => return Err(SwitchError::BothClosed { position_steps }),
            (true, _, Direction::Negative) => TravelEnd::Lower,
            (_, true, Direction::Positive) => TravelEnd::Upper,
            _ => return Ok(()),
        };
        Err(SwitchError::Hit {
            end,
            position_steps,
        })
    }
}
