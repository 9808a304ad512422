//! The serial line: captures judged, two simulated stations, a station and a tap on real ports.

mod capture;
mod conversation;
mod simulation;
mod station;
mod tap;

use core::time::Duration;

use anyhow::{Context, Error, Result, bail};
use line3964r::text;
use proto3964r::Priority;
use serde::Deserialize;

use crate::answer::Answer;
use crate::boundary::Request;

/// What the page can ask for.
pub(crate) fn perform(operation: &str, request: &Request) -> Result<Answer> {
    match operation {
        "line" => capture::judge(request),
        "line.file" => conversation::file(request),
        "line.simulation.begin" => simulation::begin(request),
        "line.simulation.set" => simulation::set(request),
        "line.simulation.send" => simulation::send(request),
        "line.simulation.run" => simulation::run(request),
        "line.station.begin" => station::begin(request),
        "line.station" => station::push(request),
        "line.tap.begin" => tap::begin(request),
        "line.tap" => tap::push(request),
        other => bail!("there is no operation {other:?}"),
    }
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum PriorityName {
    High,
    Low,
}

impl From<PriorityName> for Priority {
    fn from(name: PriorityName) -> Self {
        match name {
            PriorityName::High => Self::High,
            PriorityName::Low => Self::Low,
        }
    }
}

/// A telegram as a person writes it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Telegram {
    text: String,
    /// Hexadecimal bytes; else the text itself.
    is_hex: bool,
}

impl Telegram {
    fn bytes(&self) -> Result<Vec<u8>> {
        if self.is_hex {
            text::bytes(self.text.split_whitespace()).map_err(Error::msg)
        } else {
            Ok(self.text.as_bytes().to_vec())
        }
    }
}

/// What the verdict of a live line looks back on, as that of `line3964r monitor` does.
const RECENT: Duration = Duration::from_secs(60);

fn seconds(value: f64) -> Result<Duration> {
    Duration::try_from_secs_f64(value).with_context(|| format!("{value} is not a time in seconds"))
}

fn milliseconds(value: f64, name: &str) -> Result<Duration> {
    let time = Duration::try_from_secs_f64(value / 1000.0);
    time.with_context(|| format!("{name}: {value} is not a time in ms"))
}
