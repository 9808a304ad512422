//! Numbers as a person reads them: six digits, no more.

use core::fmt::{Display, Error, Formatter, Result, Write};

use nalgebra::RealField;

/// Displays a number rounded to six significant digits, without trailing zeros, with an
/// exponent where it would be long: `264`, `0.00012`, `6.71089e7`.
pub(crate) struct Digits<T>(pub(crate) T);

/// Digits after the first one.
const REST: i16 = 5;
/// Largest number of decimals; what would have more gets an exponent.
const MAX_DECIMALS: i16 = 2 * REST;

impl<T: RealField + Copy> Display for Digits<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Self(number) = *self;
        if !number.is_finite() {
            return Display::fmt(&number, f);
        }
        let (mantissa, exponent) = scientific(number);
        let decimals = REST - exponent;
        let mut text = Text::default();
        if (0..=MAX_DECIMALS).contains(&decimals) {
            let decimals = usize::from(decimals.unsigned_abs());
            write!(text, "{number:.decimals$}")?;
            f.write_str(text.without_zeros()?)
        } else {
            let decimals = usize::from(REST.unsigned_abs());
            write!(text, "{mantissa:.decimals$}")?;
            write!(f, "{}e{exponent}", text.without_zeros()?)
        }
    }
}

/// A mantissa that is rounded to one digit before the point, and the power of ten.
fn scientific<T: RealField + Copy>(number: T) -> (T, i16) {
    let ten: T = nalgebra::convert(10.0);
    // What is more is rounded to ten.
    let max: T = nalgebra::convert(9.999_995);
    let (mut mantissa, mut exponent) = (number, 0);
    while mantissa.abs() >= max {
        mantissa /= ten;
        exponent += 1;
    }
    while mantissa != T::zero() && (mantissa * ten).abs() < max {
        mantissa *= ten;
        exponent -= 1;
    }
    (mantissa, exponent)
}

/// A number's text, without heap.
#[derive(Default)]
struct Text {
    bytes: [u8; 24],
    length: usize,
}

impl Text {
    fn without_zeros(&self) -> core::result::Result<&str, Error> {
        let bytes = self.bytes.get(..self.length).ok_or(Error)?;
        let text = core::str::from_utf8(bytes).map_err(|_| Error)?;
        Ok(if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            text
        })
    }
}

impl Write for Text {
    fn write_str(&mut self, text: &str) -> Result {
        let end = self.length + text.len();
        self.bytes
            .get_mut(self.length..end)
            .ok_or(Error)?
            .copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate alloc;
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn numbers_are_rounded_to_six_digits() {
        for (number, text) in [
            (264.0, "264"),
            (-1.0, "-1"),
            (0.0, "0"),
            (1.0 / 3.0, "0.333333"),
            (999_999.6, "1e6"),
            (999_999.0, "999999"),
            (67_108_864.0, "6.71089e7"),
            (0.000_012_345_678, "0.0000123457"),
            (0.000_001_2, "1.2e-6"),
            (f64::MAX, "1.79769e308"),
            (-5e-324, "-4.94066e-324"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(Digits(number).to_string(), text);
        }
        assert_eq!(Digits(0.1f32).to_string(), "0.1");
    }
}
