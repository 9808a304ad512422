//! Drivers of pins with the traits of [`embedded-hal`](https://docs.rs/embedded-hal) 1.

mod step_dir;
mod winding_pins;

pub use step_dir::{StepDir, StepDirError};
pub use winding_pins::WindingPins;
