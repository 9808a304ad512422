//! Files of settings, as TOML.

use anyhow::{Result, anyhow};
use serde::de::DeserializeOwned;

/// Reads settings.
///
/// # Errors
/// What is wrong, in one line, with the place.
pub(crate) fn parse<S: DeserializeOwned>(text: &str) -> Result<S> {
    toml::from_str(text).map_err(|error| {
        let message = error.message().replace('\n', ", ");
        match error.span() {
            Some(span) => located(text, span.start, &message),
            None => anyhow!(message),
        }
    })
}

/// Line and column, from 1, of an offset, before a message.
pub(crate) fn located(text: &str, start: usize, message: &str) -> anyhow::Error {
    let before = text.get(..start).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    anyhow!("line {line}, column {column}: {message}")
}
