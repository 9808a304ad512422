#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod axes;
mod chain;
mod cubic;
mod curve;
mod demand;
mod departure;
mod error;
mod joint;
mod leg;
mod look_ahead;
mod number;
mod path;
mod planner;
mod profile;
mod reciprocals;
mod row;
mod rows;
mod run;
mod segment;
mod short;
mod smooth;
mod span;
mod table;
mod utilisation;

pub use axes::{Axes, AxisLimits, ToolLimits};
pub use cubic::Cubic;
pub use curve::{Curve, CurveError, CurveMotion, CurvePoint, Rounded, TurnMotion};
pub use departure::segments_within;
pub use error::PlanError;
pub use joint::Corner;
pub use look_ahead::{LookAhead, Slot};
pub use path::{Legs, Path, PathFn, PathPoint};
pub use row::Row;
pub use rows::Rows;
pub use run::{Ahead, FeedError, Run};
#[doc(hidden)]
pub use short::SixDigits;
pub use span::Span;
pub use table::{Knot, Table};
