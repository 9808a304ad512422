//! Why there is no such curve.

use trig_kernels::SixDigits;

/// Why there is no such curve.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CurveError {
    /// A coordinate, an angle or a length is not a finite number.
    #[error("a coordinate, angle or length of the curve is not a finite number")]
    NotFinite,
    /// The curve has no length, or too little for a direction.
    #[error("a curve of the length {} has no direction", SixDigits(*.length))]
    NoLength {
        /// Its length; that of an arc by a negative angle is negative.
        length: f64,
    },
    /// The direction of an arc is along its radius.
    #[error("the direction of the arc is along its radius")]
    NoDirection,
    /// An arc goes round too often.
    #[error("the arc turns by {} rad, more than {} rad", SixDigits(*.angle), SixDigits(*.max))]
    Angle {
        /// The angle given, in radians.
        angle: f64,
        /// Largest angle, in radians.
        max: f64,
    },
    /// The curve turns round at once, or nearly: its derivative vanishes.
    #[error("the curve has a cusp near its parameter {}", SixDigits(*.parameter))]
    Cusp {
        /// The parameter of the Bézier curve, 0..=1.
        parameter: f64,
    },
    /// A tolerance that is neither 0 nor within 1e-50 to 1e50.
    #[error("a tolerance of {} is neither 0 nor within 1e-50 to 1e50", SixDigits(*.tolerance))]
    Tolerance {
        /// The tolerance given.
        tolerance: f64,
    },
    /// Memory for too few vertices.
    #[error("memory for {available} vertices: {needed} are needed")]
    Memory {
        /// Vertices needed.
        needed: usize,
        /// Vertices given.
        available: usize,
    },
}
