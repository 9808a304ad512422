//! The two-axis stage of \[Stage\]: ball screws with 100 steps/mm, scales with 500 counts/mm, four
//! limit switches.
//!
//! ```text
//! G-code -> lines and arcs in mm -> curves -> rows -> pulses -> simulated motors, which may lose some
//!                                                       ^                      |
//!                                                       +-- corrections <--- linear scales
//! ```
//! Where the machine file has masses, motors and modes, rows are within the motors' torque, and
//! each axis is shaped for its table. The simulated stage gets nothing but the pulses. Beside it
//! runs one without corrections. Text and bytes in, values out: no files, no printing.
//!
//! ```
//! use stage::{Machine, Program, Settings, run};
//!
//! let machine = Machine::parse(stage::MACHINE)?;
//! let program = Program::parse(stage::TEST)?;
//! let settings = Settings { lose_steps: 0.001, ..Settings::default() };
//! let mut steps = 0;
//! let run = run(&machine, &program, &settings, &mut |_, _| {
//!     steps += 1;
//!     Ok(())
//! })?;
//! println!("{steps} moves\n{}", run.report());
//! assert!(run.picture().to_string().contains("<svg"));
//! # Ok::<(), anyhow::Error>(())
//! ```
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod controller;
mod drive;
mod gcode;
mod grid;
mod load;
mod machine;
mod motion;
mod motors;
mod paths;
mod picture;
mod planned;
mod record;
mod report;
mod run;
mod session;
mod settings;
mod stage;
mod step_log;
mod timed;
mod unshaped;

pub use self::controller::{StepObserver, run};
pub use self::gcode::Program;
pub use self::machine::Machine;
pub use self::paths::PathRule;
pub use self::record::{Leg, Seen, TimedRow};
pub use self::report::Report;
pub use self::run::Run;
pub use self::session::Session;
pub use self::settings::{Settings, Stepping};
pub use self::stage::switches_mm;
pub use self::step_log::StepLog;

/// The machine of the source, in TOML.
pub const MACHINE: &str = include_str!("../machine.toml");

/// The test path of the source: rectangle, diagonal, circle.
pub const TEST: &str = include_str!("../drawings/test.gcode");
