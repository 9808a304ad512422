//! The configuration file.

mod mqtt;
mod name;
mod nats;
mod store;

use core::{
    net::{IpAddr, SocketAddr},
    num::NonZeroU16,
    time::Duration,
};
use std::{
    env, fs,
    path::{Path, PathBuf},
};

use anyhow::{Context as _, Result, anyhow};
use proto3964r::{Priority, tokio::Link};
use serde::{Deserialize, Deserializer, de::Error as _};
use toml::{Spanned, Table};

pub(crate) use self::{
    mqtt::{Mqtt, Overflow, Prefix, Sparkplug},
    name::Name,
    nats::Nats,
    store::{Settings as StoreSettings, Sync},
};
use super::{
    area::Area,
    field::{Field, Pattern},
    time::duration,
};
use crate::{Address, Preset, Target, settings};

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Config {
    /// Of this gateway: its client identifier at the broker and first level of its topics.
    pub(crate) name: Name,
    mqtt: Option<Spanned<Mqtt>>,
    nats: Option<Spanned<Nats>>,
    store: Option<Spanned<StoreSettings>>,
    pub(crate) tcp: Option<Spanned<Listen>>,
    pub(crate) metrics: Option<Spanned<Listen>>,
    #[serde(default = "ten_seconds")]
    stop_s: Spanned<f64>,
    #[serde(rename = "line")]
    pub(crate) lines: Vec<Spanned<Line>>,
    /// Where the file is.
    #[serde(skip)]
    folder: PathBuf,
    /// What stands there.
    #[serde(skip)]
    pub(crate) tables: Table,
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
    /// A line of which nothing has come for so many seconds is told to be silent.
    silent_after_s: Option<Spanned<f64>>,
    /// Nothing is sent or written.
    #[serde(default)]
    pub(crate) read_only: bool,
    /// Whether a telegram with the bytes of the one before, soon after it, is marked as a possible
    /// repeat.
    #[serde(default = "yes")]
    pub(crate) mark_repeats: bool,
    /// Whether the line is listened to, for verdicts and captures.
    #[serde(default = "yes")]
    pub(crate) diagnose: bool,
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

/// What takes the messages.
#[derive(Clone, Copy)]
pub(crate) enum Broker<'c> {
    Mqtt(&'c Mqtt),
    Nats(&'c Nats),
}

impl<'c> Broker<'c> {
    pub(crate) const fn kind(self) -> &'static str {
        match self {
            Self::Mqtt(_) => "mqtt",
            Self::Nats(_) => "nats",
        }
    }

    fn prefix(self) -> &'c Prefix {
        match self {
            Self::Mqtt(mqtt) => &mqtt.prefix,
            Self::Nats(nats) => &nats.prefix,
        }
    }

    pub(crate) const fn overflow(self) -> Overflow {
        match self {
            Self::Mqtt(mqtt) => mqtt.overflow,
            Self::Nats(nats) => nats.overflow,
        }
    }

    /// Messages that are kept in memory, where they are.
    pub(crate) fn queue(self) -> usize {
        match self {
            Self::Mqtt(mqtt) => mqtt.queue(),
            Self::Nats(_) => mqtt::QUEUE,
        }
    }
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
        let folder = path.parent().unwrap_or(Path::new(""));
        if let Some(mqtt) = config.mqtt.as_mut().map(Spanned::get_mut) {
            mqtt.set_folder(folder);
        }
        if let Some(nats) = config.nats.as_mut().map(Spanned::get_mut) {
            nats.set_folder(folder);
        }
        folder.clone_into(&mut config.folder);
        config.tables = text.parse().with_context(place)?;
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
        if let Err(message) = duration(*self.stop_s.get_ref()) {
            return Err((self.stop_s.span().start, format!("stop_s: {message}")));
        }
        if self.broker().is_none() && self.tcp.is_none() {
            return Err((0, "none of [mqtt], [nats] and [tcp]".to_owned()));
        }
        if self.lines.is_empty() {
            return Err((0, "no [[line]]".to_owned()));
        }
        if let Some(mqtt) = &self.mqtt {
            let checked = mqtt.get_ref().check();
            checked.map_err(|message| (mqtt.span().start, format!("mqtt: {message}")))?;
        }
        if let Some(nats) = &self.nats {
            if self.mqtt.is_some() {
                return Err((nats.span().start, "[mqtt] and [nats]".to_owned()));
            }
            let checked = nats.get_ref().check();
            checked.map_err(|message| (nats.span().start, format!("nats: {message}")))?;
        }
        if let Some(store) = &self.store {
            let message = match (&self.mqtt, &self.nats) {
                (None, None) => "store: for [mqtt] and [nats]",
                (Some(mqtt), _) if mqtt.get_ref().queue.is_some() && self.sync() != Sync::None => {
                    "store: mqtt.queue is for sync = \"none\""
                }
                _ => "",
            };
            if !message.is_empty() {
                return Err((store.span().start, message.to_owned()));
            }
        } else if let Some(mqtt) = &self.mqtt
            && mqtt.get_ref().queue.is_some()
        {
            let message = "mqtt: queue is for [store] with sync = \"none\"";
            return Err((mqtt.span().start, message.to_owned()));
        }
        if let (Some(tcp), Some(metrics)) = (&self.tcp, &self.metrics)
            && is_taken_by(metrics.get_ref().listen, tcp.get_ref().listen)
        {
            let message = format!("tcp listens on {} too", tcp.get_ref().listen);
            return Err((metrics.span().start, message));
        }
        let (mut names, mut ports) = (Vec::new(), Vec::new());
        for line in &self.lines {
            let table = line.span().start;
            let line = line.get_ref();
            let port = place(&line.port.target);
            if ports.contains(&port) {
                let port = &line.port.target;
                return Err((table, format!("a second line on `{port}`")));
            }
            ports.push(port);
            if let Err(error) = line.port.line() {
                return Err((table, error.to_string()));
            }
            let (name, start) = (line.name.get_ref(), line.name.span().start);
            if names.contains(&name) {
                return Err((start, format!("a second line `{name}`")));
            }
            names.push(name);
            line.check()?;
        }
        Ok(())
    }

    /// First levels of all topics.
    pub(crate) fn topic(&self) -> String {
        let prefix = self.broker().map(|broker| broker.prefix().0.as_str());
        format!("{}/{}", prefix.unwrap_or_default(), self.name)
    }

    /// Where the state of the gateway is retained.
    pub(crate) fn status_topic(&self) -> String {
        format!("{}/status", self.topic())
    }

    /// When a message is safe.
    pub(crate) fn sync(&self) -> Sync {
        self.store
            .as_ref()
            .map_or(Sync::default(), |store| store.get_ref().sync)
    }

    /// Bytes that messages take on disk, at most.
    pub(crate) fn store_max_bytes(&self) -> u64 {
        let store = self.store.as_ref().map(Spanned::get_ref);
        store.map_or(store::MAX_BYTES, |store| store.max_bytes.get())
    }

    /// The folder of the store: configured, or in that which systemd gives, or beside this file.
    pub(crate) fn store_folder(&self) -> PathBuf {
        let store = self.store.as_ref().map(Spanned::get_ref);
        if let Some(path) = store.and_then(|store| store.path.as_deref()) {
            return self.folder.join(path);
        }
        let given = env::var_os("STATE_DIRECTORY");
        let first = given
            .as_ref()
            .and_then(|given| env::split_paths(given).next());
        let folder = first.unwrap_or_else(|| self.folder.clone());
        folder.join(format!("{}.store", self.name))
    }

    pub(crate) fn mqtt(&self) -> Option<&Mqtt> {
        self.mqtt.as_ref().map(Spanned::get_ref)
    }

    /// What takes the messages.
    pub(crate) fn broker(&self) -> Option<Broker<'_>> {
        let nats = self.nats.as_ref().map(Spanned::get_ref);
        self.mqtt().map(Broker::Mqtt).or(nats.map(Broker::Nats))
    }

    /// How long a stop may take.
    pub(crate) fn stop(&self) -> Duration {
        duration(*self.stop_s.get_ref()).unwrap_or(Duration::MAX)
    }
}

impl Line {
    fn check(&self) -> Result<(), (usize, String)> {
        if let Some(seconds) = &self.silent_after_s
            && let Err(message) = duration(*seconds.get_ref())
        {
            return Err((seconds.span().start, format!("silent_after_s: {message}")));
        }
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
        for (index, telegram) in self.telegrams.iter().enumerate() {
            let (start, telegram) = (telegram.span().start, telegram.get_ref());
            let mut before = self.telegrams.iter().take(index).map(Spanned::get_ref);
            if let Some(other) = before.find(|other| other.hides(telegram)) {
                let (name, other) = (&telegram.name, &other.name);
                let message = format!("telegram `{name}`: `{other}` describes all of them before");
                return Err((start, message));
            }
        }
        let mut names = Vec::new();
        for (index, area) in self.areas.iter().enumerate() {
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
            let mut before = self.areas.iter().take(index).map(Spanned::get_ref);
            if area.served
                && let Some(other) = before.find(|other| other.served && other.overlaps(area))
            {
                let (name, other) = (&area.name, &other.name);
                return Err((start, format!("area `{name}`: `{other}` has some of it")));
            }
        }
        Ok(())
    }

    /// How long the partner may be silent.
    pub(crate) fn silent_after(&self) -> Option<Duration> {
        duration(*self.silent_after_s.as_ref()?.get_ref()).ok()
    }

    /// The parameters of the station.
    pub(crate) fn config(&self) -> proto3964r::Config {
        let priority = match self.priority {
            PriorityName::Low => Priority::Low,
            PriorityName::High => Priority::High,
        };
        // Whose rate is not known was refused when the file was read.
        let line = self.port.line().unwrap_or(proto3964r::Line::Instant);
        let config = self.preset.config(priority, line);
        proto3964r::Config {
            qvz_ms: self.qvz_ms.map_or(config.qvz_ms, NonZeroU16::get),
            ..config
        }
    }
}

impl Telegram {
    /// Whether whatever the other describes is described by this one.
    fn hides(&self, other: &Self) -> bool {
        other.starts_with.0.starts_with(&self.starts_with.0)
            && (self.length.is_none() || self.length == other.length)
    }

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

/// Where a port is: the same for the same port, however it is written.
fn place(target: &Target) -> String {
    match target {
        Target::Serial(path) => {
            let path = fs::canonicalize(path).unwrap_or_else(|_| path.into());
            path.display().to_string()
        }
        Target::Tcp(host) | Target::Rfc2217(host) => host.clone(),
        other => other.to_string(),
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

/// A secret in a file of its own, without the end of its line.
///
/// # Errors
/// Those of the file.
fn secret(name: &str, path: &Path) -> Result<String> {
    let place = || path.display().to_string();
    let text = fs::read_to_string(path).with_context(place)?;
    let text = text.trim_end_matches(['\r', '\n']);
    mqtt::check_text(name, Some(text)).map_err(|message| anyhow!("{}: {message}", place()))?;
    Ok(text.to_owned())
}

const fn siemens() -> Preset {
    Preset::Siemens3964r
}

fn ten_seconds() -> Spanned<f64> {
    Spanned::new(0..0, 10.0)
}

const fn yes() -> bool {
    true
}

const fn sixteen() -> NonZeroU16 {
    const { NonZeroU16::new(16).unwrap() }
}

/// Whether one of two addresses to listen on leaves nothing for the other: `0.0.0.0` is each of
/// IPv4, and `[::]` of both, as Linux has it.
fn is_taken_by(address: SocketAddr, other: SocketAddr) -> bool {
    let (ip, other_ip) = (address.ip(), other.ip());
    let covers =
        |all: IpAddr, one: IpAddr| all.is_unspecified() && (all.is_ipv6() || one.is_ipv4());
    address.port() != 0
        && address.port() == other.port()
        && (ip == other_ip || covers(ip, other_ip) || covers(other_ip, ip))
}

#[cfg(test)]
mod tests;
