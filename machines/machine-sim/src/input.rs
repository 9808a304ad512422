//! What a machine's input says: settings in TOML whose mistakes are reported with their location,
//! and notes of what an input asks for and a machine does otherwise.

mod notes;
mod settings;

pub use self::notes::{Location, Notes};
pub use self::settings::{SettingsError, parse_settings};
