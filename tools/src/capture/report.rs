//! A verdict for programs.

use core::time::Duration;

use monitor3964r::Diagnosis;
use serde::Serialize;

/// A verdict as `line3964r monitor --json` prints it.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// When, for a verdict on the last minute of a live tap.
    #[serde(skip_serializing_if = "Option::is_none")]
    at_s: Option<f64>,
    /// As a person reads it.
    sentence: String,
    /// What tells the causes apart.
    measurement: Option<&'static str>,
    #[serde(flatten)]
    diagnosis: Diagnosis,
}

impl Report {
    /// The report on a diagnosis, of this time when it is not on the whole.
    #[must_use]
    pub fn new(at: Option<Duration>, diagnosis: Diagnosis) -> Self {
        Self {
            at_s: at.map(|at| at.as_secs_f64()),
            sentence: diagnosis.verdict.to_string(),
            measurement: diagnosis.verdict.measurement(),
            diagnosis,
        }
    }
}
