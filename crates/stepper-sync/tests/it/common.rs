//! What several modules use.

pub(crate) mod arm;
pub(crate) mod pulses;
pub(crate) mod rows;
pub(crate) mod timers;
