//! What the broker refused for good: a file of JSON, a message a line.

use std::{
    fs::{File, OpenOptions},
    io::{self, Write as _},
    path::PathBuf,
};

use serde_json::json;

use super::{Message, len};
use crate::gateway::time::now;

/// The file, and how long it may become.
pub(crate) struct DeadLetters {
    path: PathBuf,
    max_bytes: u64,
}

impl DeadLetters {
    pub(crate) const fn new(path: PathBuf, max_bytes: u64) -> Self {
        Self { path, max_bytes }
    }

    /// Appends messages and why they were refused; returns when the disk has them.
    ///
    /// # Errors
    /// Those of the file, which may hold some of them then; one that would become too long.
    pub(crate) fn write<'m>(
        &self,
        letters: impl Iterator<Item = &'m (Message, String)>,
    ) -> io::Result<()> {
        let mut text = Vec::new();
        for (message, reason) in letters {
            let letter = json!({
                "time": now(),
                "reason": reason,
                "topic": message.topic,
                "payload": String::from_utf8_lossy(&message.payload),
            });
            writeln!(text, "{letter}")?;
        }
        let mut file = self.open()?;
        if file.metadata()?.len().saturating_add(len(&text)) > self.max_bytes {
            let most = self.max_bytes;
            return Err(io::Error::other(format!("it would exceed {most} bytes")));
        }
        file.write_all(&text)?;
        file.sync_data()
    }

    fn open(&self) -> io::Result<File> {
        OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)
    }
}
