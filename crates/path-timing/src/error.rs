//! Why a table cannot be made.

use trig_kernels::SixDigits;

/// Why a table cannot be made; nothing of it has been handed out. `E` is the path's own error.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PlanError<E> {
    /// A limit is not a number within the range of the crate.
    #[error("axis {axis}: {name} is {}, not within {}..={}", SixDigits(*.value), SixDigits(*.min), SixDigits(*.max))]
    Limit {
        /// The axis, from 0.
        axis: usize,
        /// Which: `speed`, `acceleration` or `jerk`.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A limit of the tool along a path is not a number within the range of the crate.
    #[error("leg {leg}: {name} is {}, not within {}..={}", SixDigits(*.value), SixDigits(*.min), SixDigits(*.max))]
    Tool {
        /// The leg, from 0.
        leg: usize,
        /// Which: `feed` or `acceleration`.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A start-stop speed of a corner is neither 0 nor a number within the range of the crate.
    #[error("leg {leg}, axis {axis}: a start-stop speed of {} is not within the range of numbers", SixDigits(*.speed))]
    StartStopSpeed {
        /// The leg before the corner, from 0.
        leg: usize,
        /// The axis, from 0.
        axis: usize,
        /// The speed given.
        speed: f64,
    },
    /// The machine cannot be at a point of the path.
    #[error("leg {leg}, at {}: {reason}", SixDigits(*.s))]
    Path {
        /// The leg, from 0.
        leg: usize,
        /// The parameter.
        s: f64,
        /// What the path said.
        reason: E,
    },
    /// A position or a slope of a path is not a finite number.
    #[error("leg {leg}, at {}: a position or slope is not a finite number", SixDigits(*.s))]
    NotFinite {
        /// The leg, from 0.
        leg: usize,
        /// The parameter.
        s: f64,
    },
    /// The length of a path is not a number within the range of the crate.
    #[error("leg {leg}: a length of {} is not within the range of numbers", SixDigits(*.length))]
    Length {
        /// The leg, from 0.
        leg: usize,
        /// Its length.
        length: f64,
    },
    /// A leg does not begin where the one before ends, to the last bit.
    #[error("leg {leg}, axis {axis}: begins {} from where the leg before ends", SixDigits(*.by))]
    Gap {
        /// The leg, from 0.
        leg: usize,
        /// The axis, from 0.
        axis: usize,
        /// How far apart.
        by: f64,
    },
    /// A segment is so coarse that the path between its ends cannot be known from their slopes:
    /// more segments are needed.
    #[error("leg {leg}, at {}: the segment is too coarse for the path; use more segments", SixDigits(*.s))]
    TooCoarse {
        /// The leg, from 0.
        leg: usize,
        /// The parameter at which the segment begins.
        s: f64,
    },
    /// A leg would have more segments than can be told apart.
    #[error("leg {leg} would be cut into more than {max} segments")]
    TooFine {
        /// The leg, from 0.
        leg: usize,
        /// Largest number of segments of a leg.
        max: u32,
    },
    /// The memory given is too small.
    #[error("memory for {needed} knots or rows is needed, there is room for {available}")]
    Memory {
        /// Knots, or rows that run, that are enough.
        needed: usize,
        /// Those for which there is memory.
        available: usize,
    },
    /// An allowed departure that is not positive and finite.
    #[error("an allowed departure of {} is not a positive finite number", SixDigits(*.allowed))]
    Allowed {
        /// The departure given.
        allowed: f64,
    },
    /// A largest ratio of times that is not above 1.
    #[error("a largest time ratio of {} is not above 1", SixDigits(*.max_time_ratio))]
    TimeRatio {
        /// The ratio given.
        max_time_ratio: f64,
    },
    /// Two knots of a leg cannot be told apart: so near are they, or so late, that `f64` has the
    /// same numbers for both.
    #[error("leg {leg}: knot {knot} and the one before have the same positions or times")]
    Indistinct {
        /// The leg, from 0.
        leg: usize,
        /// The knot of the leg, from 0.
        knot: u32,
    },
    /// A scale of the speed that is above 1, or so low that times leave the range of the crate.
    #[error("a speed scale of {} is not within {}..=1", SixDigits(*.scale), SixDigits(*.min))]
    SpeedScale {
        /// The scale given.
        scale: f64,
        /// The lowest scale.
        min: f64,
    },
    /// A motor has not the torque to hold what it carries against gravity and friction, at any
    /// speed.
    #[error("leg {leg}, at {}: a motor has not the torque for what it carries, at any speed", SixDigits(*.s))]
    Overload {
        /// The leg, from 0.
        leg: usize,
        /// The parameter at which the segment begins.
        s: f64,
    },
    /// A highest feed that is beyond the range of the crate.
    #[error("a highest feed of {} is not within {}..={}", SixDigits(*.feed), SixDigits(*.min), SixDigits(*.max))]
    Feed {
        /// The feed given.
        feed: f64,
        /// The lowest.
        min: f64,
        /// The highest.
        max: f64,
    },
}

impl<E> PlanError<E> {
    /// The same error of another leg.
    pub(crate) fn of_leg(mut self, number: usize) -> Self {
        match &mut self {
            Self::Tool { leg, .. }
            | Self::StartStopSpeed { leg, .. }
            | Self::Path { leg, .. }
            | Self::NotFinite { leg, .. }
            | Self::Length { leg, .. }
            | Self::Gap { leg, .. }
            | Self::TooCoarse { leg, .. }
            | Self::TooFine { leg, .. }
            | Self::Overload { leg, .. }
            | Self::Indistinct { leg, .. } => *leg = number,
            Self::Limit { .. }
            | Self::Memory { .. }
            | Self::Allowed { .. }
            | Self::TimeRatio { .. }
            | Self::SpeedScale { .. }
            | Self::Feed { .. } => {}
        }
        self
    }
}
