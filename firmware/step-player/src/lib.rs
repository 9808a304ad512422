#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "_rp")]
mod pio;
mod source;
#[cfg(feature = "stm32")]
mod stm32;
#[cfg(any(feature = "stm32", test))]
mod ticks;

#[cfg(feature = "_rp")]
pub use pio::PioPlayer;
pub use source::{Source, Word};
#[cfg(feature = "stm32")]
pub use stm32::{DmaPlayer, PinsError, RING};
