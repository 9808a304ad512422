//! What several modules use.

pub(crate) mod arm;
pub(crate) mod rows;
