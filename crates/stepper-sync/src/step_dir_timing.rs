//! What driver chips ask of their pins.

use crate::Rate;

/// The least ticks from a step to the next.
///
/// [`StepDirTiming::min_intervals`] has those of a driver's
/// data sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "written as a literal")]
pub struct MinIntervals {
    /// In the same direction: pulse and pause.
    pub step_ticks: u64,
    /// In the other direction: the same, or hold and setup time of the direction pin if longer.
    pub reversal_ticks: u64,
}

/// What a driver chip asks of its step and direction inputs, in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "written as a literal from a data sheet"
)]
pub struct StepDirTiming {
    /// Least time of the active level of a pulse.
    pub pulse_ns: u32,
    /// Least time from the end of a pulse to the next.
    pub pause_ns: u32,
    /// Least time from a change of direction to the next pulse.
    pub setup_ns: u32,
    /// Least time from the start of a pulse to a change of direction.
    pub hold_ns: u32,
}

impl StepDirTiming {
    /// Allegro A4988: 1 us, 1 us, 200 ns, 200 ns.
    pub const A4988: Self = Self {
        pulse_ns: 1000,
        pause_ns: 1000,
        setup_ns: 200,
        hold_ns: 200,
    };

    /// Texas Instruments DRV8825: 1.9 us, 1.9 us, 650 ns, 650 ns.
    pub const DRV8825: Self = Self {
        pulse_ns: 1900,
        pause_ns: 1900,
        setup_ns: 650,
        hold_ns: 650,
    };

    /// The same as the least ticks from a step to the next, each time rounded up.
    #[must_use]
    pub fn min_intervals(&self, tick_rate: Rate) -> MinIntervals {
        let ticks = |ns| ticks(ns, tick_rate);
        let step_ticks = ticks(self.pulse_ns).saturating_add(ticks(self.pause_ns));
        let turn_ticks = ticks(self.hold_ns).saturating_add(ticks(self.setup_ns));
        MinIntervals {
            step_ticks,
            reversal_ticks: step_ticks.max(turn_ticks),
        }
    }
}

/// Nanoseconds in ticks, rounded up.
#[expect(
    clippy::arithmetic_side_effects,
    reason = "2^32 · 2^32 - 1 and 10⁹ · 2^32 fit 64 bits; the divisor is not zero"
)]
fn ticks(ns: u32, tick_rate: Rate) -> u64 {
    let product = u64::from(ns) * u64::from(tick_rate.numerator());
    product.div_ceil(1_000_000_000 * u64::from(tick_rate.denominator()))
}
