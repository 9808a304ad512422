//! The Delta robot of \[Delta thesis\], with geared steppers: points in, steps out, and the steps
//! on a simulated machine.
//!
//! ```text
//! x y z [feed] -> lines, rounded corners -> PVT rows -> steps.csv
//!                 steps.csv -> simulated arms -> path of the platform
//! ```
//!
//! The second line reads nothing but the steps of the first. Text and bytes in, values out: no
//! files, no printing.
//!
//! ```
//! use delta::{Machine, Motion, Session, StepLog, simulate};
//!
//! let machine = Machine::parse(delta::MACHINE)?;
//! let mut log = StepLog::new(Vec::new())?;
//! let mut observer = |ticks, steps| log.step(ticks, steps);
//! let mut session = Session::new(&machine, Motion::Rounded, &mut observer)?;
//! for byte in "50 50 -300\n60 300 -280\n".bytes() {
//!     if let Some(answer) = session.handle_byte(byte)? {
//!         println!("{answer}"); // ok -7799 -12831 -14361, then error: line 2: ...
//!     }
//! }
//! let record = session.finish()?;
//! let run = simulate(&machine, &record, &*log.finish()?)?;
//! println!("{}", run.report());
//! assert!(run.picture()?.to_string().contains("<svg"));
//! # Ok::<(), anyhow::Error>(())
//! ```
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod calibration;
mod command;
mod control_tick;
mod line_reader;
mod load;
mod machine;
mod moments;
mod motion;
mod motors;
mod picture;
mod plan;
mod planned;
mod record;
mod report;
mod rounded;
mod session;
mod simulation;
mod step_log;

pub use self::calibration::{Calibrated, Fit};
pub use self::machine::Machine;
pub use self::moments::ArmsAt;
pub use self::motion::Motion;
pub use self::record::{Record, TimedRow};
pub use self::report::Report;
pub use self::session::{Session, StepObserver, check};
pub use self::simulation::{Drive, Run, drive, simulate};
pub use self::step_log::StepLog;

/// The machine of the source, in TOML.
pub const MACHINE: &str = include_str!("../machine.toml");
