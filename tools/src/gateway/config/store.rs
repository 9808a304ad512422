//! The part of the file that is about the store.

use core::num::NonZeroU64;
use std::path::PathBuf;

use serde::Deserialize;

/// Bytes that messages take, unless configured.
pub(super) const MAX_BYTES: u64 = 1 << 30;

/// Where messages are kept until the broker has them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    /// A folder.
    pub(super) path: Option<PathBuf>,
    #[serde(default = "max_bytes")]
    pub(super) max_bytes: NonZeroU64,
    #[serde(default)]
    pub(super) sync: Sync,
}

/// When a message is safe.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Sync {
    /// When the disk has it; each is waited for alone.
    Each,
    /// When the disk has it; one wait for all that have come meanwhile.
    #[default]
    Group,
    /// In memory: until this program ends.
    None,
}

const fn max_bytes() -> NonZeroU64 {
    const { NonZeroU64::new(MAX_BYTES).unwrap() }
}
