//! Commands and what comes of them.

use alloc::collections::BTreeMap;

use bytes::Bytes;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, value::RawValue};

use crate::text;

/// Longest command, in bytes: a telegram of 4096 bytes in hexadecimal with spaces, and the rest.
pub(crate) const MAX_COMMAND: usize = 16 * 1024;

/// A command as it comes.
///
/// | line | command |
/// |---|---|
/// | 3964R | `{"send": "54 41 52 45"}`, `{"send_text": "TARE"}` |
/// | RK512 | `{"fetch": "AREA"}`, `{"write": "AREA", "hex": "00 2A"}`, `{"write": "AREA", "fields": {"speed": 12.5}}` |
///
/// Any may have an `id`, which its outcome repeats.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a JSON object")]
struct CommandText {
    id: Option<Id>,
    send: Option<String>,
    send_text: Option<String>,
    fetch: Option<String>,
    write: Option<String>,
    hex: Option<String>,
    fields: Option<Map<String, Value>>,
}

/// What identifies a command, as it was written: no digit of a long number is lost.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(transparent)]
pub(crate) struct Id(Box<RawValue>);

impl PartialEq for Id {
    fn eq(&self, other: &Self) -> bool {
        self.0.get() == other.0.get()
    }
}

/// Where an answer is wanted besides, and what it repeats (MQTT 5).
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Reply {
    pub(crate) topic: String,
    pub(crate) correlation: Option<Bytes>,
}

/// What a line is to do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Action {
    Send(Vec<u8>),
    Fetch { area: String },
    Write { area: String, data: Data },
}

/// What is written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Data {
    /// From the beginning of the area on.
    Bytes(Vec<u8>),
    Fields(Map<String, Value>),
}

/// A command, with what its outcome repeats.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Job {
    pub(crate) asked: Asked,
    pub(crate) action: Action,
}

/// What the outcome of a command repeats, and where it goes besides.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Asked {
    pub(crate) id: Option<Id>,
    pub(crate) reply: Option<Reply>,
}

/// What became of a command.
#[derive(Serialize)]
pub(crate) struct Outcome<'o> {
    pub(crate) event: &'static str,
    pub(crate) line: &'o str,
    pub(crate) time: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) id: Option<&'o Id>,
    pub(crate) ok: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) error: Option<&'o str>,
}

/// A command that is none: what is wrong, and its `id` if it could be read.
#[derive(Debug, PartialEq)]
pub(crate) struct Refused {
    pub(crate) asked: Asked,
    pub(crate) message: String,
}

impl Job {
    /// Reads a command, whose outcome goes to the reply too.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn parse(payload: &[u8], reply: Option<Reply>) -> Result<Self, Refused> {
        let mut asked = Asked { id: None, reply };
        let len = payload.len();
        if len > MAX_COMMAND {
            let message = format!("a command of {len} bytes, at most {MAX_COMMAND}");
            return Err(Refused { asked, message });
        }
        let (id, action) = match serde_json::from_slice::<CommandText>(payload) {
            Ok(text) => (text.id.clone(), text.action()),
            Err(error) => {
                // Wanted even if the rest is wrong.
                let object = serde_json::from_slice(payload).ok();
                let id = object.and_then(|mut object: BTreeMap<String, Id>| object.remove("id"));
                (id, Err(format!("no command: {error}")))
            }
        };
        asked.id = id;
        match action {
            Ok(action) => Ok(Self { asked, action }),
            Err(message) => Err(Refused { asked, message }),
        }
    }
}

impl Action {
    /// Whether it changes nothing at the partner.
    pub(crate) const fn is_reading(&self) -> bool {
        matches!(self, Self::Fetch { .. })
    }
}

impl CommandText {
    fn action(self) -> Result<Action, String> {
        let hex = |hex: String| text::bytes(hex.split_whitespace());
        match (
            self.send,
            self.send_text,
            self.fetch,
            self.write,
            self.hex,
            self.fields,
        ) {
            (Some(send), None, None, None, None, None) => hex(send).map(Action::Send),
            (None, Some(send), None, None, None, None) => Ok(Action::Send(send.into_bytes())),
            (None, None, Some(area), None, None, None) => Ok(Action::Fetch { area }),
            (None, None, None, Some(area), Some(data), None) => {
                let data = Data::Bytes(hex(data)?);
                Ok(Action::Write { area, data })
            }
            (None, None, None, Some(_), None, Some(fields)) if fields.is_empty() => {
                Err("`fields` is empty".to_owned())
            }
            (None, None, None, Some(area), None, Some(fields)) => {
                let data = Data::Fields(fields);
                Ok(Action::Write { area, data })
            }
            _ => Err("one of send, send_text, fetch, write with hex, write with fields".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests;
