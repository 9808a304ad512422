//! The alignment platform of \[Alignment 2010\]: a body on three to six three-axis locators, moved
//! by an operator with a hand-held pendant.
//!
//! ```text
//! operator -> pendant -> 3964R on a line -> driver -> panel -> jogs, pose change
//!             pendant <- 3964R <- display blocks, LEDs <-----+
//!             pose change -> PT or PVT table -> locators, each axis for itself
//! ```
//! The simulated locators get nothing but the table. Time is counted, not waited for: bytes take as
//! long as at 9600 bit/s, and the same input gives the same output. Text and bytes in, values out:
//! no files, no printing, no threads, no clock.
//!
//! ```
//! use platform::{Alignment, Machine, run};
//!
//! let machine = Machine::parse(platform::PLATFORM)?;
//! let alignment = Alignment {
//!     to: Some([10.0, 0.0, 1200.0, 0.0, 0.0, 0.5]),
//!     ..Alignment::default()
//! };
//! // A wire that brings every byte to the other end.
//! let run = run(&machine, &alignment, &mut |_, byte| Ok(byte))?;
//! println!("{}", run.report());
//! assert!(run.report().is_within_bounds());
//! assert!(run.align_picture().to_string().contains("<svg"));
//! # Ok::<(), anyhow::Error>(())
//! ```
//!
//! The operator's panel can be had alone:
//!
//! ```
//! use handwheel::{Key, Position, Status, WheelQuantiser};
//! use platform::{Action, Arbiter, Axis, Input, Panel, PanelSettings, PendantId, Target};
//!
//! let wheel = WheelQuantiser::new(100, 10)?; // 100 counts in 200 ms are full speed, 10 bins below
//! let mut arbiter = Arbiter::<3>::new(); // three locators, shared by all panels
//! let mut panel = Panel::new(PendantId(1), PanelSettings::new(wheel))?;
//!
//! let (w1, w2) = (Position::new(3)?, Position::new(2)?); // multiplier x100, direction Y
//! panel.handle(Input::Status(Status::Hbls { key: None, w1, w2 }), &mut arbiter);
//! panel.handle(Input::Enable { left: false, right: false }, &mut arbiter);
//! panel.handle(Input::Key(Some(Key::new(3)?)), &mut arbiter); // enter: opens locator 1
//! panel.handle(Input::Enable { left: true, right: true }, &mut arbiter);
//! let jog = panel.handle(Input::Wheel(-57), &mut arbiter); // 57 counts lie in the bin around 55
//! assert_eq!(jog, Some(Action::Jog { locator: 0, axis: Axis::Y, speed_um_s: -5_500 }));
//! let stop = panel.handle(Input::Enable { left: true, right: false }, &mut arbiter);
//! assert_eq!(stop, Some(Action::Stop(Target::Locator(0))));
//! # Ok::<(), anyhow::Error>(())
//! ```
//! It is not a safety device. It starts no motion without both enabling switches and stops when one
//! is released; a machine still needs the switches in its safety circuit.
#![warn(clippy::print_stdout, clippy::print_stderr)]

extern crate alloc;

mod alignment;
mod arbiter;
mod desk;
mod drives;
mod examination;
mod line;
mod machine;
mod mode;
mod moments;
mod operator;
mod panel;
mod pendant;
mod picture;
mod planner;
mod pose;
mod report;
mod screen;
mod settings;
mod table;
mod workstation;
mod world;

pub use self::alignment::{Alignment, Run, run};
pub use self::arbiter::{Arbiter, PendantId, Refused, Target};
pub use self::desk::{Desk, Hand, Seen};
pub use self::line::{Side, Wire};
pub use self::machine::Machine;
pub use self::mode::Mode;
pub use self::moments::PlatformAt;
pub use self::panel::{
    Action, Axis, Input, Panel, PanelSettings, PanelSettingsError, PoseChange, Refusal,
};
pub use self::pose::{Pose, parse_pose};
pub use self::report::Report;
pub use self::screen::{Screen, Shown};

/// An aircraft panel on three locators about 4 m apart.
pub const PLATFORM: &str = include_str!("../platform.toml");
