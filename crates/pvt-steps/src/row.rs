//! Rows of a PVT table in integers.

/// Position and velocity of one axis where two rows meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "two numbers with fixed units")]
pub struct PvtKnot {
    /// Position in 2^-32 steps.
    pub position: i64,
    /// Velocity in 2^-56 steps a tick.
    pub velocity: i64,
}

impl PvtKnot {
    /// Fraction bits of a position.
    pub const POSITION_BITS: u32 = 32;
    /// Fraction bits of a velocity.
    pub const VELOCITY_BITS: u32 = 56;

    /// At rest on a whole step.
    #[must_use]
    pub const fn at_rest(steps: i32) -> Self {
        Self {
            position: (steps as i64) << Self::POSITION_BITS,
            velocity: 0,
        }
    }
}

/// A row of a PVT table: N axes, each along a cubic.
///
/// From the knots before it, (q0, v0), to its own, (q1, v1), in T ticks each axis runs the Hermite
/// cubic
/// ```text
/// q(s T) = q0 + v0 T s + (3 D - 2 v0 T - v1 T) s² + (v0 T + v1 T - 2 D) s³,  D = q1 - q0
/// ```
/// of exactly these integers: velocities are continuous, positions absolute, nothing drifts.
///
/// A row of 0 ticks sets other velocities at the same positions: a jump, for motors that start and
/// stop at a speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "what a PVT table has")]
pub struct PvtRow<const N: usize> {
    /// T, in ticks.
    pub ticks: u32,
    /// Where each axis is at the end of the row.
    pub knots: [PvtKnot; N],
}
