//! What several modules use.

pub(crate) mod low_side;
pub(crate) mod random;
