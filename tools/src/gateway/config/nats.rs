//! The part of the file that is about NATS.

use core::{num::NonZeroU8, time::Duration};
use std::path::{Path, PathBuf};

use anyhow::Result;
use async_nats::ServerAddr;
use serde::Deserialize;
use toml::Spanned;

use super::{
    Name, Overflow, Prefix,
    mqtt::{check_text, prefix},
    secret,
};
use crate::gateway::{time::duration, tls};

/// How far back the streams look for duplicates that this gateway makes.
const DUPLICATE_WINDOW: Duration = Duration::from_secs(3600);

/// Characters that subjects need for themselves.
const OF_SUBJECTS: [char; 4] = ['.', '*', '>', ' '];

/// Servers of one cluster, and what they keep.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Nats {
    pub(crate) servers: Vec<Server>,
    /// The stream that is made, if it is not there.
    #[serde(default = "stream")]
    pub(crate) stream: Name,
    /// Servers that keep it.
    #[serde(default = "one")]
    pub(crate) replicas: NonZeroU8,
    duplicate_window_s: Option<Spanned<f64>>,
    pub(crate) user: Option<String>,
    password: Option<String>,
    password_file: Option<PathBuf>,
    token_file: Option<PathBuf>,
    /// PEM; without it the system's certificate authorities hold.
    ca_file: Option<PathBuf>,
    /// PEM of certificate and key of this client.
    certificate_file: Option<PathBuf>,
    key_file: Option<PathBuf>,
    #[serde(default = "prefix")]
    pub(crate) prefix: Prefix,
    #[serde(default)]
    pub(crate) overflow: Overflow,
}

/// `nats://HOST[:PORT]`, or `tls://HOST[:PORT]`; without a port 4222.
#[derive(Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Server(pub(crate) ServerAddr);

impl TryFrom<String> for Server {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let no_server = || format!("`{text}` is not nats://HOST[:PORT] or tls://HOST[:PORT]");
        let place = text.strip_prefix("nats://").or(text.strip_prefix("tls://"));
        let is_bare = place
            .is_some_and(|place| !place.is_empty() && !place.contains(['/', '@', '?', '#', ' ']));
        let server: ServerAddr = text.parse().map_err(|_| no_server())?;
        if is_bare {
            Ok(Self(server))
        } else {
            Err(no_server())
        }
    }
}

impl Nats {
    /// The paths count from this folder.
    pub(super) fn set_folder(&mut self, folder: &Path) {
        let files = [
            &mut self.password_file,
            &mut self.token_file,
            &mut self.ca_file,
            &mut self.certificate_file,
            &mut self.key_file,
        ];
        for file in files.into_iter().flatten() {
            *file = folder.join(&file);
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        check_text("user", self.user.as_deref())?;
        check_text("password", self.password.as_deref())?;
        if let Some(window) = &self.duplicate_window_s {
            duration(*window.get_ref())
                .map_err(|message| format!("duplicate_window_s: {message}"))?;
        }
        let has_password = self.password.is_some() || self.password_file.is_some();
        let has_files = self.ca_file.is_some() || self.key_file.is_some();
        let message = if self.servers.is_empty() {
            "servers: none"
        } else if self.password.is_some() && self.password_file.is_some() {
            "password and password_file"
        } else if self.user.is_none() && has_password {
            "a password without a user"
        } else if self.user.is_some() && self.token_file.is_some() {
            "user and token_file"
        } else if self.certificate_file.is_some() != self.key_file.is_some() {
            "certificate_file and key_file go together"
        } else if !self.is_tls() && has_files {
            "certificates are for tls://"
        } else if self.prefix.0.contains(OF_SUBJECTS) {
            "prefix: no level of a subject has `.`, `*`, `>` or a space"
        } else {
            return Ok(());
        };
        Err(message.to_owned())
    }

    /// Whether any server is to be asked by TLS; then all are.
    pub(crate) fn is_tls(&self) -> bool {
        self.servers.iter().any(|server| server.0.tls_required())
    }

    pub(crate) fn tls(&self) -> tls::Files<'_> {
        tls::Files {
            authorities: self.ca_file.as_deref(),
            identity: self
                .certificate_file
                .as_deref()
                .zip(self.key_file.as_deref()),
        }
    }

    pub(crate) fn duplicate_window(&self) -> Duration {
        let seconds = self.duplicate_window_s.as_ref().map(Spanned::get_ref);
        let window = seconds.and_then(|seconds| duration(*seconds).ok());
        window.unwrap_or(DUPLICATE_WINDOW)
    }

    /// The password.
    ///
    /// # Errors
    /// Those of its file.
    pub(crate) fn password(&self) -> Result<String> {
        match &self.password_file {
            Some(path) => secret("password", path),
            None => Ok(self.password.clone().unwrap_or_default()),
        }
    }

    /// The token.
    ///
    /// # Errors
    /// Those of its file.
    pub(crate) fn token(&self) -> Result<Option<String>> {
        let file = self.token_file.as_deref();
        file.map(|path| secret("token", path)).transpose()
    }
}

fn stream() -> Name {
    Name::literal("line3964r")
}

const fn one() -> NonZeroU8 {
    NonZeroU8::MIN
}
