//! What a port hears.

use proto3964r::tokio::Damage;

/// A character, or what a receiver circuit reports in its place.
pub(crate) type Heard = Result<u8, Damage>;
