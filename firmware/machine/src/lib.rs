#![doc = include_str!("../README.md")]
#![no_std]
#![warn(unreachable_pub)]

mod arcs;
mod blocks;
mod command;
mod double;
mod homing;
mod inputs;
mod kinematics;
mod loops;
mod motion;
mod panel;
mod pulses;
mod scales;
mod settings;
mod settings_error;
mod talk;

pub use command::{Command, CommandError, Job, Turn};
pub use double::product;
pub use inputs::Inputs;
pub use kinematics::{
    ArmGeometry, Axis, DeltaGeometry, Joint, Kinematics, Reasoned, RotaryDelta, Slide,
    StageGeometry, TwoLinkArm, Unit, XyStage,
};
pub use motion::{Motion, PlanMemory};
pub use panel::{Panel, State};
pub use pulses::{Block, BlockEnd};
pub use settings::{Machine, Settings};
pub use settings_error::SettingsError;
pub use step_player::{Source, Word};
pub use talk::talk;

/// Longest answer, in bytes.
const MAX_ANSWER: usize = 192;

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
