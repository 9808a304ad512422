#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod angles;
mod calibrate;
mod fit;
mod locator;
mod number;
mod platform;
mod rotation;
#[cfg(feature = "serde")]
mod serde;
mod short;
mod svd;

pub use nalgebra;
pub use trig_kernels::Trig;

pub use angles::{Convention, PoseVector, Resolved};
pub use calibrate::{Calibration, CalibrationError, calibrate};
pub use fit::{FitError, PointSet, RigidFit, rigid_fit};
pub use locator::{Axis, Locator, LocatorAxis};
pub use platform::{BodyFit, DistanceError, LimitError, Platform, PlatformError};
pub use rotation::{
    NotARotation, angle_between, from_matrix, from_rotation_vector, rotation_vector,
    rotation_vector_between, slerp, to_matrix,
};

#[cfg(feature = "path-timing")]
mod body_path;
mod distance_error;
mod leg_axes;
mod path;
mod pt;
mod pt_error;
mod segmentation;
mod turn;

#[cfg(feature = "path-timing")]
pub use body_path::{BodyPath, BodyPathError, BodyPaths, hermite_distance_error};
pub use path::{Blend, Interpolation, Leg, PosePath, PosePathError};
pub use pt::{PtPoint, PtPoints, PtTable};
pub use pt_error::PtError;
pub use segmentation::Segmentation;
