//! Two stations of `proto3964r` on wires that are simulated bit by bit, with the faults of real
//! lines: another parity or baud rate, open wires, echo, noise, late answers, another check
//! character. A tap hears both directions, as that of `line3964r monitor` does.
//!
//! ```
//! use core::time::Duration;
//! use line_sim::{Faults, Frame, Simulation, StationSettings};
//! use monitor3964r::{Side, Verdict, diagnose};
//! use proto3964r::{Config, Line, Priority};
//!
//! let config = |priority| Config::siemens_3964r(priority, Line::paced(9600, 11));
//! let a = StationSettings { config: config(Priority::High), frame: Frame::USUAL };
//! let b = StationSettings { config: config(Priority::Low), frame: Frame::USUAL };
//! let mut line = Simulation::new([a, b], 1);
//! line.set_faults(Side::A, Faults { is_deaf: true, ..Faults::NONE });
//! line.submit(Side::A, b"tare").unwrap();
//! line.submit(Side::B, b"weight").unwrap();
//! line.run_until(Duration::from_secs(5));
//! let diagnosis = diagnose(line.heard(), &config(Priority::Low));
//! assert_eq!(diagnosis.verdict, Verdict::NotHeard { speaker: Side::B, listener: Side::A });
//! ```

mod bench;
mod end;
mod faults;
mod simulation;
mod steps;
mod uart;

pub use self::bench::Bench;
pub use self::end::StationSettings;
pub use self::faults::Faults;
pub use self::simulation::{Happening, Simulation};
pub use self::uart::{Frame, Parity};

/// Longest telegram of a station, in bytes.
pub const BLOCK: usize = 1024;
