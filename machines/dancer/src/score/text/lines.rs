//! Where in a text something is: its line, and the part of the score.

use serde::Deserialize;
use serde::de::IgnoredAny;
use toml::Spanned;

use crate::score::{ScoreError, ScoreErrorKind, ScorePart};

/// Where the lines of a text end: looked for once, not again for each part.
pub(super) struct Lines {
    ends: Vec<usize>,
}

impl Lines {
    pub(super) fn of(text: &str) -> Self {
        let ends = text.match_indices('\n').map(|(end, _)| end);
        Self {
            ends: ends.collect(),
        }
    }

    /// Line of an offset, from 1.
    pub(super) fn line(&self, offset: usize) -> u32 {
        let before = self.ends.partition_point(|end| *end < offset);
        u32::try_from(before).unwrap_or(u32::MAX).saturating_add(1)
    }
}

/// The TOML reader's message, with line and part of the score.
pub(super) fn text_error(text: &str, error: &toml::de::Error) -> ScoreError {
    let offset = error.span().map_or(0, |span| span.start);
    let kind = ScoreErrorKind::Text {
        message: error.message().replace('\n', ", "),
    };
    ScoreError {
        line: Lines::of(text).line(offset),
        part: part(text, offset),
        kind,
    }
}

/// Where the parts are in the text, whatever is in them.
#[derive(Deserialize)]
struct Outline {
    #[serde(default)]
    motor: Vec<Spanned<IgnoredAny>>,
    #[serde(default, rename = "move")]
    moves: Vec<Spanned<IgnoredAny>>,
}

/// The part that an offset is in: the last one that starts before. In a text that is no TOML only
/// the parts under a header of their own are seen.
fn part(text: &str, offset: usize) -> ScorePart {
    let starts = match toml::from_str::<Outline>(text) {
        Ok(Outline { motor, moves }) => {
            let starts = |parts: Vec<Spanned<IgnoredAny>>| -> Vec<usize> {
                parts.iter().map(|part| part.span().start).collect()
            };
            [starts(motor), starts(moves)]
        }
        Err(_) => ["[[motor]]", "[[move]]"].map(|header| {
            let headers = text.match_indices(header);
            headers.map(|(start, _)| start).collect()
        }),
    };
    let [motor, last_move] = starts.map(|starts| {
        let before = (1..).zip(starts).take_while(|(_, start)| *start <= offset);
        before.last()
    });
    match (motor, last_move) {
        (Some((_, motor)), Some((number, start))) if start > motor => ScorePart::Move(number),
        (None, Some((number, _))) => ScorePart::Move(number),
        (Some((number, _)), _) => ScorePart::Motor(number),
        (None, None) => ScorePart::Head,
    }
}
