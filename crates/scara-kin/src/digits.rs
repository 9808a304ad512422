//! Numbers in messages, as a person reads them.

use core::fmt;

use nalgebra::RealField;
use trig_kernels::SixDigits;

/// Shows a number of either type with six significant digits at most.
#[derive(Clone, Copy)]
pub(crate) struct Digits<T>(pub(crate) T);

impl<T: RealField + Copy> fmt::Display for Digits<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Each float type has its numbers in f64.
        SixDigits(nalgebra::convert_unchecked(self.0)).fmt(f)
    }
}
