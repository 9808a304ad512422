//! Areas of an RK512 partner by their configuration.

use core::time::Duration;

use rk512::AreaKind;
use serde::Deserialize;
use toml::Spanned;

use super::{
    config::{Name, time},
    field::Field,
};

/// What a client fetches at once, at most.
const MAX_BYTES: usize = 4096;

/// What is fetched at once.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Area {
    pub(crate) name: Name,
    /// Where it begins.
    pub(crate) start: Start,
    /// Words or bytes, as the area counts.
    pub(crate) length: u16,
    /// Seconds from one poll to the next; without it, on command only.
    poll_s: Option<f64>,
    /// Whether it may be written.
    #[serde(default)]
    pub(crate) writable: bool,
    #[serde(default, rename = "field")]
    pub(crate) fields: Vec<Spanned<Field>>,
}

/// An address in the partner's memory: `DB 10.0`, `DX 3.5`, `flags 20`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Start(pub(crate) rk512::Area);

impl TryFrom<String> for Start {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let no_address = || {
            format!(
                "`{text}` is none of `DB N.WORD`, `DX N.WORD`, `inputs BYTE`, `outputs BYTE`, \
                 `flags BYTE`, `timers N`, `counters N`"
            )
        };
        let (area, place) = text.split_once(' ').ok_or_else(no_address)?;
        let number = |text: &str| text.parse::<u8>().map_err(|_| no_address());
        let block = |kind| {
            let (block, word) = place.split_once('.').ok_or_else(no_address)?;
            rk512::Area::new(kind, number(block)?, number(word)?).map_err(|e| e.to_string())
        };
        let area = match area {
            "DB" => block(AreaKind::DataBlock)?,
            "DX" => block(AreaKind::ExtendedDataBlock)?,
            "inputs" => rk512::Area::inputs(number(place)?),
            "outputs" => rk512::Area::outputs(number(place)?),
            "flags" => rk512::Area::flags(number(place)?),
            "timers" => rk512::Area::timers(number(place)?),
            "counters" => rk512::Area::counters(number(place)?),
            _ => return Err(no_address()),
        };
        Ok(Self(area))
    }
}

impl Area {
    pub(super) fn check(&self) -> Result<(), String> {
        rk512::Command::fetch(self.start.0, self.length).map_err(|error| error.to_string())?;
        if self.writable {
            rk512::Command::send(self.start.0, self.length).map_err(|error| error.to_string())?;
        }
        let bytes = self.bytes();
        if bytes > MAX_BYTES {
            return Err(format!("{bytes} bytes, at most {MAX_BYTES} at once"));
        }
        if let Some(seconds) = self.poll_s {
            time(seconds).map_err(|message| format!("poll_s: {message}"))?;
        }
        Ok(())
    }

    /// Bytes of the whole area.
    pub(super) fn bytes(&self) -> usize {
        usize::from(self.length) * self.start.0.kind().bytes_per_unit()
    }

    pub(super) fn poll(&self) -> Option<Duration> {
        time(self.poll_s?).ok()
    }
}
