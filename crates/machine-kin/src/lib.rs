#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod gradient;
mod interval;
mod jet;
mod machine;
mod machines;
mod matrix;
mod model;
mod number;
mod path;

pub use path_timing;

pub use gradient::Gradient;
pub use interval::Interval;
pub use jet::Jet;
pub use machine::{Axis, Machine};
pub use machines::{
    CarriageSide, CoreXy, Elbow, FiveBar, GeometryError, HBot, HangingPlotter, LinearDelta, Polar,
    Scara, WithZ,
};
pub use number::{Number, Refusal};
pub use path::{MachinePath, PathError};
