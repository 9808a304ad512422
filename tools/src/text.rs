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

/// Seconds, not negative: `1.5`.
///
/// # Errors
/// The text, in a sentence.
pub fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok();
    let time = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    time.ok_or_else(|| format!("`{text}` is not a time in seconds"))
}

/// A time as captures have it: `0.004200`.
#[must_use]
pub fn time(time: Duration) -> String {
    format!("{}.{:06}", time.as_secs(), time.subsec_micros())
}
