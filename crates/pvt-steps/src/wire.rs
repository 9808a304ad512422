//! Segments as bytes.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bits are cut out of counts; intervals are above 0"
)]

use crate::Direction;
use crate::leb128::{MAX_LEN, NumberError, Reader, put_signed, put_unsigned};
use crate::segment::{MAX_COUNT, Segment, Units};
use thiserror::Error;

/// So many steps are checked sooner one by one.
const FEW: u16 = 8;
/// In the first byte: the direction is negative.
const NEGATIVE: u8 = 0x80;
/// In the first byte: where the number of differences is.
const DIFFERENCES_SHIFT: u32 = 5;
/// In the first byte: the low bits of the count.
const LOW_COUNT: u8 = 0x1F;

/// Why bytes are no segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SegmentError {
    /// They end too early.
    #[error("{len} bytes end within a segment")]
    Truncated {
        /// Bytes given.
        len: usize,
    },
    /// A number has more than 64 bits, or more bytes than it needs.
    #[error("the number that ends with byte {at} is too long")]
    Number {
        /// Its last byte, from 0.
        at: usize,
    },
    /// The steps do not fit the differences: n differences take more than n steps, and more than
    /// one step at least one difference.
    #[error("{count} steps by {differences} differences")]
    Count {
        /// Steps.
        count: u32,
        /// Differences.
        differences: u8,
    },
    /// The last difference is 0: there should be one fewer.
    #[error("the last of {differences} differences is 0")]
    ZeroDifference {
        /// Differences.
        differences: u8,
    },
    /// A step comes less than 1 or more than 2^31 ticks after the one before it.
    #[error("step {step} comes less than 1 or more than 2^31 ticks after the one before it")]
    Interval {
        /// Number of the step, from 0.
        step: u16,
    },
    /// A step comes 2^32 ticks or more after the first.
    #[error("step {step} comes 2^32 ticks or more after the first")]
    Span {
        /// Number of the step, from 0.
        step: u16,
    },
}

impl From<NumberError> for SegmentError {
    fn from(error: NumberError) -> Self {
        match error {
            NumberError::Truncated { len } => Self::Truncated { len },
            NumberError::TooLong { at } => Self::Number { at },
        }
    }
}

/// # Bytes
/// | bytes | what | when |
/// |---|---|---|
/// | 1 | bit 7: negative direction; bits 6 and 5: n, the number of differences; bits 4 to 0: low bits of count - 1 | |
/// | 1 | high bits of count - 1 | n > 0 |
/// | 1 | phase | n > 0 |
/// | 1 to 10 | delay, unsigned | |
/// | 1 to 7 | interval, unsigned | n > 0 |
/// | 1 to 8 | second difference, signed | n > 1 |
/// | 1 to 10 | third difference, signed | n > 2 |
///
/// Numbers are LEB128: seven bits a byte, low ones first, bit 7 set in all bytes but the last.
/// Signed ones have their sign in the lowest bit: 0, -1, 1, -2 are 0, 1, 2, 3. A segment has one
/// spelling.
impl Segment {
    /// The most bytes of a segment.
    pub const MAX_ENCODED_LEN: usize = 3 + 4 * MAX_LEN;

    /// The segment as bytes, in the front of a buffer.
    pub fn encode<'b>(&self, buffer: &'b mut [u8; Self::MAX_ENCODED_LEN]) -> &'b [u8] {
        let differences = self.differences();
        let count = self.count.saturating_sub(1);
        let head = differences << DIFFERENCES_SHIFT | count as u8 & LOW_COUNT;
        let mut writer = Writer { buffer, len: 0 };
        writer.byte(match self.direction {
            Direction::Positive => head,
            Direction::Negative => head | NEGATIVE,
        });
        if differences > 0 {
            writer.byte((count >> 5) as u8);
            writer.byte(self.phase);
        }
        writer.unsigned(self.delay_ticks);
        if differences > 0 {
            writer.unsigned(self.interval as u64);
        }
        if differences > 1 {
            writer.signed(self.second);
        }
        if differences > 2 {
            writer.signed(self.third);
        }
        writer.finish()
    }

    /// The segment in the front of `bytes`, and the bytes after it.
    ///
    /// # Errors
    /// [`SegmentError`]. Whatever decodes is played forwards in time.
    pub fn decode(bytes: &[u8]) -> Result<(Self, &[u8]), SegmentError> {
        let mut reader = Reader::new(bytes);
        let head = reader.byte()?;
        let differences = (head >> DIFFERENCES_SHIFT) & 3;
        let mut count = u32::from(head & LOW_COUNT) + 1;
        let mut phase = 0;
        if differences > 0 {
            count += u32::from(reader.byte()?) << 5;
            phase = reader.byte()?;
        }
        let most = if differences > 0 { MAX_COUNT } else { 1 };
        let error = SegmentError::Count { count, differences };
        let count = u16::try_from(count)
            .ok()
            .filter(|&count| count > u16::from(differences) && count <= most)
            .ok_or(error)?;
        let mut segment = Self {
            delay_ticks: reader.unsigned()?,
            count,
            direction: if head & NEGATIVE == 0 {
                Direction::Positive
            } else {
                Direction::Negative
            },
            phase,
            interval: 0,
            second: 0,
            third: 0,
        };
        if differences > 0 {
            segment.interval = i64::try_from(reader.unsigned()?)
                .map_err(|_| SegmentError::Interval { step: 1 })?;
        }
        if differences > 1 {
            segment.second = reader.signed()?;
        }
        if differences > 2 {
            segment.third = reader.signed()?;
        }
        if segment.differences() != differences {
            return Err(SegmentError::ZeroDifference { differences });
        }
        segment.check_times()?;
        Ok((segment, reader.rest()))
    }

    /// Differences up to the last that is not 0.
    const fn differences(&self) -> u8 {
        match (self.interval, self.second, self.third) {
            (0, 0, 0) => 0,
            (_, 0, 0) => 1,
            (_, _, 0) => 2,
            _ => 3,
        }
    }

    /// Whether all steps come 1 to 2^31 ticks after the one before, and the last before 2^32.
    fn check_times(&self) -> Result<(), SegmentError> {
        if self.count > FEW && self.has_near_intervals() {
            Ok(())
        } else {
            self.check_each_time()
        }
    }

    /// The same step by step.
    fn check_each_time(&self) -> Result<(), SegmentError> {
        let units = Units::of(self.count);
        // In 2^-32 ticks, without what the player's sums of 64 bits may lose on top.
        let wide = |difference: i64, bits: u32| i128::from(difference) << (32 - bits);
        let mut time = i128::from(self.phase) << 24;
        let mut interval = wide(self.interval, units.interval);
        let mut second = wide(self.second, units.second);
        let third = wide(self.third, units.third);
        for step in 1..self.count {
            if !(1 << 32..=1 << 63).contains(&interval) {
                return Err(SegmentError::Interval { step });
            }
            time += interval;
            if time >> 64 > 0 {
                return Err(SegmentError::Span { step });
            }
            interval += second;
            second += third;
        }
        Ok(())
    }

    /// Whether the times are right for all intervals as far from the first as the differences
    /// allow, by their sizes alone: so it is but for a segment that almost stops or reverses.
    fn has_near_intervals(&self) -> bool {
        let units = Units::of(self.count);
        let wide = |difference: i64, bits: u32| {
            let (size, shift) = (difference.unsigned_abs(), 32 - bits);
            (size.leading_zeros() >= shift).then_some(size << shift)
        };
        let steps = u64::from(self.count);
        let bounds = || {
            let second = wide(self.second, units.second)?.checked_mul(steps)?;
            let third = wide(self.third, units.third)?.checked_mul((steps * steps) >> 1)?;
            let change = second.checked_add(third)?;
            let first = wide(self.interval, units.interval)?;
            Some((first.checked_sub(change)?, first.checked_add(change)?))
        };
        bounds().is_some_and(|(least, most)| {
            // At most 2^10 steps take less than 2^63, and the phase is less than a tick.
            self.interval > 0 && least >= 1 << 32 && most < 1 << 53
        })
    }
}

/// Fills the front of a buffer that everything fits in.
struct Writer<'b> {
    buffer: &'b mut [u8; Segment::MAX_ENCODED_LEN],
    len: usize,
}

impl<'b> Writer<'b> {
    fn byte(&mut self, byte: u8) {
        if let Some(place) = self.buffer.get_mut(self.len) {
            *place = byte;
            self.len += 1;
        }
    }

    fn unsigned(&mut self, number: u64) {
        put_unsigned(number, |byte| self.byte(byte));
    }

    fn signed(&mut self, number: i64) {
        put_signed(number, |byte| self.byte(byte));
    }

    fn finish(self) -> &'b [u8] {
        self.buffer.get(..self.len).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::strategy::ValueTree as _;
    use proptest::test_runner::TestRunner;

    /// Any number of up to this many bits, all lengths as often.
    fn sized(bits: u32) -> impl Strategy<Value = i64> {
        (any::<u64>(), 64 - bits..64).prop_map(|(number, shift)| (number >> shift).cast_signed())
    }

    /// Differences of all sizes; what is taken by its sizes has no step out of bounds.
    #[test]
    fn near_intervals_are_in_bounds() {
        let difference = || (sized(40), sized(40)).prop_map(|(a, b)| a - b);
        let count = sized(10).prop_map(|count| 2 + (count as u16).min(MAX_COUNT - 2));
        let all = (count, any::<u8>(), sized(48), difference(), difference());
        let segments = all.prop_map(|(count, phase, interval, second, third)| Segment {
            delay_ticks: 0,
            count,
            direction: Direction::Positive,
            phase,
            interval,
            second,
            third,
        });
        let mut runner = TestRunner::deterministic();
        let (mut near, mut others) = (0, 0);
        for _ in 0..20_000 {
            let segment = segments.new_tree(&mut runner).unwrap().current();
            let times = segment.check_each_time();
            if segment.has_near_intervals() {
                assert_eq!(times, Ok(()), "{segment:?}");
                near += 1;
            } else if times.is_ok() {
                others += 1;
            }
        }
        assert!(near > 500 && others > 500, "{near} {others}");
    }
}
