//! Records, bytes, pulses and pulse periods of a sequence of records.

use super::{PerAxis, Record};

/// What a sequence of records amounts to, in constant memory.
///
/// ```
/// use pattern_codec::engraving::{Format, Statistics};
///
/// let bytes = [0x7F, 0x01, 0x00, 0x00, 0x8A, 0x1E];
/// let mut statistics = Statistics::default();
/// for located in Format::default().records(&bytes) {
///     statistics.add(located?.record);
/// }
/// assert_eq!(statistics.records(), 2);
/// assert_eq!(statistics.pulses.vertical, 256);
/// // Half periods of 1000 and 4096 ticks of the timer.
/// let ticks = 2 * (statistics.fast_periods * 1000 + statistics.slow_periods * 4096);
/// assert_eq!(ticks, 2 * (256 * 1000 + 30 * 4096));
/// # Ok::<(), pattern_codec::engraving::DecodeError>(())
/// ```
///
/// A pulse period is two half periods of the train. Ramps and the time that the reader spends
/// between records are not part of it. All counts are `u64` and saturate, which no sequence of
/// fewer than 2^48 records reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Statistics {
    /// FAST records.
    pub fast_records: u64,
    /// SLOW records.
    pub slow_records: u64,
    /// Records that move nothing: FAST 0 and SLOW 0, 0, 0.
    pub idle_records: u64,
    /// Pulses of each axis, both directions together.
    pub pulses: PerAxis<u64>,
    /// Pulse periods that FAST records take.
    pub fast_periods: u64,
    /// Pulse periods that SLOW records take: those of disc, then those of the arm with more
    /// pulses, for which the other waits.
    pub slow_periods: u64,
}

impl Statistics {
    /// Counts one record.
    #[inline]
    pub fn add(&mut self, record: Record) {
        let pulses = record.pulses();
        let [elbow, shoulder, disc, vertical] =
            [pulses.elbow, pulses.shoulder, pulses.disc, pulses.vertical]
                .map(|pulses| u64::from(pulses.unsigned_abs()));
        let periods = disc
            .saturating_add(elbow.max(shoulder))
            .saturating_add(vertical);
        let (records, kind_periods) = match record {
            Record::Fast(_) => (&mut self.fast_records, &mut self.fast_periods),
            Record::Slow(_) => (&mut self.slow_records, &mut self.slow_periods),
        };
        add_to(records, 1);
        add_to(kind_periods, periods);
        if periods == 0 {
            add_to(&mut self.idle_records, 1);
        }
        add_to(&mut self.pulses.elbow, elbow);
        add_to(&mut self.pulses.shoulder, shoulder);
        add_to(&mut self.pulses.disc, disc);
        add_to(&mut self.pulses.vertical, vertical);
    }

    /// FAST and SLOW records.
    #[must_use]
    pub const fn records(&self) -> u64 {
        self.fast_records.saturating_add(self.slow_records)
    }

    /// Length in bytes, three for each record.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.records().saturating_mul(Record::LEN as u64)
    }
}

impl Extend<Record> for Statistics {
    fn extend<I: IntoIterator<Item = Record>>(&mut self, records: I) {
        for record in records {
            self.add(record);
        }
    }
}

impl FromIterator<Record> for Statistics {
    fn from_iter<I: IntoIterator<Item = Record>>(records: I) -> Self {
        let mut statistics = Self::default();
        statistics.extend(records);
        statistics
    }
}

#[inline]
fn add_to(sum: &mut u64, value: u64) {
    *sum = sum.saturating_add(value);
}
