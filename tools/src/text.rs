//! Bytes and times as people write them.

use core::time::Duration;

/// Hexadecimal bytes: `41 42`, `4142` or `1`.
///
/// # Errors
/// The word that is none, in a sentence.
pub fn bytes<'t>(words: impl Iterator<Item = &'t str>) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    for word in words {
        word_bytes(word, &mut bytes)
            .ok_or_else(|| format!("`{word}` is not made of hexadecimal bytes"))?;
    }
    Ok(bytes)
}

/// Appends the bytes of a word.
pub(crate) fn word_bytes(word: &str, bytes: &mut Vec<u8>) -> Option<()> {
    let digits: Option<Vec<u32>> = word.chars().map(|digit| digit.to_digit(16)).collect();
    let digits = digits?;
    if digits.is_empty() || (digits.len() > 1 && !digits.len().is_multiple_of(2)) {
        return None;
    }
    for pair in digits.chunks(2) {
        let value = pair.iter().fold(0, |value, digit| 16 * value + digit);
        bytes.push(u8::try_from(value).ok()?);
    }
    Some(())
}

/// Seconds, not negative: `1.5`, `1e-5`. Digits below a nanosecond are dropped.
///
/// # Errors
/// The text, in a sentence.
pub fn seconds(text: &str) -> Result<Duration, String> {
    decimal(text).ok_or_else(|| format!("`{text}` is not a time in seconds"))
}

/// In integers, so that what is written is read as it was.
fn decimal(text: &str) -> Option<Duration> {
    let (number, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let number = number.strip_prefix('+').unwrap_or(number);
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let digits = || whole.chars().chain(fraction.chars());
    if digits().next().is_none() || !digits().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    // So many of them, or of zeros behind, are nanoseconds or more.
    let count = i64::from(exponent.parse::<i32>().ok()?) + i64::try_from(whole.len()).ok()? + 9;
    let count = usize::try_from(count.max(0)).ok()?;
    let mut nanoseconds: u128 = 0;
    for digit in digits().take(count) {
        let value = digit.to_digit(10)?.into();
        nanoseconds = nanoseconds.checked_mul(10)?.checked_add(value)?;
    }
    if nanoseconds > 0 {
        let zeros = count.saturating_sub(digits().count());
        let scale = 10_u128.checked_pow(u32::try_from(zeros).ok()?)?;
        nanoseconds = nanoseconds.checked_mul(scale)?;
    }
    let seconds = u64::try_from(nanoseconds / 1_000_000_000).ok()?;
    let rest = u32::try_from(nanoseconds % 1_000_000_000).ok()?;
    Some(Duration::new(seconds, rest))
}

/// A time as captures have it: `0.004200`.
#[must_use]
pub fn time(time: Duration) -> String {
    format!("{}.{:06}", time.as_secs(), time.subsec_micros())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn seconds_are_read_exactly() {
        for (text, expected) in [
            ("0", Duration::ZERO),
            (".5", Duration::from_millis(500)),
            ("+2.", Duration::from_secs(2)),
            ("1e-05", Duration::from_micros(10)),
            ("12.5E2", Duration::from_secs(1250)),
            ("0e999999999", Duration::ZERO),
            ("5e-999999999", Duration::ZERO),
            ("1.0000000019", Duration::new(1, 1)),
            ("99137816.973999", Duration::new(99_137_816, 973_999_000)),
            ("18446744073709551615.999999999", Duration::MAX),
        ] {
            assert_eq!(seconds(text).unwrap(), expected, "{text}");
        }
        for text in [
            "",
            ".",
            "+",
            "-1",
            "1..2",
            "1,5",
            "1e",
            "e3",
            "0x1",
            "inf",
            "NaN",
            "1 2",
            "18446744073709551616",
            "1e999999999",
            "1e2147483648",
            "٣",
        ] {
            let message = format!("`{text}` is not a time in seconds");
            assert_eq!(seconds(text).unwrap_err(), message);
        }
    }

    proptest! {
        #[test]
        fn a_time_is_read_as_it_was_written(secs in any::<u64>(), micros in 0..1_000_000_u32) {
            let written = time(Duration::new(secs, micros * 1000));
            prop_assert_eq!(seconds(&written).unwrap(), Duration::new(secs, micros * 1000));
        }

        #[test]
        fn nanoseconds_are_read_to_the_last(secs in any::<u64>(), nanos in 0..1_000_000_000_u32) {
            let read = seconds(&format!("{secs}.{nanos:09}")).unwrap();
            prop_assert_eq!(read, Duration::new(secs, nanos));
        }
    }
}
