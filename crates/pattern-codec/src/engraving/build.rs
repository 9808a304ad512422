//! Motions of any length to records, and where the axes are after them.

use core::fmt;
use core::iter::FusedIterator;

use thiserror::Error;

use super::split::{FastRecords, SlowRecords};
use super::{Axis, JointPulses, PerAxis, Record};
use crate::size_hint::size_of_rest;

/// Makes the records of motions of any length and tracks where the axes are.
///
/// The position of an axis is the sum of its signed pulses. A call counts its whole motion at
/// once; the records come from the returned iterator, which holds no memory of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Builder {
    position: PerAxis<i32>,
}

impl Builder {
    /// Starts with all axes at their home, position 0.
    #[must_use]
    pub const fn new() -> Self {
        Self::at(PerAxis {
            elbow: 0,
            shoulder: 0,
            disc: 0,
            vertical: 0,
        })
    }

    /// Starts at a position, in pulses from home.
    #[must_use]
    pub const fn at(position: PerAxis<i32>) -> Self {
        Self { position }
    }

    /// Where the axes are, in pulses from home.
    #[must_use]
    pub const fn position(&self) -> PerAxis<i32> {
        self.position
    }

    /// Rapid motion of one axis: full records of 65535 pulses, then the rest. No pulses, no
    /// records.
    ///
    /// # Errors
    /// [`PositionOverflow`] when the position would leave the range of `i32`; it stays as it was.
    pub fn fast(
        &mut self,
        axis: Axis,
        pulses: i32,
    ) -> Result<impl FusedIterator<Item = Record> + Clone + fmt::Debug + use<>, PositionOverflow>
    {
        self.advance(axis, pulses)?;
        Ok(FastRecords::new(axis, pulses < 0, pulses.unsigned_abs()))
    }

    /// Cutting motion: as few records as 30 pulses each allow, all with the ratio of the joints as
    /// even as whole numbers can be. No pulses, no records.
    ///
    /// The motion T of each axis is cut into n equal parts, rounded in sum, not part by part:
    /// ```text
    /// n = ceil(max |T| / 30)
    /// position of the axis after part k:  sign(T) floor((k |T| + floor(n/2)) / n)
    /// ```
    /// So every part has floor or ceil of |T|/n pulses, never more than 30; at the end of every
    /// part each axis is within half a pulse of the straight line between start and end, which no
    /// other whole numbers do better; and the parts sum to T exactly.
    ///
    /// Splitting changes the path a little: within each record disc moves first and alone, so a
    /// split motion turns the disc in n small turns, where one record would make the whole turn
    /// before the arms start.
    ///
    /// # Errors
    /// [`PositionOverflow`] when a position would leave the range of `i32`; all stay as they were.
    pub fn slow(
        &mut self,
        pulses: JointPulses,
    ) -> Result<impl FusedIterator<Item = Record> + Clone + fmt::Debug + use<>, PositionOverflow>
    {
        let mut next = *self;
        next.advance(Axis::Disc, pulses.disc)?;
        next.advance(Axis::Elbow, pulses.elbow)?;
        next.advance(Axis::Shoulder, pulses.shoulder)?;
        *self = next;
        Ok(SlowRecords::new(pulses))
    }

    /// Counts a record from elsewhere, such as a decoded one.
    ///
    /// # Errors
    /// [`PositionOverflow`] when a position would leave the range of `i32`; all stay as they were.
    pub fn track(&mut self, record: Record) -> Result<(), PositionOverflow> {
        match record {
            Record::Fast(fast) => self.advance(fast.axis(), fast.pulses()),
            Record::Slow(slow) => self.slow(slow.pulses()).map(drop),
        }
    }

    /// Rapid motion of every axis back to position 0, one after the other: the negative sums of
    /// all pulses so far.
    ///
    /// ```
    /// use pattern_codec::engraving::{Axis, Builder, PerAxis};
    ///
    /// let mut builder = Builder::at(PerAxis { elbow: 70_000, shoulder: -5, disc: 0, vertical: -90 });
    /// let lift_first = [Axis::Vertical, Axis::Disc, Axis::Elbow, Axis::Shoulder];
    /// let home: Vec<_> = builder.home(lift_first)?.map(|record| record.pulses()).collect();
    /// assert_eq!(home[0].vertical, 90);
    /// assert_eq!((home[1].elbow, home[2].elbow), (-65_535, -4_465));
    /// assert_eq!(home[3].shoulder, 5);
    /// # Ok::<(), pattern_codec::engraving::RepeatedAxis>(())
    /// ```
    /// The order is the caller's, because where home is decides what must go first: with the
    /// lifted tool at vertical 0, [`Axis::Vertical`].
    ///
    /// # Errors
    /// [`RepeatedAxis`] when an axis comes twice in `order`, and so another one not at all.
    pub fn home(
        &mut self,
        order: [Axis; 4],
    ) -> Result<impl FusedIterator<Item = Record> + Clone + fmt::Debug + use<>, RepeatedAxis> {
        let mut seen = PerAxis::<bool>::default();
        for axis in order {
            if core::mem::replace(seen.get_mut(axis), true) {
                return Err(RepeatedAxis { axis });
            }
        }
        let runs = order.map(|axis| {
            let position = *self.position.get(axis);
            FastRecords::new(axis, position > 0, position.unsigned_abs())
        });
        *self = Self::new();
        Ok(HomeRecords { runs })
    }

    fn advance(&mut self, axis: Axis, pulses: i32) -> Result<(), PositionOverflow> {
        let position = self.position.get_mut(axis);
        *position = position.checked_add(pulses).ok_or(PositionOverflow {
            axis,
            position: *position,
            pulses,
        })?;
        Ok(())
    }
}

/// FAST records that bring all axes home.
#[derive(Debug, Clone)]
struct HomeRecords {
    runs: [FastRecords; 4],
}

impl Iterator for HomeRecords {
    type Item = Record;

    fn next(&mut self) -> Option<Record> {
        self.runs.iter_mut().find_map(Iterator::next)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let records = self.runs.iter().map(FastRecords::remaining);
        // At most 32,769 each.
        size_of_rest(records.fold(0, u64::wrapping_add))
    }
}

impl FusedIterator for HomeRecords {}

/// A position that does not fit into `i32`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{axis}: {pulses} pulses from position {position} leave the range of 32 bits")]
#[non_exhaustive]
pub struct PositionOverflow {
    /// The axis.
    pub axis: Axis,
    /// Where it is, in pulses from home.
    pub position: i32,
    /// The signed pulses that it was to make.
    pub pulses: i32,
}

/// An axis that comes twice in a homing order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{axis} comes twice in the homing order")]
#[non_exhaustive]
pub struct RepeatedAxis {
    /// The axis.
    pub axis: Axis,
}
