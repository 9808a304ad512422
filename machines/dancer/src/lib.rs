//! The dancing robot of \[Dancer\]: eight steppers behind latches on one bus, whose 8051 adds up a
//! speed per motor every tick.
//!
//! ```text
//! score -> frames -> data.h
//!          data.h -> frames -> accumulators -> phases -> bus -> latches -> motors
//! ```
//!
//! The second line reads nothing but the header of the first, and the motors nothing but their
//! latches. Text in, values and text out: no files, no printing.
//!
//! ```
//! use dancer::{Law, MOTORS, Report, Score, simulate};
//! use pattern_codec::dance::Data;
//!
//! let score: Score = dancer::SCORE.parse()?;
//! let dance = score.compile(Law::Reset)?;
//! let header = dancer::header(&score, &dance)?;
//!
//! let data = Data::<MOTORS>::read(&header)?;
//! let run = simulate(&data, Law::Reset, std::io::sink(), |_, _| ())?;
//! let report = Report::new(&score, &dance, &data, &run, 589);
//! assert!(report.is_as_asked());
//! println!("{report}");
//! # Ok::<(), anyhow::Error>(())
//! ```
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod bus_log;
mod easing;
mod header;
mod law;
mod motor;
mod picture;
mod report;
mod score;
mod simulation;
mod turn;

pub use self::easing::Easing;
pub use self::header::header;
pub use self::law::{Law, UnknownLaw};
pub use self::motor::Motor;
pub use self::picture::picture;
pub use self::report::Report;
pub use self::score::{Choreography, Landing, Score, ScoreError, ScoreErrorKind, ScorePart};
pub use self::simulation::{Run, simulate};
pub use self::turn::TurnError;

/// Motors of the robot: one latch and one byte of the frame each.
pub const MOTORS: usize = 8;

/// A dance of five minutes, in TOML.
pub const SCORE: &str = include_str!("../score.toml");
