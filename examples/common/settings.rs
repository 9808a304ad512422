//! Reads settings in TOML.

use std::fs;
use std::path::Path;

use anyhow::{Context as _, Result, anyhow};
use serde::de::DeserializeOwned;

/// What a file says, or one line that names the file and the place in it.
pub(crate) fn read<S: DeserializeOwned>(file: &Path) -> Result<S> {
    let place = || file.display().to_string();
    let text = fs::read_to_string(file).with_context(place)?;
    toml::from_str(&text)
        .map_err(|error| one_line(&text, &error))
        .with_context(place)
}

/// The parser's message with line, column and value, without its drawing of the line.
fn one_line(text: &str, error: &toml::de::Error) -> anyhow::Error {
    let message = error.message().replace('\n', ", ");
    let Some(span) = error.span() else {
        return anyhow!("{message}");
    };
    let before = text.get(..span.start).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let place = format!("line {line}, column {column}: {message}");
    // Of a table, with something missing or too much, the place alone.
    match text.get(span).filter(|value| !value.contains('\n')) {
        Some(value) if !value.is_empty() => anyhow!("{place}: {value:?}"),
        _ => anyhow!(place),
    }
}
