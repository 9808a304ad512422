//! What several modules use.

pub(crate) mod artefacts;
pub(crate) mod command;
pub(crate) mod example;
pub(crate) mod refusal;
pub(crate) mod report;
