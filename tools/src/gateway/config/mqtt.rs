//! The part of the file that is about the broker.

use core::num::NonZeroU16;
use std::path::{Path, PathBuf};

use anyhow::Result;
use serde::Deserialize;

use super::{Name, secret};
use crate::gateway::{broker::Broker, mqtt::Version, tls};

/// The client of the broker takes no shorter one.
const KEEP_ALIVE_MIN_S: u16 = 5;

/// Bytes of the longest text of MQTT: its length has 16 bits.
const MQTT_TEXT_MAX: usize = 0xFFFF;

/// Messages that are kept in memory, unless configured.
pub(super) const QUEUE: usize = 10_000;

/// The broker, and what is kept for it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mqtt {
    pub(crate) broker: Broker,
    /// The version; without it, the one that the broker takes.
    pub(crate) protocol: Option<Version>,
    pub(crate) user: Option<String>,
    password: Option<String>,
    password_file: Option<PathBuf>,
    /// PEM; without it the system's certificate authorities hold.
    ca_file: Option<PathBuf>,
    /// PEM of certificate and key of this client.
    certificate_file: Option<PathBuf>,
    key_file: Option<PathBuf>,
    #[serde(default = "prefix")]
    pub(crate) prefix: Prefix,
    /// Messages kept in memory until the broker has acknowledged them.
    pub(super) queue: Option<NonZeroU16>,
    #[serde(default)]
    pub(crate) overflow: Overflow,
    /// How long the broker keeps the commands for a gateway that is away.
    #[serde(default)]
    pub(crate) command_max_age_s: u32,
    #[serde(default = "half_a_minute_s")]
    pub(crate) keep_alive_s: u16,
    /// Prefix of Home Assistant's discovery topics; without it nothing is announced.
    pub(crate) discovery: Option<Prefix>,
    /// Sparkplug B in place of this gateway's own topics.
    pub(crate) sparkplug: Option<Sparkplug>,
}

/// The gateway as an edge node of Sparkplug B.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sparkplug {
    pub(crate) group: Name,
    /// The edge node; without it, the name of the gateway.
    pub(crate) node: Option<Name>,
    /// The host application without which nothing is published.
    pub(crate) primary_host: Option<Name>,
}

/// What becomes of a telegram when there is no room for it.
#[derive(Clone, Copy, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Overflow {
    /// Its line waits, and with it the partner, who is refused with NAK.
    #[default]
    Wait,
    /// The oldest message is given up, and counted.
    DropOldest,
}

/// First levels of a topic, without wildcards and without `/` at its ends; 1 to 256 bytes.
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
        if text.len() > 256 {
            let len = text.len();
            Err(format!(
                "a beginning of a topic of {len} bytes, at most 256"
            ))
        } else if text.split('/').all(is_level) {
            Ok(Self(text))
        } else {
            Err(format!("`{text}` is no beginning of a topic"))
        }
    }
}

impl Mqtt {
    /// Messages that are kept in memory, where they are.
    pub(crate) fn queue(&self) -> usize {
        self.queue.map_or(QUEUE, |queue| queue.get().into())
    }

    /// The paths count from this folder.
    pub(super) fn set_folder(&mut self, folder: &Path) {
        let files = [
            &mut self.password_file,
            &mut self.ca_file,
            &mut self.certificate_file,
            &mut self.key_file,
        ];
        for file in files.into_iter().flatten() {
            *file = folder.join(&file);
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let keep_alive_s = self.keep_alive_s;
        if keep_alive_s < KEEP_ALIVE_MIN_S {
            return Err(format!(
                "keep_alive_s: {keep_alive_s}, at least {KEEP_ALIVE_MIN_S}"
            ));
        }
        check_text("user", self.user.as_deref())?;
        check_text("password", self.password.as_deref())?;
        let message = if self.password.is_some() && self.password_file.is_some() {
            "password and password_file"
        } else if self.user.is_none() && (self.password.is_some() || self.password_file.is_some()) {
            "a password without a user"
        } else if self.certificate_file.is_some() != self.key_file.is_some() {
            "certificate_file and key_file go together"
        } else if !self.broker.is_tls && (self.ca_file.is_some() || self.key_file.is_some()) {
            "certificates are for mqtts://"
        } else if self.protocol == Some(Version::Three) && self.command_max_age_s > 0 {
            "command_max_age_s is for MQTT 5"
        } else if self.sparkplug.is_some() && self.command_max_age_s > 0 {
            "command_max_age_s: Sparkplug keeps no commands"
        } else if self.sparkplug.is_some() && self.discovery.is_some() {
            "discovery: its topics are not published with Sparkplug"
        } else {
            return Ok(());
        };
        Err(message.to_owned())
    }

    /// Who is trusted, and who this client is.
    pub(crate) fn tls(&self) -> tls::Files<'_> {
        let certificate = self.certificate_file.as_deref();
        tls::Files {
            authorities: self.ca_file.as_deref(),
            identity: certificate.zip(self.key_file.as_deref()),
        }
    }

    /// The password.
    ///
    /// # Errors
    /// Those of the file.
    pub(crate) fn password(&self) -> Result<String> {
        match &self.password_file {
            Some(path) => secret("password", path),
            None => Ok(self.password.clone().unwrap_or_default()),
        }
    }
}

/// A text that goes to the broker.
pub(super) fn check_text(name: &str, text: Option<&str>) -> Result<(), String> {
    match text.map_or(0, str::len) {
        0..=MQTT_TEXT_MAX => Ok(()),
        len => Err(format!("{name}: {len} bytes, at most {MQTT_TEXT_MAX}")),
    }
}

pub(super) fn prefix() -> Prefix {
    Prefix("line3964r".to_owned())
}

const fn half_a_minute_s() -> u16 {
    30
}
