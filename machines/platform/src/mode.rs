//! What a table says of each point.

/// What a table says of each point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[expect(
    clippy::exhaustive_enums,
    reason = "the two kinds that a command line offers"
)]
pub enum Mode {
    /// Positions: the axes move linearly between two points. Speeds are kept, accelerations and
    /// jerks are not.
    Pt,
    /// Positions and velocities: the axes run cubics within speed, acceleration and jerk.
    #[default]
    Pvt,
}

impl Mode {
    /// The name of the table's file.
    #[must_use]
    pub const fn file(self) -> &'static str {
        match self {
            Self::Pt => "pt.csv",
            Self::Pvt => "pvt.csv",
        }
    }

    /// The limits of the platform file that the plan keeps.
    pub(crate) const fn keeps(self) -> &'static [&'static str] {
        match self {
            Self::Pt => &["speed_mm_s"],
            Self::Pvt => &["speed_mm_s", "acceleration_mm_s2", "jerk_mm_s3"],
        }
    }
}
