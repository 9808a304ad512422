//! Records, bytes, pulses and duration of a sequence of records.

use super::{PerAxis, RECORD_LEN, Record};

/// What a sequence of records amounts to, in constant memory.
///
/// ```
/// use pattern_codec::engraving::{Format, HalfPeriods, Statistics};
///
/// let bytes = [0x7F, 0x01, 0x00, 0x00, 0x8A, 0x1E];
/// let mut statistics = Statistics::default();
/// for located in Format::default().records(&bytes) {
///     statistics.add(located?.record);
/// }
/// assert_eq!(statistics.records(), 2);
/// assert_eq!(statistics.pulses.vertical, 256);
/// let half_periods = HalfPeriods { fast_ticks: 1000, slow_ticks: 4096 };
/// assert_eq!(statistics.duration_ticks(half_periods), 2 * (256 * 1000 + 30 * 4096));
/// # Ok::<(), pattern_codec::engraving::DecodeError>(())
/// ```
///
/// All counts are `u64` and saturate, which no sequence of fewer than 2^48 records reaches.
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
    /// Pulses during which FAST records take their time.
    pub fast_periods: u64,
    /// Pulses during which SLOW records take their time: those of theta3, then those of the faster
    /// arm.
    pub slow_periods: u64,
}

impl Statistics {
    /// Counts one record.
    #[inline]
    pub fn add(&mut self, record: Record) {
        let pulses = record.pulses();
        let [theta1, theta2, theta3, vertical] =
            [pulses.theta1, pulses.theta2, pulses.theta3, pulses.vertical]
                .map(|pulses| u64::from(pulses.unsigned_abs()));
        let periods = theta3
            .saturating_add(theta1.max(theta2))
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
        add_to(&mut self.pulses.theta1, theta1);
        add_to(&mut self.pulses.theta2, theta2);
        add_to(&mut self.pulses.theta3, theta3);
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
        self.records().saturating_mul(RECORD_LEN as u64)
    }

    /// Time that the pulses take, in ticks of the timer.
    ///
    /// ```text
    /// 2 (fast_periods T_fast + slow_periods T_slow)
    /// ```
    /// A pulse is two half periods. The arm with fewer pulses waits for the other, so it costs no
    /// time of its own; a record without motion takes none. Ramps and the time that the reader
    /// spends between records are not part of it.
    #[must_use]
    pub fn duration_ticks(&self, half_periods: HalfPeriods) -> u128 {
        let HalfPeriods {
            fast_ticks,
            slow_ticks,
        } = half_periods;
        let part = |periods: u64, ticks: u32| {
            // Below 2^97.
            u128::from(periods)
                .saturating_mul(u128::from(ticks))
                .saturating_mul(2)
        };
        part(self.fast_periods, fast_ticks).saturating_add(part(self.slow_periods, slow_ticks))
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

/// Time between two edges of a pulse train, for each kind of record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "there are two kinds of record")]
pub struct HalfPeriods {
    /// Half period of FAST records, in ticks.
    pub fast_ticks: u32,
    /// Half period of SLOW records, of theta3 and of the arm with more pulses, in ticks.
    pub slow_ticks: u32,
}
