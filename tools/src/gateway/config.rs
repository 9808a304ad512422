//! The configuration file.

mod mqtt;
mod name;

use core::{net::SocketAddr, num::NonZeroU16, time::Duration};
use std::{fs, path::Path};

use anyhow::{Context as _, Result};
use proto3964r::{Priority, tokio::Link};
use serde::{Deserialize, Deserializer, de::Error as _};
use toml::Spanned;

pub(crate) use self::{
    mqtt::{Mqtt, Overflow, Prefix},
    name::Name,
};
use super::{
    area::Area,
    field::{Field, Pattern},
};
use crate::{Address, Preset, cli::settings};

/// The longest time: 30 years, which every clock bears.
const TIME_MAX_S: f64 = 1e9;

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Config {
    /// Of this gateway: its client identifier at the broker and first level of its topics.
    pub(crate) name: Name,
    mqtt: Option<Spanned<Mqtt>>,
    pub(crate) tcp: Option<Listen>,
    pub(crate) metrics: Option<Listen>,
    #[serde(default = "ten_seconds")]
    stop_s: Spanned<f64>,
    #[serde(rename = "line")]
    pub(crate) lines: Vec<Spanned<Line>>,
}

/// A socket that others connect to.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Listen {
    #[serde(deserialize_with = "socket")]
    pub(crate) listen: SocketAddr,
}

fn socket<'de, D: Deserializer<'de>>(text: D) -> Result<SocketAddr, D::Error> {
    let text = String::deserialize(text)?;
    text.parse()
        .map_err(|_| D::Error::custom(format!("`{text}` is not IP:PORT")))
}

/// One line and its partner.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Line {
    pub(crate) name: Spanned<Name>,
    pub(crate) port: Address,
    #[serde(default)]
    pub(crate) procedure: Procedure,
    #[serde(default = "siemens")]
    pub(crate) preset: Preset,
    pub(crate) priority: PriorityName,
    /// Acknowledgement delay time (QVZ), if not the preset's.
    pub(crate) qvz_ms: Option<NonZeroU16>,
    /// Jobs that wait for the line.
    #[serde(default = "sixteen")]
    pub(crate) commands: NonZeroU16,
    /// What telegrams of 3964R hold.
    #[serde(default, rename = "telegram")]
    pub(crate) telegrams: Vec<Spanned<Telegram>>,
    /// Areas of an RK512 partner.
    #[serde(default, rename = "area")]
    pub(crate) areas: Vec<Spanned<Area>>,
}

/// Who gives way when both sides want to send.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PriorityName {
    Low,
    High,
}

/// What runs on the line.
#[derive(Clone, Copy, Default, Deserialize, PartialEq, Eq)]
pub(crate) enum Procedure {
    /// Telegrams as they are.
    #[default]
    #[serde(rename = "3964r")]
    Telegrams,
    /// FETCH and SEND of the partner's areas.
    #[serde(rename = "rk512")]
    Rk512,
}

/// Telegrams of one kind.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Telegram {
    pub(crate) name: Name,
    /// First bytes; without them, every telegram.
    #[serde(default)]
    pub(crate) starts_with: Pattern,
    /// Bytes; without it, any number.
    pub(crate) length: Option<usize>,
    #[serde(default, rename = "field")]
    pub(crate) fields: Vec<Spanned<Field>>,
}

impl Config {
    /// Reads a file; the paths in it count from its folder.
    ///
    /// # Errors
    /// That of the file, or what is wrong in it, with line and column.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let place = || path.display().to_string();
        let text = fs::read_to_string(path).with_context(place)?;
        let mut config = Self::parse(&text).with_context(place)?;
        if let Some(mqtt) = config.mqtt.as_mut().map(Spanned::get_mut) {
            mqtt.set_folder(path.parent().unwrap_or(Path::new("")));
        }
        Ok(config)
    }

    pub(super) fn parse(text: &str) -> Result<Self> {
        let config: Self = settings::parse(text)?;
        match config.check() {
            Ok(()) => Ok(config),
            Err((start, message)) => Err(settings::located(text, start, &message)),
        }
    }

    /// What the types do not say. The place is an offset into the text.
    fn check(&self) -> Result<(), (usize, String)> {
        if let Err(message) = time(*self.stop_s.get_ref()) {
            return Err((self.stop_s.span().start, format!("stop_s: {message}")));
        }
        if self.mqtt.is_none() && self.tcp.is_none() {
            return Err((0, "neither [mqtt] nor [tcp]".to_owned()));
        }
        if self.lines.is_empty() {
            return Err((0, "no [[line]]".to_owned()));
        }
        if let Some(mqtt) = &self.mqtt {
            let checked = mqtt.get_ref().check();
            checked.map_err(|message| (mqtt.span().start, format!("mqtt: {message}")))?;
        }
        let (mut names, mut ports) = (Vec::new(), Vec::new());
        for line in &self.lines {
            let table = line.span().start;
            let line = line.get_ref();
            let port = &line.port.target;
            if ports.contains(&port) {
                return Err((table, format!("a second line on `{port}`")));
            }
            ports.push(port);
            let (name, start) = (line.name.get_ref(), line.name.span().start);
            if names.contains(&name) {
                return Err((start, format!("a second line `{name}`")));
            }
            names.push(name);
            line.check()?;
        }
        Ok(())
    }

    pub(crate) fn mqtt(&self) -> Option<&Mqtt> {
        self.mqtt.as_ref().map(Spanned::get_ref)
    }

    /// How long a stop may take.
    pub(crate) fn stop(&self) -> Duration {
        time(*self.stop_s.get_ref()).unwrap_or(Duration::MAX)
    }
}

impl Line {
    fn check(&self) -> Result<(), (usize, String)> {
        for telegram in &self.telegrams {
            let start = telegram.span().start;
            if self.procedure == Procedure::Rk512 {
                return Err((start, "telegrams on a line of RK512".to_owned()));
            }
            let telegram = telegram.get_ref();
            telegram.check().map_err(|message| (start, message))?;
            let length = telegram.length.unwrap_or(Link::MAX_TELEGRAM);
            check_fields(&telegram.fields, length)?;
        }
        let mut names = Vec::new();
        for area in &self.areas {
            let start = area.span().start;
            let area = area.get_ref();
            if self.procedure != Procedure::Rk512 {
                return Err((start, "areas are for procedure = \"rk512\"".to_owned()));
            }
            area.check().map_err(|message| (start, message))?;
            check_fields(&area.fields, area.bytes())?;
            if names.contains(&&area.name) {
                return Err((start, format!("a second area `{}`", area.name)));
            }
            names.push(&area.name);
        }
        Ok(())
    }

    /// The parameters of the station.
    pub(crate) fn config(&self) -> proto3964r::Config {
        let priority = match self.priority {
            PriorityName::Low => Priority::Low,
            PriorityName::High => Priority::High,
        };
        let config = self.preset.config(priority, self.port.line());
        proto3964r::Config {
            qvz_ms: self.qvz_ms.map_or(config.qvz_ms, NonZeroU16::get),
            ..config
        }
    }
}

impl Telegram {
    /// Whether there are telegrams that this describes.
    fn check(&self) -> Result<(), String> {
        let (name, begin) = (&self.name, self.starts_with.0.len());
        let length = self.length.unwrap_or(Link::MAX_TELEGRAM);
        if length > Link::MAX_TELEGRAM {
            let most = Link::MAX_TELEGRAM;
            return Err(format!(
                "telegram `{name}`: length {length}, at most {most}"
            ));
        }
        if begin > length {
            return Err(format!(
                "telegram `{name}`: begins with {begin} bytes of {length}"
            ));
        }
        Ok(())
    }
}

/// The fields of so many bytes.
fn check_fields(fields: &[Spanned<Field>], bytes: usize) -> Result<(), (usize, String)> {
    let mut names = Vec::new();
    for field in fields {
        let start = field.span().start;
        let field = field.get_ref();
        let checked = field.check(bytes);
        checked.map_err(|message| (start, format!("field `{}`: {message}", field.name)))?;
        if names.contains(&&field.name) {
            return Err((start, format!("a second field `{}`", field.name)));
        }
        names.push(&field.name);
    }
    Ok(())
}

/// A time of a file.
pub(crate) fn time(seconds: f64) -> Result<Duration, String> {
    match Duration::try_from_secs_f64(seconds) {
        Ok(time) if !time.is_zero() && seconds <= TIME_MAX_S => Ok(time),
        _ => Err(format!(
            "{seconds} is no time in seconds, up to {TIME_MAX_S}"
        )),
    }
}

const fn siemens() -> Preset {
    Preset::Siemens3964r
}

fn ten_seconds() -> Spanned<f64> {
    Spanned::new(0..0, 10.0)
}

const fn sixteen() -> NonZeroU16 {
    const { NonZeroU16::new(16).unwrap() }
}

#[cfg(test)]
mod tests;
