#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

extern crate alloc;

mod driven;
mod edge_motion;
mod elastic_mode;
mod figure;
#[cfg(feature = "input")]
pub mod input;
mod motion_sampler;
mod motor;
mod profile;
mod random;
mod scale;
pub mod serial_line;
mod stepper;
mod vcd;

pub use self::driven::{DrivenAxis, Followed, StepSize};
pub use self::edge_motion::{EdgeLog, EdgeMotion, Measured};
pub use self::elastic_mode::ElasticMode;
pub use self::figure::{Axis, Colour, Figure, Mark, Plot, Point, Stroke};
pub use self::motion_sampler::MotionSampler;
pub use self::motor::{Motor, Rotor};
pub use self::profile::Profile;
pub use self::random::Random;
pub use self::scale::{LimitSwitches, Scale};
pub use self::stepper::Stepper;
pub use self::vcd::{VcdError, VcdWriter, Wire};
