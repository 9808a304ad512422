//! Numbers in messages, as a person reads them.

use core::fmt;

use nalgebra::{ComplexField, RealField};

/// Shows a number with six significant digits at most.
#[derive(Clone, Copy)]
pub(crate) struct Rounded<T>(pub(crate) T);

impl<T: RealField> fmt::Display for Rounded<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value: f64 = nalgebra::convert_unchecked(self.0.clone());
        let size = value.abs();
        if size > 0.0 && !(1e-4..1e7).contains(&size) {
            return write!(f, "{value:.4e}");
        }
        let mut scale = 1.0;
        while size > 0.0 && size * scale < 1e5 {
            scale *= 10.0;
        }
        write!(f, "{}", ComplexField::round(value * scale) / scale)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::format;

    use super::*;

    #[test]
    fn six_digits_are_shown() {
        for (value, text) in [
            (12.894_196_3, "12.8942"),
            (-1.0, "-1"),
            (0.0, "0"),
            (0.001_234_567_89, "0.00123457"),
            (423.0, "423"),
            (1_234_567.8, "1234568"),
            (9_999_999.0, "9999999"),
            (1e300, "1.0000e300"),
            (-2.5e-12, "-2.5000e-12"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(format!("{}", Rounded(value)), text);
        }
        assert_eq!(format!("{}", Rounded(0.1f32)), "0.1");
    }
}
