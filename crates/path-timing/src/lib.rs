#![cfg_attr(not(doctest), doc = include_str!("../README.md"))]
// Not a doctest: its programs need crates that depend on this one, `tests/support` compiles them.
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod accuracy;
mod axes;
mod cubic;
mod curve;
mod departure;
mod error;
mod feed_change;
mod jerk;
mod junction;
mod knot;
mod knots;
mod laying;
mod leg;
mod look_ahead;
mod number;
mod passes;
mod path;
mod place;
mod planner;
mod playback;
mod reciprocals;
mod row;
mod rows;
mod segment;
mod set_points;
mod shaper;
mod short_rows;
mod span;
mod stepping;
mod stretch;
mod table;
mod torque;
mod verify;

pub use accuracy::Accuracy;
pub use axes::{Axes, AxisLimits, ToolLimits};
pub use cubic::Cubic;
pub use curve::{
    Curve, CurveError, CurveMotion, CurvePoint, MotionSeries, Smoothed, TurnMotion, Vertex,
    Waypoint,
};
pub use departure::segments_within;
pub use error::PlanError;
pub use junction::Corner;
pub use knot::Knot;
pub use look_ahead::LookAhead;
pub use path::{Path, PathFn, PathPoint};
pub use playback::{FeedCeiling, FeedError, Playback};
pub use row::Row;
pub use rows::Rows;
pub use set_points::{Cia402Scale, Cia402Target, SetPoint, SetPoints, TargetError};
pub use shaper::{Impulse, Mode, Shaped, ShapedError, Shaper, ShaperError, TryRow};
pub use short_rows::ShortRows;
pub use span::Span;
pub use table::Table;
pub use torque::{
    Dynamics, Friction, TorqueCurve, TorqueCurveError, TorqueLimits, TorqueLookAhead, TorqueTable,
};
pub use verify::{Promise, Verifier, Violation};
