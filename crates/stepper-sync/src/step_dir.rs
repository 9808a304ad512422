//! Motors on drivers with a step and a direction pin.

use crate::{Direction, Level, Polarity, StepDirTiming};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{OutputPin, PinState};
use thiserror::Error;

/// A pin that could not be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "there are two pins")]
pub enum StepDirError<S, D> {
    /// The step pin.
    #[error("step pin: {0:?}")]
    Step(S),
    /// The direction pin.
    #[error("direction pin: {0:?}")]
    Direction(D),
}

/// A motor on a driver chip with a step and a direction input.
///
/// [`step`](Self::step) makes whole pulses, for steps that come from a common tick;
/// [`set_level`](Self::set_level) makes the edges of a train,
/// whose own intervals must then be no shorter than pulse and pause. Delays only wait longer than
/// asked, so no time is cut short.
///
/// # Examples
/// ```
/// use stepper_sync::StepDir;
/// use stepper_sync::{Direction, StepDirTiming};
/// # fn demo<P, D>(step_pin: P, direction_pin: P, mut delay: D) -> Result<(), stepper_sync::StepDirError<P::Error, P::Error>>
/// # where P: embedded_hal::digital::OutputPin, D: embedded_hal::delay::DelayNs {
/// let mut motor = StepDir::new(step_pin, direction_pin, StepDirTiming::A4988);
/// for step in [1, 0, -1] {
///     motor.step(Direction::of(step), &mut delay)?;
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct StepDir<S, D> {
    step: S,
    direction: D,
    timing: StepDirTiming,
    step_polarity: Polarity,
    direction_polarity: Polarity,
    set: Option<Direction>,
    /// A pulse has begun since the last change of direction.
    pulsed: bool,
    /// The step pin did not follow.
    unsure: bool,
}

impl<S: OutputPin, D: OutputPin> StepDir<S, D> {
    /// A motor on two pins, both active high: a positive direction is the high level. The pins are
    /// not touched yet.
    pub const fn new(step: S, direction: D, timing: StepDirTiming) -> Self {
        Self {
            step,
            direction,
            timing,
            step_polarity: Polarity::ActiveHigh,
            direction_polarity: Polarity::ActiveHigh,
            set: None,
            pulsed: false,
            unsure: false,
        }
    }

    /// The same with other levels, which the next step or direction sets.
    #[must_use]
    pub fn with_polarity(self, step: Polarity, direction: Polarity) -> Self {
        Self {
            step_polarity: step,
            direction_polarity: direction,
            set: None,
            unsure: self.unsure || step != self.step_polarity,
            ..self
        }
    }

    /// Sets the direction, after the hold time of the pulse before, and waits for the setup time.
    /// Nothing happens when it is set already.
    ///
    /// # Errors
    /// [`StepDirError::Direction`]; the next call sets the pin again.
    pub fn set_direction(
        &mut self,
        direction: Direction,
        delay: &mut impl DelayNs,
    ) -> Result<(), StepDirError<S::Error, D::Error>> {
        if self.set == Some(direction) {
            return Ok(());
        }
        self.set = None;
        if self.pulsed {
            delay.delay_ns(self.timing.hold_ns);
            self.pulsed = false;
        }
        let level = level(self.direction_polarity, direction == Direction::Positive);
        self.direction
            .set_state(level)
            .map_err(StepDirError::Direction)?;
        self.set = Some(direction);
        delay.delay_ns(self.timing.setup_ns);
        Ok(())
    }

    /// Makes one edge: [`Level::High`] is the active level.
    ///
    /// # Errors
    /// [`StepDirError::Step`].
    pub fn set_level(&mut self, edge: Level) -> Result<(), StepDirError<S::Error, D::Error>> {
        let level = level(self.step_polarity, edge == Level::High);
        self.pulsed |= edge == Level::High;
        self.unsure = true;
        self.step.set_state(level).map_err(StepDirError::Step)?;
        self.unsure = false;
        Ok(())
    }

    /// Makes one step and waits until the next may come; nothing for `None`.
    ///
    /// # Errors
    /// [`StepDirError`]; after [`StepDirError::Step`] it is not known whether the motor has
    /// stepped. The next step then begins by ending the pulse.
    pub fn step(
        &mut self,
        direction: Option<Direction>,
        delay: &mut impl DelayNs,
    ) -> Result<(), StepDirError<S::Error, D::Error>> {
        let Some(direction) = direction else {
            return Ok(());
        };
        if self.unsure {
            self.end_pulse(delay)?;
        }
        self.set_direction(direction, delay)?;
        self.set_level(Level::High)?;
        delay.delay_ns(self.timing.pulse_ns);
        self.end_pulse(delay)
    }

    fn end_pulse(
        &mut self,
        delay: &mut impl DelayNs,
    ) -> Result<(), StepDirError<S::Error, D::Error>> {
        self.set_level(Level::Low)?;
        delay.delay_ns(self.timing.pause_ns);
        Ok(())
    }

    /// Gives the pins back: step, direction.
    pub fn into_pins(self) -> (S, D) {
        (self.step, self.direction)
    }
}

/// The level of an active or inactive line.
fn level(polarity: Polarity, active: bool) -> PinState {
    PinState::from(match polarity {
        Polarity::ActiveHigh => active,
        Polarity::ActiveLow => !active,
    })
}
