//! What several modules use.

pub(crate) mod jerk;
pub(crate) mod limits;
pub(crate) mod machine;
pub(crate) mod polyline;
pub(crate) mod python;
pub(crate) mod vectors;
pub(crate) mod waves;
