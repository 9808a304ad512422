//! What several modules use.

pub(crate) mod grid;
pub(crate) mod walk;
