//! Numbers in messages, rounded to the digits that a person reads.

use core::fmt::{self, Write};

/// Displays six digits of a number, without zeros at their end, as the messages of the crates on
/// this one do: `0.0123457`, `-310`, `1e300`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "a number")]
pub struct SixDigits(pub f64);

/// Exponents of the numbers that are written without one; the last has all six digits before the
/// point.
const PLAIN: core::ops::RangeInclusive<i32> = -4..=5;

impl fmt::Display for SixDigits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = *self;
        let mut text = Text::default();
        write!(text, "{value:.5e}")?;
        let Some((mantissa, exponent)) = text.as_str()?.split_once('e') else {
            // Infinite, or not a number.
            return write!(f, "{value}");
        };
        let power: i32 = exponent.parse().map_err(|_| fmt::Error)?;
        if !PLAIN.contains(&power) {
            return write!(f, "{}e{exponent}", without_zeros(mantissa));
        }
        let decimals = usize::try_from(5 - power).map_err(|_| fmt::Error)?;
        let mut text = Text::default();
        write!(text, "{value:.decimals$}")?;
        f.write_str(without_zeros(text.as_str()?))
    }
}

/// The digits without zeros after the decimal point that say nothing.
fn without_zeros(digits: &str) -> &str {
    if digits.contains('.') {
        digits.trim_end_matches('0').trim_end_matches('.')
    } else {
        digits
    }
}

/// A number's characters: a sign, a point, an exponent, and at most ten digits.
#[derive(Default)]
struct Text {
    bytes: [u8; 24],
    length: usize,
}

impl Text {
    fn as_str(&self) -> Result<&str, fmt::Error> {
        let bytes = self.bytes.get(..self.length).ok_or(fmt::Error)?;
        str::from_utf8(bytes).map_err(|_| fmt::Error)
    }
}

impl Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.length.saturating_add(text.len());
        let room = self.bytes.get_mut(self.length..end).ok_or(fmt::Error)?;
        room.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate alloc;

    use alloc::string::ToString;

    use super::SixDigits;

    #[test]
    fn six_digits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "-0"),
            (-310.0, "-310"),
            (10.000_000_000_000_002, "10"),
            (0.1 + 0.2, "0.3"),
            (0.012_345_678, "0.0123457"),
            (1_234.567_89, "1234.57"),
            (999_999.4, "999999"),
            (999_999.6, "1e6"),
            (1e-4, "0.0001"),
            (9.999_999e-5, "0.0001"),
            (1.234_567_89e-5, "1.23457e-5"),
            (1e300, "1e300"),
            (-f64::MAX, "-1.79769e308"),
            (5e-324, "4.94066e-324"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(SixDigits(value).to_string(), text, "{value:e}");
        }
    }
}
