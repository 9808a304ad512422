//! What several modules use.

pub(crate) mod bits;
pub(crate) mod double_double;
pub(crate) mod worst;
