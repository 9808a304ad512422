//! What an operation gives back: JSON, and bytes by their names.

use anyhow::Result;
use serde::Serialize;
use serde_json::{Value, json};

/// JSON, and bytes by their names.
#[derive(Debug)]
pub(crate) struct Answer {
    value: Value,
    blobs: Vec<(&'static str, Vec<u8>)>,
}

impl Answer {
    pub(crate) fn new(value: impl Serialize) -> Result<Self> {
        Ok(Self {
            value: serde_json::to_value(value)?,
            blobs: Vec::new(),
        })
    }

    pub(crate) fn with_bytes(mut self, name: &'static str, bytes: impl Into<Vec<u8>>) -> Self {
        self.blobs.push((name, bytes.into()));
        self
    }

    /// Numbers, each by its bytes, lowest first as wasm has them.
    #[cfg(any(
        feature = "dance",
        feature = "delta",
        feature = "engrave",
        feature = "line",
        feature = "stage"
    ))]
    pub(crate) fn with_numbers<const N: usize>(
        self,
        name: &'static str,
        numbers: impl IntoIterator<Item = [u8; N]>,
    ) -> Self {
        self.with_bytes(name, numbers.into_iter().flatten().collect::<Vec<_>>())
    }

    /// Rows of numbers, one after the other.
    #[cfg(any(feature = "delta", feature = "engrave", feature = "stage"))]
    pub(crate) fn with_rows<const N: usize>(
        self,
        name: &'static str,
        rows: impl IntoIterator<Item = [f64; N]>,
    ) -> Self {
        self.with_numbers(name, rows.into_iter().flatten().map(f64::to_le_bytes))
    }

    /// First the JSON with the names of the others, then these.
    pub(crate) fn into_outputs(self) -> Result<Vec<Vec<u8>>> {
        let names: Vec<_> = self.blobs.iter().map(|(name, _)| name).collect();
        let head = serde_json::to_vec(&json!({ "value": self.value, "blobs": names }))?;
        let blobs = self.blobs.into_iter().map(|(_, bytes)| bytes);
        Ok(core::iter::once(head).chain(blobs).collect())
    }
}

/// A file of the machine, as its command line writes it.
pub(crate) fn file(bytes: impl Into<Vec<u8>>) -> Result<Answer> {
    Ok(Answer::new(())?.with_bytes("file", bytes))
}

/// A report as the command lines write it.
pub(crate) fn json_file(report: &impl Serialize) -> Result<Answer> {
    let mut text = serde_json::to_vec_pretty(report)?;
    text.push(b'\n');
    file(text)
}
