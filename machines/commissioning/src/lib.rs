//! What is done once when a machine is set up, and again when it has changed: readings in, settings
//! out.
//!
//! [`read_columns`] takes the columns of a CSV file by their names, [`Fitted`] says what a
//! calibration has found, [`RingDown`] finds the modes in an accelerometer's log, and [`Choice`]
//! the shaper that leaves the least of them at the least smoothing:
//!
//! ```
//! use commissioning::{Choice, RingDown};
//!
//! let log = "#time,accel_x\n".to_owned()
//!     + &(0..1600)
//!         .map(|n| {
//!             let t = f64::from(n) / 1600.0;
//!             format!("{t},{}\n", 2500.0 * (-12.0 * t).exp() * (2.0 * 3.1416 * 42.0 * t).sin())
//!         })
//!         .collect::<String>();
//! let ring_down = RingDown::parse(&log, "accel_x", 0.0..)?;
//! let modes = ring_down.modes()?;
//! println!("{:.1} Hz, damping {:.3}", modes[0].mode.hz, modes[0].mode.damping); // 42.0 Hz, 0.045
//! let choices = Choice::all(&modes, 5000.0)?; // mm/s²
//! println!("{}", choices[0]); // the best first
//! # assert!((modes[0].mode.hz - 42.04).abs() < 0.1);
//! # Ok::<(), anyhow::Error>(())
//! ```
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod choice;
mod columns;
mod fitted;
mod picture;
mod vibration;

pub use self::choice::{Choice, shaper};
pub use self::columns::read_columns;
pub use self::fitted::{Fitted, Unit};
pub use self::picture::picture;
pub use self::vibration::{Found, RingDown};
