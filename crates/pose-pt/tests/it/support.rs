//! What several modules use.

#[cfg(feature = "path-timing")]
pub(crate) mod cubic;
pub(crate) mod distance_error;
#[cfg(feature = "path-timing")]
pub(crate) mod exact;
#[cfg(feature = "path-timing")]
pub(crate) mod limits;
pub(crate) mod moves;
#[cfg(feature = "path-timing")]
pub(crate) mod optimum;
pub(crate) mod platform;
#[cfg(feature = "path-timing")]
pub(crate) mod table;
