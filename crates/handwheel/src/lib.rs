#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod cells;
mod command;
mod driver;
mod error;
mod lcd;
mod number;
mod report;
mod text;
#[cfg(feature = "tokio")]
pub mod tokio;
mod wheel;

pub use cells::{Cell, Rect};
pub use command::{Command, LedState};
pub use driver::{Driver, Event, Failure, Job, SubmitError, Timeouts};
pub use error::LcdError;
pub use lcd::{Font, LcdBlock, LcdCommand, LcdCommands};
pub use number::{AreaNumber, Column, Key, Led, Line, NumberError, Position, TextNumber};
pub use report::{
    DecodeError, EncodeError, LcdAnswer, MAX_COMMAND, MAX_REPORT, Model, Report, RotarySwitch,
    Status,
};
pub use text::Text;
pub use wheel::{WheelError, WheelQuantiser, WheelSampler};
