//! Input files, whose errors name them.

use std::fs;
use std::path::Path;

use anyhow::{Context as _, Result};

/// A file's bytes.
///
/// # Errors
/// It cannot be read.
pub fn read_bytes(file: &Path) -> Result<Vec<u8>> {
    fs::read(file).with_context(|| file.display().to_string())
}

/// A file that is parsed as text.
///
/// # Errors
/// It cannot be read, is no UTF-8, or what the parser says; each begins with the file's name.
pub fn read<T>(file: &Path, parse: impl FnOnce(&str) -> Result<T>) -> Result<T> {
    let place = || file.display().to_string();
    let text = fs::read_to_string(file).with_context(place)?;
    parse(&text).with_context(place)
}
