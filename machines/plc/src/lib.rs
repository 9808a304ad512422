//! A PC and a PLC that write and read each other's data blocks at the same time: RK512 over 3964R,
//! on a line that may damage bytes.
//!
//! ```text
//! Side (RK512 endpoint, memory, work) <-> 3964R station <-- line --> 3964R station <-> Side
//! ```
//! What the stations report goes in with the time, telegrams for them come out. Stations and line
//! are the caller's: a driver on a port, or a station on a simulated line.
//!
//! ```
//! use core::time::Duration;
//!
//! use plc::{Role, Side};
//! use proto3964r::{Event, Line, Station};
//!
//! let mut pc = Side::new(Role::Pc, 1)?;
//! let mut station = Station::<{ plc::MAX_TELEGRAM }>::new(Role::Pc.line_config(Line::Instant));
//! let now = Duration::ZERO;
//! pc.handle(now, None)?;
//! let telegram = pc.poll_transmit(now).expect("the first data block is to be written");
//! station.submit(now, &telegram)?;
//! // The station clears the line with NAK and asks with STX.
//! assert_eq!(station.poll_transmit_byte(now), Some(0x15));
//! assert_eq!(station.poll_transmit_byte(now), Some(0x02));
//! # Ok::<(), anyhow::Error>(())
//! ```
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod damaging_line;
mod order;
mod report;
mod side;

pub use self::damaging_line::{DamagingLine, Spacing};
pub use self::report::{Report, Traffic};
pub use self::side::{Role, Side};
pub use rk512::MAX_TELEGRAM;
