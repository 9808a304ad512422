//! Timers of any rate and width.

use proptest::prelude::*;
use stepper_sync::{CounterWidth, Timer};
use test_support::any_u32;

pub(crate) fn widths() -> impl Strategy<Value = CounterWidth> {
    prop_oneof![
        Just(CounterWidth::Bits8),
        Just(CounterWidth::Bits16),
        Just(CounterWidth::Bits24),
        Just(CounterWidth::Bits32),
    ]
}

/// A timer and whether its register holds what is left to the overflow.
pub(crate) fn timers() -> impl Strategy<Value = (Timer, bool)> {
    (any_u32(), any_u32(), widths(), 0..3_u8).prop_filter_map(
        "refused",
        |(hz, clocks, width, register)| {
            let timer = match register {
                0 => Timer::up_to_overflow(hz, clocks, width),
                1 => Timer::up_to_compare(hz, clocks, width),
                _ => Timer::down_to_zero(hz, clocks, width),
            };
            let fits = hz > 0 && (1..=Timer::MAX_CLOCKS_PER_TICK).contains(&clocks);
            assert_eq!(timer.is_ok(), fits);
            Some((timer.ok()?, register == 0))
        },
    )
}
