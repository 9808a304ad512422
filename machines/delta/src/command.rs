//! One line of input: `x y z [feed]`, `end`, or a comment.

use anyhow::{Result, anyhow, bail, ensure};
use nalgebra::Point3;

/// What a line asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Command {
    /// Go there in a straight line, at a feed in mm/s if one is given.
    Move {
        to: Point3<f64>,
        feed_mm_s: Option<f64>,
    },
    /// No more lines come.
    End,
}

/// Whether a line is empty or a comment.
pub(crate) fn is_empty(line: &str) -> bool {
    without_comment(line).is_empty()
}

/// The words of a line, without the mark of the text's encoding before the first.
pub(crate) fn without_comment(line: &str) -> &str {
    let line = line.trim_start_matches('\u{FEFF}');
    line.split_once('#').map_or(line, |(words, _)| words).trim()
}

/// The numbers of a line.
pub(crate) fn numbers(words: &str) -> Result<Vec<f64>> {
    let numbers = words.split_whitespace().map(|word| match word.parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ if word.contains([',', ';']) => Err(anyhow!(
            "{word:?} is not a number: blanks separate the numbers of a line"
        )),
        _ => Err(anyhow!("{word:?} is not a number")),
    });
    numbers.collect()
}

/// Reads a line; nothing for an empty one or a comment.
pub(crate) fn parse(line: &str) -> Result<Option<Command>> {
    let line = without_comment(line);
    if line.is_empty() {
        return Ok(None);
    }
    if line.eq_ignore_ascii_case("end") {
        return Ok(Some(Command::End));
    }
    let numbers = numbers(line)?;
    let (x, y, z, feed_mm_s) = match *numbers {
        [x, y, z] => (x, y, z, None),
        [x, y, z, feed] => (x, y, z, Some(feed)),
        _ => bail!(
            "{} numbers in {line:?}, `x y z [feed]` is needed",
            numbers.len()
        ),
    };
    if let Some(feed) = feed_mm_s {
        ensure!(feed > 0.0, "feed {feed} mm/s is not above zero");
    }
    let to = Point3::new(x, y, z);
    Ok(Some(Command::Move { to, feed_mm_s }))
}
