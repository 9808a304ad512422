//! Why a curve is no path of a machine.

use core::fmt::{self, Display, Formatter};

use trig_kernels::SixDigits;

use crate::Refusal;

/// Why a curve of the tool is no path of the machine; nothing of it has been handed out.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum PathError<const N: usize> {
    /// The range of an axis is none: its ends are not in their order, or not numbers.
    Range {
        /// The axis.
        axis: &'static str,
        /// Lower end.
        min: f64,
        /// Upper end.
        max: f64,
    },
    /// The tool cannot be at a place of the curve.
    Unreachable {
        /// Arc length up to there.
        s: f64,
        /// The place.
        point: [f64; N],
        /// Why, and about how far it is from where it could be.
        reason: Refusal,
    },
    /// The branch ends at a place of the curve: beyond, there is none, or the curve would have to
    /// go on with another.
    BranchEnds {
        /// Arc length up to there.
        s: f64,
        /// The place.
        point: [f64; N],
        /// Why.
        reason: Refusal,
    },
    /// The machine is singular at a place of the curve: the tool could move there though no axis
    /// does, or an axis would have to be infinitely fast.
    Singular {
        /// Arc length up to there.
        s: f64,
        /// The place.
        point: [f64; N],
    },
    /// An axis would leave its range.
    Limit {
        /// Arc lengths of the piece of the curve, or the segment of a table, in which it would.
        s: [f64; 2],
        /// The axis.
        axis: &'static str,
        /// Where it is, or may be, farthest beyond.
        position: f64,
        /// Lower end of its range.
        min: f64,
        /// Upper end of its range.
        max: f64,
    },
    /// The tool would leave the machine's area.
    Area {
        /// Arc lengths of the piece of the curve, or the segment of a table, in which it would.
        s: [f64; 2],
        /// Number of the coordinate, from 0.
        coordinate: usize,
        /// Where it is, or may be, farthest beyond.
        position: f64,
        /// Lower end of its range.
        min: f64,
        /// Upper end of its range.
        max: f64,
    },
    /// An angle turns by more than three times on one curve.
    Turns {
        /// Arc length up to there.
        s: f64,
    },
    /// The cubics of a segment of a table leave the curve by so much that the tool may come to
    /// where it cannot be, or be anywhere: shorter segments are needed, or more distance from the
    /// edge of the workspace.
    TooCoarse {
        /// Arc lengths of its ends.
        s: [f64; 2],
    },
}

impl<const N: usize> Display for PathError<N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range { axis, min, max } => write!(
                f,
                "{}..={} is no range of the {axis}",
                SixDigits(*min),
                SixDigits(*max)
            ),
            Self::Unreachable { s, point, reason } => write!(f, "{}: {reason}", At(*s, point)),
            Self::BranchEnds { s, point, reason } => write!(
                f,
                "{}: the branch ends where {}",
                At(*s, point),
                reason.reason
            ),
            Self::Singular { s, point } => write!(f, "{}: the machine is singular", At(*s, point)),
            Self::Limit {
                s,
                axis,
                position,
                min,
                max,
            } => write!(
                f,
                "{}: the {axis} goes to {}",
                Between(*s),
                Beyond(*position, *min, *max)
            ),
            Self::Area {
                s,
                coordinate,
                position,
                min,
                max,
            } => write!(
                f,
                "{}: coordinate {coordinate} of the tool goes to {}",
                Between(*s),
                Beyond(*position, *min, *max)
            ),
            Self::Turns { s } => write!(
                f,
                "at {} of the curve: an angle has turned more than three times",
                SixDigits(*s)
            ),
            Self::TooCoarse { s } => write!(
                f,
                "{}: the segment is too coarse to tell where the tool is; use more segments, or stay away from the edge of the workspace",
                Between(*s)
            ),
        }
    }
}

impl<const N: usize> core::error::Error for PathError<N> {}

/// From one place of a curve to another.
struct Between([f64; 2]);

impl Display for Between {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [from, to] = self.0.map(SixDigits);
        write!(f, "from {from} to {to} of the curve")
    }
}

/// A position outside a range.
struct Beyond(f64, f64, f64);

impl Display for Beyond {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self(position, min, max) = *self;
        write!(
            f,
            "{}, outside its range {}..={} by {}",
            SixDigits(position),
            SixDigits(min),
            SixDigits(max),
            SixDigits((min - position).max(position - max))
        )
    }
}

/// A place of a curve.
struct At<'a, const N: usize>(f64, &'a [f64; N]);

impl<const N: usize> Display for At<'_, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "at {} of the curve, (", SixDigits(self.0))?;
        for (number, coordinate) in self.1.iter().enumerate() {
            let comma = if number == 0 { "" } else { ", " };
            write!(f, "{comma}{}", SixDigits(*coordinate))?;
        }
        f.write_str(")")
    }
}
