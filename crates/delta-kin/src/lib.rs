#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod arm;
mod assembly;
mod calibrate;
mod delta;
mod dynamics;
mod follow;
mod forward;
mod geometry;
mod inverse;
mod limits;
mod modes;
#[cfg(feature = "path-timing")]
mod path;
mod pose;
mod prepared;
mod range;
mod rounded;
#[cfg(feature = "serde")]
mod serde;
mod workspace;

pub use marquardt;
pub use nalgebra;
pub use trig_kernels::Trig;

pub use arm::{Arm, ArmGeometry, Dimensions, ElbowSide};
pub use calibrate::{Calibration, CalibrationError, Measured, Parameter, Quantity};
pub use delta::Delta;
pub use dynamics::{DeltaDynamics, DeltaMasses, DynamicsError};
pub use follow::{Follow, FollowError, PlatformPath, PlatformPathError, SpeedLimits, Waypoint};
pub use forward::ForwardError;
pub use geometry::GeometryError;
pub use inverse::InverseError;
pub use limits::ArmRange;
pub use modes::{AssemblyMode, Positive, ZAxis};
#[cfg(feature = "path-timing")]
pub use path::{DeltaPath, DeltaPathError};
pub use pose::{Pose, PoseError};
pub use workspace::WorkspaceError;
