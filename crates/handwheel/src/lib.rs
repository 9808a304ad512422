#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod command;
mod driver;
mod lcd;
mod number;
mod report;
mod text;
mod wheel;

pub use command::{Command, LedState, MAX_COMMAND};
pub use driver::{Driver, Event, Failure, Job, SubmitError, Timing};
pub use lcd::{Cell, Font, LcdBlock, LcdCommand, LcdCommands, LcdError, Rect};
pub use number::{AreaNumber, Column, Key, Led, Line, NumberError, Position, TextNumber};
pub use report::{
    DecodeError, EncodeError, LcdAnswer, MAX_REPORT, Model, Report, RotarySwitch, Status,
};
pub use text::Text;
pub use wheel::{WheelError, WheelQuantiser, WheelSampler};
