//! How a path is rounded at a pose, so that a body passes it without a stop.

/// How far a path may be rounded at one of the poses between its first and its last, so that a body
/// timed by `path-timing` passes it without a stop.
///
/// Both bounds hold: along the whole rounding there is a pose of the unrounded path that is as near
/// as they say, and the other way round. A part that the pose does not change is not looked at:
/// where the body only slides, `rotation_rad` may be 0. [`Blend::STOP`] leaves the pose as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "a pose has position and rotation"
)]
pub struct Blend {
    /// Largest distance of the reference point from the path, in the unit of length.
    pub distance: f64,
    /// Largest angle between the body's rotation and that of the path, in radians.
    pub rotation_rad: f64,
}

impl Blend {
    /// The body stops at the pose.
    pub const STOP: Self = Self {
        distance: 0.0,
        rotation_rad: 0.0,
    };
}
