//! The glass engraver of [Engraver 2000]: two revolute joints with parallel axes, a disc that turns
//! with the tangent, a lift; four steppers on one 8051.
//!
//! ```text
//! SVG -> strokes -> joint waypoints -> pattern bytes
//!        pattern bytes -> records -> pulse trains -> simulated arm -> tool path
//! ```
//!
//! The second line reads nothing but the bytes of the first. Beside it, [`TimedPlan`] brings the
//! same drawing to the motors without a pattern: its curves, timed by `path-timing`, as edges. Text
//! and bytes in, values out: no files, no printing.
//!
//! ```
//! use engraver::{Drawing, Machine, Plan, PlanSettings, Report, simulate};
//!
//! let machine = Machine::parse(engraver::MACHINE)?;
//! let drawing = Drawing::parse(engraver::ROSETTE)?;
//! let plan = Plan::new(&machine, &drawing, &PlanSettings::default(), |_, _| ())?;
//! let run = simulate(&machine, plan.pattern(), plan.reference(), &mut (), |_, _| ())?;
//! assert!(run.is_within_bound());
//! println!("{}", Report::new(&machine, &drawing, &plan, &run));
//! # Ok::<(), anyhow::Error>(())
//! ```
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod calibration;
mod controller;
mod drawing;
mod engraving;
mod gauge;
mod header;
mod layout;
mod load;
mod machine;
mod motors;
mod numbers;
mod order;
mod picture;
mod placement;
mod plan;
mod plan_settings;
mod pulse_log;
mod report;
mod simulation;
mod timed;
mod tool_speed;
mod tool_trace;
mod view;

pub use self::calibration::{Calibrated, Fit};
pub use self::controller::Wires;
pub use self::drawing::Drawing;
pub use self::engraving::{Engraving, MotorController};
pub use self::header::header;
pub use self::machine::Machine;
pub use self::placement::{Bed, Placement};
pub use self::plan::{Plan, Reference};
pub use self::plan_settings::{PlanSettings, Tolerance};
pub use self::pulse_log::PulseLog;
pub use self::report::Report;
pub use self::simulation::{Run, simulate};
pub use self::timed::{TimedLimits, TimedPlan, TimedRow, simulate_timed};

/// The machine of the source, in TOML.
pub const MACHINE: &str = include_str!("../machine.toml");

/// The same with a head whose mass and mode are known, as fast as its motors turn that.
pub const LOADED: &str = include_str!("../loaded.toml");

/// A drawing with curves of all kinds.
pub const ROSETTE: &str = include_str!("../drawings/rosette.svg");
