//! What several modules use.

pub(crate) mod reach;
pub(crate) mod uneven;
