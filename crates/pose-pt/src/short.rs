//! Numbers in messages, rounded to the digits that a person reads.

use nalgebra::RealField;
use trig_kernels::SixDigits;

/// The number as it stands in a message.
pub(crate) fn short<T: RealField + Copy>(value: &T) -> SixDigits {
    // Each float type has its numbers in f64.
    SixDigits(nalgebra::convert_unchecked(*value))
}
