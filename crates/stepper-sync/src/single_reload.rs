//! One fixed reload per axis: the published method, kept to show what it costs.

use crate::{AxisTrain, CounterWidth};

/// How a fixed reload is taken from the exact interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the two methods of programs")]
pub enum Rounding {
    /// To the nearest tick, halves up.
    Nearest,
    /// Down, as integer division does.
    Down,
}

/// A train whose edges all have the same interval: the single reload of [Engraver 2000].
///
/// ```text
/// interval = round(n_max T / n)   or floor
/// end      = 2 n interval
/// skew     = end - D              D = 2 n_max T
/// ```
/// Over all pairs of 1..30 pulses two such trains end up to 24 ticks apart (rounded) or 42
/// (truncated); 65535 and 32768 pulses end 8192 apart for T = 4096. [`Trains`](crate::Trains)
/// ends with no skew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub struct SingleReload {
    edges: u64,
    interval_ticks: u64,
    planned_end_ticks: u64,
}

impl SingleReload {
    pub(crate) fn new(axis: &AxisTrain, planned_end_ticks: u64, rounding: Rounding) -> Self {
        // D mod 2n = 2 (n_max T mod n): compared with n, that is the remainder against n / 2.
        let up = match rounding {
            Rounding::Nearest => axis.remaining() > 0 && axis.long_intervals() >= axis.pulses(),
            Rounding::Down => false,
        };
        Self {
            edges: axis.remaining(),
            interval_ticks: axis.shortest_ticks().saturating_add(u64::from(up)),
            planned_end_ticks: if axis.remaining() == 0 {
                0
            } else {
                planned_end_ticks
            },
        }
    }

    /// The same train in a program that keeps only the low bits of the interval.
    ///
    /// At T = 4096 the ratio 30:1 needs 122,880 ticks; 16 bits keep 57,344, and that axis ends at
    /// 47 % of the time. An interval of 0 is the full count of the timer.
    pub fn kept_by(self, width: CounterWidth) -> Self {
        let kept = self.interval_ticks & width.max_value();
        Self {
            interval_ticks: if kept == 0 && self.edges > 0 {
                width.max_ticks()
            } else {
                kept
            },
            ..self
        }
    }

    /// Ticks between two edges; 0 for an axis at rest.
    #[must_use]
    pub const fn interval_ticks(&self) -> u64 {
        self.interval_ticks
    }

    /// The tick of the last edge; 0 for an axis at rest. One reload too long for all of 2^32 edges
    /// may end past 64 bits.
    #[must_use]
    pub fn end_ticks(&self) -> u128 {
        u128::from(self.edges).saturating_mul(u128::from(self.interval_ticks))
    }

    /// Last edge minus the tick D at which it should be; 0 for an axis at rest.
    #[must_use]
    pub fn skew_ticks(&self) -> i128 {
        // Below 2^97: neither the casts nor the difference wrap.
        self.end_ticks()
            .cast_signed()
            .wrapping_sub(u128::from(self.planned_end_ticks).cast_signed())
    }
}
