#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod arm;
mod calibrate;
mod digits;
mod drives;
mod dynamics;
mod each;
mod follow;
mod forward;
mod inverse;
mod joints;
mod limits;
#[cfg(feature = "path-timing")]
mod path;
mod range;
#[cfg(feature = "serde")]
mod serde;
mod tangent;
mod velocity;

pub use nalgebra;
pub use trig_kernels::Trig;

pub use arm::{Arm, GeometryError};
pub use calibrate::{Calibration, CalibrationError, DrivenArm, Measured, Parameter};
pub use drives::{DriveAngles, DriveSense, Drives};
pub use dynamics::{ArmDynamics, ArmMasses, DynamicsError, JointDrive, LinkMass};
pub use follow::{Follow, FollowError, Waypoint};
pub use inverse::{InverseError, Solutions};
pub use joints::{Elbow, Joint, Joints};
pub use limits::{JointRange, Limits};
#[cfg(feature = "path-timing")]
pub use path::{ArmPath, ArmPathError, ArmPathF32, DiscPath};
pub use tangent::{TangentError, TangentTool, ToolTurn};
pub use velocity::RatesError;
