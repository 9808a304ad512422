//! A tap on real ports, one for each direction.

use core::time::Duration;

use anyhow::Result;
use line3964r::Preset;
use monitor3964r::{Character, Side};
use proto3964r::{CharacterError, Line, Priority};
use serde::Deserialize;

use super::conversation::{self, Of};
use super::{RECENT, seconds};
use crate::answer::Answer;
use crate::boundary::Request;

/// What a receiver of the browser reports in place of a character.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Damage {
    Parity,
    Framing,
    Overrun,
}

impl From<Damage> for CharacterError {
    fn from(damage: Damage) -> Self {
        match damage {
            Damage::Parity => Self::Parity,
            Damage::Framing => Self::Framing,
            Damage::Overrun => Self::Overrun,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Begin {
    preset: Preset,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Push {
    now_s: f64,
    #[serde(default)]
    is_from_b: bool,
    #[serde(default)]
    bytes: Vec<u8>,
    damage: Option<Damage>,
    /// Whether the verdict is asked for.
    #[serde(default)]
    judge: bool,
}

pub(super) fn begin(request: &Request) -> Result<Answer> {
    let Begin { preset } = request.parameters()?;
    conversation::begin(Of::Tap, preset.config(Priority::Low, Line::Instant));
    Answer::new(())
}

/// What a port has heard, or nothing by now; what that means.
pub(super) fn push(request: &Request) -> Result<Answer> {
    let push: Push = request.parameters()?;
    let now = seconds(push.now_s)?;
    let side = if push.is_from_b { Side::B } else { Side::A };
    conversation::with(Of::Tap, |it| {
        characters(now, side, &push.bytes, push.damage).for_each(|character| it.hear(character));
        it.wait(now);
        if push.judge {
            it.judge_since(now.saturating_sub(RECENT));
        }
        it.answer(())
    })?
}

/// Characters that came in together, and the damaged one after them.
pub(super) fn characters(
    at: Duration,
    side: Side,
    bytes: &[u8],
    damage: Option<Damage>,
) -> impl Iterator<Item = Character> {
    let character = move |byte, error| Character {
        at,
        side,
        byte,
        error,
    };
    let sound = bytes.iter().map(move |&byte| character(byte, None));
    // The browser does not tell what was read.
    sound.chain(damage.map(move |damage| character(0, Some(damage.into()))))
}
