//! Drivers of pins with the traits of [`embedded-hal`](https://docs.rs/embedded-hal) 1.

mod step_dir;
mod winding_pins;

pub use step_dir::{StepDir, StepDirError, StepDirTiming};
pub use winding_pins::WindingPins;

use crate::Polarity;
use embedded_hal::digital::PinState;

/// The level of an active or inactive line.
fn level(polarity: Polarity, active: bool) -> PinState {
    PinState::from(match polarity {
        Polarity::ActiveHigh => active,
        Polarity::ActiveLow => !active,
    })
}
