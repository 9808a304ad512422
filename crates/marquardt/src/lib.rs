#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod calibration;
mod fit;
mod jacobian;
mod number;
mod rank;

pub use calibration::Calibration;
pub use fit::{LeastSquares, NotConverged, Problem, fit};
pub use jacobian::Jacobian;
