//! Why masses are refused.

use core::fmt::{Display, Formatter};

use nalgebra::RealField;

use crate::digits::Digits;

/// A number that no body has: negative, or not finite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct DynamicsError<T = f64> {
    /// What it is.
    pub name: &'static str,
    /// Its value.
    pub value: T,
}

impl<T: RealField + Copy> Display for DynamicsError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let Self { name, value } = *self;
        write!(f, "{name} is {}, which no body has", Digits(value))
    }
}

impl<T: RealField + Copy> core::error::Error for DynamicsError<T> {}
