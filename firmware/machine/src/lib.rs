#![doc = include_str!("../README.md")]
#![no_std]
#![warn(unreachable_pub)]

mod blocks;
mod command;
mod homing;
mod motion;
mod panel;
mod pulses;
mod reason;
mod settings;
mod talk;

pub use command::{Command, CommandError, Job, Joint};
pub use motion::{Motion, PlanMemory};
pub use panel::{Panel, State};
pub use pulses::{Block, BlockEnd, Word};
pub use settings::{Machine, Settings, SettingsError};
pub use talk::talk;

/// Longest answer, in bytes.
const MAX_ANSWER: usize = 160;

/// An answer to a command, or what became of it.
pub type Text = heapless::String<MAX_ANSWER>;

/// A text of what is formatted; what does not fit is left out.
macro_rules! text {
    ($($arguments:tt)*) => {{
        let mut text = $crate::Text::new();
        let _ = core::fmt::Write::write_fmt(&mut text, format_args!($($arguments)*));
        text
    }};
}
use text;
