//! Settings in TOML, with the location of a mistake.

use serde::de::DeserializeOwned;
use thiserror::Error;

/// What is wrong with a text of settings, in one line, with line, column and value.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct SettingsError(String);

/// Reads settings.
///
/// # Errors
/// The parser's message with its location, without its drawing of the line.
///
/// # Examples
/// ```
/// #[derive(Debug, serde::Deserialize)]
/// struct Arm {
///     upper_mm: f64,
/// }
/// let arm: Arm = machine_sim::input::parse_settings("upper_mm = 132.0")?;
/// let error = machine_sim::input::parse_settings::<Arm>("\nupper_mm = true").unwrap_err();
/// assert!(error.to_string().starts_with("line 2, column 12: "));
/// # assert_eq!(arm.upper_mm, 132.0);
/// # Ok::<(), machine_sim::input::SettingsError>(())
/// ```
pub fn parse_settings<S: DeserializeOwned>(text: &str) -> Result<S, SettingsError> {
    toml::from_str(text).map_err(|error| SettingsError(one_line(text, &error)))
}

fn one_line(text: &str, error: &toml::de::Error) -> String {
    let message = error.message().replace('\n', ", ");
    let Some(span) = error.span() else {
        return message;
    };
    let before = text.get(..span.start).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let located = format!("line {line}, column {column}: {message}");
    // Of a table, with something missing or too much, the location alone.
    match text.get(span).filter(|value| !value.contains('\n')) {
        Some(value) if !value.is_empty() => format!("{located}: {value:?}"),
        _ => located,
    }
}
