//! What several modules use.

pub(crate) mod cubic;
pub(crate) mod distance_error;
pub(crate) mod exact;
pub(crate) mod moves;
pub(crate) mod optimum;
pub(crate) mod platform;
