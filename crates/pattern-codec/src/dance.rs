//! The frames of the dancing robot: one signed speed per motor, in force for 200 ms \[Dancer\].
//!
//! A frame is a plain `[i8; N]`: any number of motors from 1 to 255, eight in the source. The
//! period is a setting, [`Timing`].
//!
//! | case | decision |
//! |---|---|
//! | speed -128 | a byte like any other, magnitude 128, in every packing and header; plans leave it out, because -(-128) does not fit into the `signed char` of the firmware |
//! | a run of count 0 | error |
//! | a mask with bits of motors that are not there | error |
//! | runs that could be one, speeds in a mask that do not change | read; never written |
//! | bytes that end within a frame or run | error |
//!
//! Five minutes of eight motors are 1500 frames, 12,000 bytes raw: more than the 8 KiB of the
//! AT89C52, where the source has 1.5 K. [`Packing`] has two forms with run lengths, [`Sizes`] and
//! [`ProgramMemory`] say what fits.

mod data_header;
mod packing;
mod size;
mod threshold;
mod timing;
mod unpacking;

pub use data_header::{Data, DataHeader};
pub use packing::Packing;
pub use size::{Fit, ProgramMemory, Sizes};
pub use threshold::{Threshold, ThresholdTooLow};
pub use timing::{Timing, ZeroPeriod};
pub use unpacking::{DecodeError, DecodeErrorKind, Decoded};
