//! The configuration file.

mod name;

use core::{net::SocketAddr, num::NonZeroU16, time::Duration};
use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context as _, Result};
use proto3964r::Priority;
use serde::Deserialize;
use toml::Spanned;

pub(crate) use self::name::Name;
use super::{
    area::Area,
    broker::Broker,
    field::{Field, Pattern},
};
use crate::{Address, Preset, cli::settings};

/// The client of the broker takes no shorter one.
const KEEP_ALIVE_MIN_S: u16 = 5;

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
    pub(crate) listen: SocketAddr,
}

/// The broker, and what is kept for it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mqtt {
    pub(crate) broker: Broker,
    pub(crate) user: Option<String>,
    password: Option<String>,
    password_file: Option<PathBuf>,
    /// PEM; without it the system's certificate authorities hold.
    pub(crate) ca_file: Option<PathBuf>,
    /// PEM of certificate and key of this client.
    pub(crate) certificate_file: Option<PathBuf>,
    pub(crate) key_file: Option<PathBuf>,
    #[serde(default = "prefix")]
    pub(crate) prefix: Prefix,
    /// Telegrams kept until the broker has acknowledged them.
    #[serde(default = "ten_thousand")]
    pub(crate) queue: NonZeroU16,
    #[serde(default)]
    pub(crate) overflow: Overflow,
    /// How long the broker keeps the commands for a gateway that is away.
    #[serde(default = "one_day_s")]
    pub(crate) session_expiry_s: u32,
    #[serde(default = "half_a_minute_s")]
    pub(crate) keep_alive_s: u16,
    /// Prefix of Home Assistant's discovery topics; without it nothing is announced.
    pub(crate) discovery: Option<Prefix>,
}

/// What becomes of a telegram when the queue is full.
#[derive(Clone, Copy, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Overflow {
    /// Its line waits, and with it the partner, who is refused with NAK.
    #[default]
    Wait,
    /// The oldest of the queue is given up, and counted.
    DropOldest,
}

/// First levels of a topic, without wildcards and without `/` at its ends.
#[derive(Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Prefix(pub(crate) String);

impl TryFrom<String> for Prefix {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let is_level = |level: &str| {
            !level.is_empty()
                && !level.contains(['+', '#', '$'])
                && !level.contains(char::is_control)
        };
        if text.split('/').all(is_level) {
            Ok(Self(text))
        } else {
            Err(format!("`{text}` is no beginning of a topic"))
        }
    }
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
            let folder = path.parent().unwrap_or(Path::new(""));
            let files = [
                &mut mqtt.password_file,
                &mut mqtt.ca_file,
                &mut mqtt.certificate_file,
                &mut mqtt.key_file,
            ];
            for file in files.into_iter().flatten() {
                *file = folder.join(&file);
            }
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

impl Mqtt {
    fn check(&self) -> Result<(), String> {
        let keep_alive_s = self.keep_alive_s;
        if keep_alive_s < KEEP_ALIVE_MIN_S {
            return Err(format!(
                "keep_alive_s: {keep_alive_s}, at least {KEEP_ALIVE_MIN_S}"
            ));
        }
        let message = if self.password.is_some() && self.password_file.is_some() {
            "password and password_file"
        } else if self.user.is_none() && (self.password.is_some() || self.password_file.is_some()) {
            "a password without a user"
        } else if self.certificate_file.is_some() != self.key_file.is_some() {
            "certificate_file and key_file go together"
        } else if !self.broker.is_tls && (self.ca_file.is_some() || self.key_file.is_some()) {
            "certificates are for mqtts://"
        } else {
            return Ok(());
        };
        Err(message.to_owned())
    }

    /// The password, from its file without the end of its line.
    ///
    /// # Errors
    /// Those of the file.
    pub(crate) fn password(&self) -> Result<String> {
        match &self.password_file {
            Some(path) => {
                let text = fs::read_to_string(path);
                let text = text.with_context(|| path.display().to_string())?;
                Ok(text.trim_end_matches(['\r', '\n']).to_owned())
            }
            None => Ok(self.password.clone().unwrap_or_default()),
        }
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
            check_fields(&telegram.fields, telegram.length)?;
        }
        let mut names = Vec::new();
        for area in &self.areas {
            let start = area.span().start;
            let area = area.get_ref();
            if self.procedure != Procedure::Rk512 {
                return Err((start, "areas are for procedure = \"rk512\"".to_owned()));
            }
            area.check().map_err(|message| (start, message))?;
            check_fields(&area.fields, Some(area.bytes()))?;
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

/// The fields of so many bytes, if that is known.
fn check_fields(fields: &[Spanned<Field>], bytes: Option<usize>) -> Result<(), (usize, String)> {
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
        Ok(time) if !time.is_zero() => Ok(time),
        _ => Err(format!("{seconds} is no time in seconds")),
    }
}

fn prefix() -> Prefix {
    Prefix("line3964r".to_owned())
}

const fn siemens() -> Preset {
    Preset::Siemens3964r
}

fn ten_seconds() -> Spanned<f64> {
    Spanned::new(0..0, 10.0)
}

const fn ten_thousand() -> NonZeroU16 {
    const { NonZeroU16::new(10_000).unwrap() }
}

const fn one_day_s() -> u32 {
    24 * 60 * 60
}

const fn half_a_minute_s() -> u16 {
    30
}

const fn sixteen() -> NonZeroU16 {
    const { NonZeroU16::new(16).unwrap() }
}

#[cfg(test)]
mod tests;
