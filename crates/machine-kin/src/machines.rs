//! Machines, each by its inverse kinematics alone.

mod core_xy;
mod five_bar;
mod hanging_plotter;
mod linear_delta;
mod polar;
mod scara;
mod with_z;

use core::fmt::{self, Display, Formatter};

use trig_kernels::SixDigits;

pub use core_xy::{CoreXy, HBot};
pub use five_bar::{Elbow, FiveBar};
pub use hanging_plotter::HangingPlotter;
pub use linear_delta::LinearDelta;
pub use polar::{CarriageSide, Polar};
pub use scara::Scara;
pub use with_z::WithZ;

/// A length of a machine that none can be built with.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct GeometryError {
    /// Its name.
    pub name: &'static str,
    /// The value given.
    pub value: f64,
    /// What it must be above: 0, or the length at which at most one place is within reach.
    pub above: f64,
}

impl Display for GeometryError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, value, above } = *self;
        write!(
            f,
            "{name} {} is not above {} and at most 1e50",
            SixDigits(value),
            SixDigits(above)
        )
    }
}

impl core::error::Error for GeometryError {}

/// Refuses the first length that is not above 0 and of a size to compute with.
fn check_lengths<const N: usize>(lengths: [(&'static str, f64); N]) -> Result<(), GeometryError> {
    lengths.into_iter().try_for_each(|(name, value)| {
        if (1e-50..=1e50).contains(&value) {
            Ok(())
        } else {
            Err(GeometryError {
                name,
                value,
                above: 0.0,
            })
        }
    })
}

/// Refuses a length with which the machine reaches no place, or one alone.
fn check_reach(name: &'static str, value: f64, above: f64) -> Result<(), GeometryError> {
    if value > above {
        Ok(())
    } else {
        Err(GeometryError { name, value, above })
    }
}
