//! A capture, as `line3964r monitor` reads and judges it.

use core::time::Duration;

use anyhow::{Result, anyhow};
use line3964r::{Preset, capture};
use proto3964r::{Line, Priority};
use serde::Deserialize;

use super::conversation::{self, Of};
use crate::answer::Answer;
use crate::boundary::Request;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    /// What the capture is called in messages.
    name: String,
    text: String,
    preset: Preset,
}

/// The conversation of a capture and the verdict.
pub(super) fn judge(request: &Request) -> Result<Answer> {
    let Parameters { name, text, preset } = request.parameters()?;
    let record = capture::read(&text).map_err(|error| anyhow!("{name}:{error}"))?;
    conversation::begin(Of::Capture, preset.config(Priority::Low, Line::Instant));
    conversation::with(Of::Capture, |it| {
        for character in record {
            it.hear(character);
        }
        it.judge_since(Duration::ZERO);
        it.answer(())
    })?
}
