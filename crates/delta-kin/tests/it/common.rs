//! What several modules use.

pub(crate) mod reach;
pub(crate) mod thesis;
pub(crate) mod uneven;
