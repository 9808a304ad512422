//! Homing on a limit switch.

use crate::Direction;
use thiserror::Error;

/// How an axis finds its switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "every setting is needed")]
pub struct HomingSettings {
    /// The direction to the switch.
    pub direction: Direction,
    /// The most steps of any of the three ways, more than the travel.
    pub max_steps: u32,
    /// How many steps beyond the opening of the switch the slow approach begins.
    pub clear_steps: u32,
}

/// What the axis does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a caller must handle every order")]
pub enum HomingOrder {
    /// One step, then look at the switch and ask again.
    Step {
        /// Its direction.
        direction: Direction,
        /// How fast.
        speed: HomingSpeed,
    },
    /// The axis stands where the switch has just closed.
    Home,
}

/// The two speeds of homing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_enums,
    reason = "two speeds are what homing is about"
)]
pub enum HomingSpeed {
    /// Towards the switch and back from it.
    Fast,
    /// Towards the position where it closes.
    Slow,
}

/// Why an axis does not find home.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum HomingError {
    /// The switch did not close.
    #[error("the switch has not closed within {steps} steps")]
    NeverClosed {
        /// Steps made.
        steps: u32,
    },
    /// The switch did not open, or not for long enough, while the axis backed off.
    #[error("the switch has not stayed open within {steps} steps back")]
    NeverOpened {
        /// Steps made.
        steps: u32,
    },
}

/// Homing: to the switch fast, back off it, to it again slowly.
///
/// A state machine without a clock: the level of the switch goes in, the next step comes out. An
/// axis that starts on its switch begins with backing off.
///
/// # Examples
/// ```
/// use pulse_interp::{Direction, Homing, HomingOrder, HomingSettings};
/// let mut homing = Homing::new(HomingSettings {
///     direction: Direction::Negative,
///     max_steps: 20_000,
///     clear_steps: 50,
/// });
/// let mut position = 731;
/// while let HomingOrder::Step { direction, .. } = homing.next(position <= 0)? {
///     position += direction.sign();
/// }
/// assert_eq!(position, 0);
/// # Ok::<(), pulse_interp::HomingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Homing {
    settings: HomingSettings,
    phase: Phase,
    /// Steps of this phase.
    made: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Phase {
    Approach(HomingSpeed),
    /// With the steps since the switch opened.
    BackOff(u32),
    Home,
    /// For good.
    Lost(HomingError),
}

impl Homing {
    /// Homing from wherever the axis stands.
    #[must_use]
    pub const fn new(settings: HomingSettings) -> Self {
        Self {
            settings,
            phase: Phase::Approach(HomingSpeed::Fast),
            made: 0,
        }
    }

    /// The next order, where the switch is `closed` now. After [`HomingOrder::Home`], that again.
    ///
    /// # Errors
    /// [`HomingError`], again at every further call.
    pub fn next(&mut self, closed: bool) -> Result<HomingOrder, HomingError> {
        self.phase = match (self.phase, closed) {
            (Phase::Approach(HomingSpeed::Fast), true) => self.begin(Phase::BackOff(0)),
            (Phase::Approach(HomingSpeed::Slow), true) => Phase::Home,
            (Phase::BackOff(_), true) => Phase::BackOff(0),
            (Phase::BackOff(open), false) if open >= self.settings.clear_steps => {
                self.begin(Phase::Approach(HomingSpeed::Slow))
            }
            (Phase::BackOff(open), false) => Phase::BackOff(open.saturating_add(1)),
            (phase, _) => phase,
        };
        let (direction, speed) = match self.phase {
            Phase::Home => return Ok(HomingOrder::Home),
            Phase::Lost(error) => return Err(error),
            Phase::Approach(speed) => (self.settings.direction, speed),
            Phase::BackOff(_) => (self.settings.direction.reversed(), HomingSpeed::Fast),
        };
        if self.made >= self.settings.max_steps {
            let error = self.lost();
            self.phase = Phase::Lost(error);
            return Err(error);
        }
        self.made = self.made.saturating_add(1);
        Ok(HomingOrder::Step { direction, speed })
    }

    const fn begin(&mut self, phase: Phase) -> Phase {
        self.made = 0;
        phase
    }

    const fn lost(&self) -> HomingError {
        let steps = self.made;
        match self.phase {
            Phase::BackOff(_) => HomingError::NeverOpened { steps },
            _ => HomingError::NeverClosed { steps },
        }
    }
}
