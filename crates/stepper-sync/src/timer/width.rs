//! How many bits a counter has.

/// Number of bits of a counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the widths that timers have")]
pub enum CounterWidth {
    /// 8 bits: MCS-51 mode 2, AVR timer 0.
    Bits8,
    /// 16 bits: MCS-51 mode 1, AVR timer 1, most STM32 timers.
    Bits16,
    /// 24 bits: `SysTick` of the Cortex-M.
    Bits24,
    /// 32 bits: STM32 timer 2, nRF timers.
    Bits32,
}

impl CounterWidth {
    /// Longest period, 2^width ticks.
    #[must_use]
    pub const fn max_ticks(self) -> u64 {
        self.max_value().wrapping_add(1)
    }

    /// Largest count, 2^width - 1.
    #[must_use]
    pub const fn max_value(self) -> u64 {
        match self {
            Self::Bits8 => 0xFF,
            Self::Bits16 => 0xFFFF,
            Self::Bits24 => 0xFF_FFFF,
            Self::Bits32 => 0xFFFF_FFFF,
        }
    }

    /// log2 of [`max_ticks`](Self::max_ticks).
    pub(crate) const fn bits(self) -> u32 {
        match self {
            Self::Bits8 => 8,
            Self::Bits16 => 16,
            Self::Bits24 => 24,
            Self::Bits32 => 32,
        }
    }
}
