//! The moves of a point on a grid.

/// One move of a point on the grid of steps.
///
/// X is to the right, Y up. The first four are steps of one axis, R L U D in step strings; in the
/// others both axes step at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
#[expect(
    clippy::exhaustive_enums,
    reason = "a point has eight neighbours on a grid"
)]
pub enum Move {
    /// x + 1.
    Right = PLUS_X,
    /// x - 1.
    Left = MINUS_X,
    /// y + 1.
    Up = PLUS_Y,
    /// y - 1.
    Down = MINUS_Y,
    /// x + 1, y + 1.
    UpRight = PLUS_X | PLUS_Y,
    /// x - 1, y + 1.
    UpLeft = MINUS_X | PLUS_Y,
    /// x + 1, y - 1.
    DownRight = PLUS_X | MINUS_Y,
    /// x - 1, y - 1.
    DownLeft = MINUS_X | MINUS_Y,
}

const PLUS_X: u8 = 1;
const MINUS_X: u8 = 2;
const PLUS_Y: u8 = 4;
const MINUS_Y: u8 = 8;

impl Move {
    /// Change of x, in steps: -1, 0 or 1.
    #[must_use]
    #[inline]
    pub const fn dx(self) -> i32 {
        self.difference(PLUS_X, MINUS_X)
    }

    /// Change of y, in steps: -1, 0 or 1.
    #[must_use]
    #[inline]
    pub const fn dy(self) -> i32 {
        self.difference(PLUS_Y, MINUS_Y)
    }

    const fn difference(self, plus: u8, minus: u8) -> i32 {
        let bits = self as u8;
        ((bits & plus != 0) as i32).wrapping_sub((bits & minus != 0) as i32)
    }

    /// Whether both axes step.
    #[must_use]
    pub const fn is_diagonal(self) -> bool {
        self.dx() != 0 && self.dy() != 0
    }

    /// The move by these signs; `None` where both are 0.
    pub(crate) const fn of_signs(dx: i64, dy: i64) -> Option<Self> {
        Some(match (dx.signum(), dy.signum()) {
            (1, 0) => Self::Right,
            (-1, 0) => Self::Left,
            (0, 1) => Self::Up,
            (0, -1) => Self::Down,
            (1, 1) => Self::UpRight,
            (-1, 1) => Self::UpLeft,
            (1, -1) => Self::DownRight,
            (-1, -1) => Self::DownLeft,
            _ => return None,
        })
    }

    /// Turned by 90 degrees counter-clockwise.
    pub(crate) const fn turned(self) -> Self {
        match self {
            Self::Right => Self::Up,
            Self::Up => Self::Left,
            Self::Left => Self::Down,
            Self::Down => Self::Right,
            Self::UpRight => Self::UpLeft,
            Self::UpLeft => Self::DownLeft,
            Self::DownLeft => Self::DownRight,
            Self::DownRight => Self::UpRight,
        }
    }

    /// Turned by 180 degrees.
    pub(crate) const fn reversed(self) -> Self {
        self.turned().turned()
    }

    /// Mirrored on the line x = y.
    pub(crate) const fn mirrored(self) -> Self {
        match self {
            Self::Right => Self::Up,
            Self::Up => Self::Right,
            Self::Left => Self::Down,
            Self::Down => Self::Left,
            Self::UpLeft => Self::DownRight,
            Self::DownRight => Self::UpLeft,
            Self::UpRight | Self::DownLeft => self,
        }
    }
}

/// Which of two single steps a 4-connected path takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Rule {
    /// The step against the sign of F, as published \[Stage\]: up to a whole step off the curve. On
    /// a line along Y, where the published rule leaves the line, the axis at its end stands still.
    Published,
    /// The step after which |F| is smaller, of equals the outer one: as many steps to the same end,
    /// at most 0.7072 steps off the curve.
    #[default]
    Nearest,
}

/// The direction around an arc's centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "there are two directions around")]
pub enum Turn {
    /// From +X towards +Y.
    CounterClockwise,
    /// From +X towards -Y.
    Clockwise,
}

/// The direction along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "an axis has two directions")]
pub enum Direction {
    /// Steps count up.
    Positive,
    /// Steps count down.
    Negative,
}

impl Direction {
    /// 1 or -1.
    #[must_use]
    pub const fn sign(self) -> i32 {
        match self {
            Self::Positive => 1,
            Self::Negative => -1,
        }
    }

    /// The opposite direction.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Positive => Self::Negative,
            Self::Negative => Self::Positive,
        }
    }
}
