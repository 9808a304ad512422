//! Steps by differences, and what plays them.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_sign_loss,
    clippy::integer_division_remainder_used,
    reason = "bits of counts below 2^10; constant divisors"
)]

use crate::Direction;
use core::iter::FusedIterator;

/// The most steps of a segment.
pub(crate) const MAX_COUNT: u16 = 1024;

/// Up to 1024 steps of one axis in one direction, whose times are a cubic of their number.
///
/// ```text
/// t(0) = phase 2^-8                     in ticks after the tick of the first step
/// t(k + 1) = t(k) + d1(k)               d1(0) = interval 2^-(16 - c)
/// d1(k + 1) = d1(k) + d2(k)             d2(0) = second 2^-(24 - 2 c)
/// d2(k + 1) = d2(k) + third 2^-(32 - 3 c)
/// step k comes floor(t(k)) ticks after the first, k < count <= 2^(10 - c)
/// ```
/// with the greatest whole c: fewer steps need fewer bits. Rounding the differences to these moves
/// a step by at most
/// ```text
/// 2^-9 + k 2^-(17 - c) + k²/2 2^-(25 - 2 c) + k³/6 2^-(33 - 3 c) <= 0.0463 ticks
/// ```
/// The first step comes [`delay_ticks`](Self::delay_ticks) after the last one of the segment
/// before. Of one step phase and differences are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Segment {
    pub(crate) delay_ticks: u64,
    pub(crate) count: u16,
    pub(crate) direction: Direction,
    pub(crate) phase: u8,
    pub(crate) interval: i64,
    pub(crate) second: i64,
    pub(crate) third: i64,
}

/// Fraction bits of a segment's differences.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units {
    pub(crate) interval: u32,
    pub(crate) second: u32,
    pub(crate) third: u32,
}

impl Units {
    /// For 2 steps and more.
    pub(crate) const fn of(count: u16) -> Self {
        // c: 0 for more than 512 steps, 9 for two.
        let coarser = (count.wrapping_sub(1).leading_zeros() % 16).saturating_sub(6);
        Self {
            interval: 16 - coarser,
            second: 24 - 2 * coarser,
            third: 32 - 3 * coarser,
        }
    }
}

impl Segment {
    /// Ticks from the last step of the segment before, or from the start, to the first of this one.
    #[must_use]
    pub const fn delay_ticks(&self) -> u64 {
        self.delay_ticks
    }

    /// Steps, 1 to 1024.
    #[must_use]
    pub const fn count(&self) -> u16 {
        self.count
    }

    /// Their direction.
    #[must_use]
    pub const fn direction(&self) -> Direction {
        self.direction
    }

    /// Ticks from the first step to the last.
    #[must_use]
    pub const fn span_ticks(&self) -> u32 {
        // In all below 2^32, as decoding checks; a row has no more.
        let last = self.count.saturating_sub(1) as u32;
        let pairs = last.wrapping_mul(last.saturating_sub(1)) / 2;
        let triples = pairs.wrapping_mul(last.saturating_sub(2)) / 3;
        let player = self.intervals();
        let time = player
            .time
            .wrapping_add((last as u64).wrapping_mul(player.interval as u64))
            .wrapping_add((pairs as u64).wrapping_mul(player.second as u64))
            .wrapping_add((triples as u64).wrapping_mul(player.third as u64));
        (time >> 32) as u32
    }

    /// The intervals between its steps.
    #[must_use]
    pub const fn intervals(&self) -> SegmentPlayer {
        let mut player = SegmentPlayer::new();
        player.load(self);
        player
    }
}

/// Plays segments: what an interrupt handler has of an axis.
///
/// [`load`](Self::load) a segment when its first step is next, then call
/// [`next`](Iterator::next) after each step: three additions, no multiplication, division or panic.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SegmentPlayer {
    /// In 2^-32 ticks.
    time: u64,
    interval: i64,
    second: i64,
    third: i64,
    left: u16,
}

impl SegmentPlayer {
    /// Nothing to play.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            time: 0,
            interval: 0,
            second: 0,
            third: 0,
            left: 0,
        }
    }

    /// Takes a segment, and returns the ticks from the last step to its first.
    pub const fn load(&mut self, segment: &Segment) -> u64 {
        let units = Units::of(segment.count);
        *self = Self {
            time: (segment.phase as u64) << 24,
            interval: segment.interval << (32 - units.interval),
            second: segment.second << (32 - units.second),
            third: segment.third << (32 - units.third),
            left: segment.count.saturating_sub(1),
        };
        segment.delay_ticks
    }

    /// What comes next, in 2^-32 ticks.
    pub(crate) const fn differences(&self) -> [i64; 3] {
        [self.interval, self.second, self.third]
    }
}

impl Iterator for SegmentPlayer {
    type Item = u32;

    /// Ticks from the last step to the next one of the segment.
    #[inline]
    fn next(&mut self) -> Option<u32> {
        self.left = self.left.checked_sub(1)?;
        let last = self.time >> 32;
        self.time = self.time.wrapping_add_signed(self.interval);
        self.interval = self.interval.wrapping_add(self.second);
        self.second = self.second.wrapping_add(self.third);
        Some(((self.time >> 32) as u32).wrapping_sub(last as u32))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::from(self.left);
        (left, Some(left))
    }
}

impl ExactSizeIterator for SegmentPlayer {}

impl FusedIterator for SegmentPlayer {}
