//! Telegrams and areas as JSON.

use core::fmt::Write as _;

use serde::{Serialize, Serializer};
use toml::Spanned;

use super::{
    config::Telegram,
    field::{Decoded, Field},
};

/// What was received or fetched.
#[derive(Serialize)]
pub(crate) struct Report<'r> {
    /// `telegram` or `area`.
    pub(crate) event: &'static str,
    pub(crate) line: &'r str,
    /// Its kind or area; absent for a telegram that none describes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<&'r str>,
    /// When this gateway was started: `seq` counts from there.
    pub(crate) run: &'r str,
    /// Number on this line. What comes twice with the same `run` and `seq` is one telegram.
    pub(crate) seq: u64,
    pub(crate) time: String,
    pub(crate) hex: String,
    /// The same bytes as the last one's, so soon after it that they may be its repeat.
    #[serde(skip_serializing_if = "is_false")]
    pub(crate) possible_repeat: bool,
    #[serde(skip_serializing_if = "Fields::is_empty")]
    pub(crate) fields: Fields<'r, Decoded<'r>>,
    /// Why fields are missing.
    #[serde(skip_serializing_if = "Fields::is_empty")]
    pub(crate) errors: Fields<'r, String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's shape")]
const fn is_false(flag: &bool) -> bool {
    !*flag
}

/// Values by the names of fields, in their order.
pub(crate) struct Fields<'f, V>(Vec<(&'f str, V)>);

impl<V> Fields<'_, V> {
    const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<V: Serialize> Serialize for Fields<'_, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

/// The fields of these bytes, and those that are not in them.
pub(crate) fn decode<'f>(
    fields: &'f [Spanned<Field>],
    bytes: &[u8],
) -> (Fields<'f, Decoded<'f>>, Fields<'f, String>) {
    let (mut values, mut errors) = (Vec::new(), Vec::new());
    for field in fields.iter().map(Spanned::get_ref) {
        match field.decode(bytes) {
            Ok(value) => values.push((field.name.as_str(), value)),
            Err(error) => errors.push((field.name.as_str(), error)),
        }
    }
    (Fields(values), Fields(errors))
}

/// The first description that fits.
pub(crate) fn describe<'d>(kinds: &'d [Spanned<Telegram>], bytes: &[u8]) -> Option<&'d Telegram> {
    kinds.iter().map(Spanned::get_ref).find(|kind| {
        bytes.starts_with(&kind.starts_with.0)
            && kind.length.is_none_or(|length| length == bytes.len())
    })
}

/// `41 42 43`.
pub(crate) fn hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(3 * bytes.len());
    for byte in bytes {
        let space = if text.is_empty() { "" } else { " " };
        // Into a string, which does not fail.
        write!(text, "{space}{byte:02X}").ok();
    }
    text
}
