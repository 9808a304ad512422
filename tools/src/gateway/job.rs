//! Commands and what comes of them.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

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
    id: Option<Value>,
    send: Option<String>,
    send_text: Option<String>,
    fetch: Option<String>,
    write: Option<String>,
    hex: Option<String>,
    fields: Option<Map<String, Value>>,
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
    pub(crate) id: Option<Value>,
    pub(crate) action: Action,
}

/// What became of a command.
#[derive(Serialize)]
pub(crate) struct Outcome<'o> {
    pub(crate) event: &'static str,
    pub(crate) line: &'o str,
    pub(crate) time: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) id: Option<&'o Value>,
    pub(crate) ok: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) error: Option<&'o str>,
}

/// A command that is none: what is wrong, and its `id` if it could be read.
#[derive(Debug, PartialEq)]
pub(crate) struct Refused {
    pub(crate) id: Option<Value>,
    pub(crate) message: String,
}

impl Job {
    /// Reads a command.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn parse(payload: &[u8]) -> Result<Self, Refused> {
        let refused = |id, message| Refused { id, message };
        let len = payload.len();
        if len > MAX_COMMAND {
            let message = format!("a command of {len} bytes, at most {MAX_COMMAND}");
            return Err(refused(None, message));
        }
        let text: CommandText = serde_json::from_slice(payload)
            .map_err(|error| refused(None, format!("no command: {error}")))?;
        let id = text.id.clone();
        match text.action() {
            Ok(action) => Ok(Self { id, action }),
            Err(message) => Err(refused(id, message)),
        }
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
