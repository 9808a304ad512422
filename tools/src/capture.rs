//! Captures of both directions of a line: read, told step by step, and judged.
//!
//! A capture is text, one line per piece: the time in seconds, the direction (`>` from A to B, `<`
//! from B to A), and hexadecimal bytes. `?` after a byte: it came in with a wrong parity bit; `!`:
//! without a stop bit, as BREAK does, which reads `00!`. `#` begins a comment. Time never runs
//! backwards.
//!
//! ```
//! use line3964r::capture::{self, Tap};
//! use monitor3964r::Verdict;
//! use proto3964r::{Config, Line, Priority};
//!
//! # fn main() -> Result<(), capture::CaptureError> {
//! let text = "
//!     0.000000 > 02
//!     0.003000 < 10
//!     0.004200 > 41 10 03 52
//!     0.009000 < 10
//! ";
//! let mut tap = Tap::new(Config::siemens_3964r(Priority::Low, Line::Instant));
//! for character in capture::read(text)? {
//!     for step in tap.hear(character) {
//!         println!("{} s: {}", step.at.as_secs_f64(), step.text);
//!     }
//! }
//! assert_eq!(tap.verdict().verdict, Verdict::Works);
//! # Ok(())
//! # }
//! ```

mod pcapng;
mod report;
mod step;
mod tap;

use core::time::Duration;

use monitor3964r::{Character, Side};
use proto3964r::CharacterError;
use thiserror::Error;

pub use self::{
    pcapng::PcapngWriter,
    report::Report,
    step::{Kind, Step},
    tap::Tap,
};
use crate::text;

/// What is wrong with a capture, and in which line.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{line}: {message}")]
#[non_exhaustive]
pub struct CaptureError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub message: String,
}

/// All characters of a capture, in the order of time.
///
/// # Errors
/// The first line that is none of a capture.
pub fn read(text: &str) -> Result<Vec<Character>, CaptureError> {
    let mut record = Vec::new();
    let mut before = Duration::ZERO;
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.split('#').next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        let fails = |message| CaptureError { line, message };
        let at = read_line(content, &mut record).map_err(fails)?;
        if at < before {
            let (at, before) = (text::time(at), text::time(before));
            return Err(fails(format!("time runs backwards: {at}s after {before}s")));
        }
        before = at;
    }
    Ok(record)
}

/// Appends the characters of a line; returns their time.
fn read_line(line: &str, record: &mut Vec<Character>) -> Result<Duration, String> {
    let mut words = line.split_whitespace();
    let at = text::seconds(words.next().unwrap_or_default())?;
    let side = match words.next() {
        Some(">") => Side::A,
        Some("<") => Side::B,
        Some(other) => return Err(format!("`{other}` is neither `>` nor `<`")),
        None => return Err("no direction after the time".to_owned()),
    };
    let before = record.len();
    for word in words {
        read_word(word, |byte, error| {
            record.push(Character {
                at,
                side,
                byte,
                error,
            });
        })?;
    }
    if record.len() == before {
        return Err("no bytes after the direction".to_owned());
    }
    Ok(at)
}

/// `41`, `4142`, or a damaged byte with its mark.
fn read_word(word: &str, mut push: impl FnMut(u8, Option<CharacterError>)) -> Result<(), String> {
    let (digits, error) = if let Some(digits) = word.strip_suffix('?') {
        (digits, Some(CharacterError::Parity))
    } else if let Some(digits) = word.strip_suffix('!') {
        (digits, Some(CharacterError::Framing))
    } else {
        (word, None)
    };
    let mut bytes = Vec::new();
    let read = text::word_bytes(digits, &mut bytes);
    if read.is_none() || (error.is_some() && bytes.len() != 1) {
        return Err(format!("`{word}` is not made of hexadecimal bytes"));
    }
    bytes.into_iter().for_each(|byte| push(byte, error));
    Ok(())
}

/// The record in pieces, each of which one side sent at one time; a damaged character is a piece of
/// its own.
pub fn pieces(record: &[Character]) -> impl Iterator<Item = &[Character]> {
    record.chunk_by(|one, next| {
        let is_intact = one.error.is_none() && next.error.is_none();
        is_intact && one.at == next.at && one.side == next.side
    })
}

/// A character as a line of a capture.
///
/// ```text
/// 0.004200 > 41
/// ```
#[must_use]
pub fn line(character: &Character) -> String {
    let direction = match character.side {
        Side::A => '>',
        Side::B => '<',
    };
    let mark = match character.error {
        None => "",
        Some(CharacterError::Framing) => "!",
        Some(_) => "?",
    };
    let at = text::time(character.at);
    format!("{at} {direction} {:02X}{mark}", character.byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        let text = "0.000000 > 02\n0.003000 < 41?\n1.000001 < 00!\n";
        let record = read(text).unwrap();
        let written: String = record.iter().map(|heard| line(heard) + "\n").collect();
        assert_eq!(written, text);
        assert_eq!(record[1].error, Some(CharacterError::Parity));
        assert_eq!(record[2].error, Some(CharacterError::Framing));
    }

    #[test]
    fn a_mark_belongs_to_one_byte() {
        for word in ["4142?", "?", "4?1", "41??", "!"] {
            let error = read(&format!("0 > 02\n0 > {word}")).unwrap_err();
            let message = format!("2: `{word}` is not made of hexadecimal bytes");
            assert_eq!(error.to_string(), message);
        }
    }
}
