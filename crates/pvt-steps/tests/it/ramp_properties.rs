//! What holds for every ramp that is not refused.

use proptest::prelude::*;
use pvt_steps::{AxisRamp, Ramp, RampEnds, RampLimits, Rate};
use test_support::{any_i32, any_u32};

/// Any limits and tick rates, most of them extreme, some of which no ramp has.
fn any_ramp() -> impl Strategy<Value = (RampLimits, Rate)> {
    let rates = (any_u32(), prop_oneof![Just(1), 1..=1_u32 << 20, any_u32()])
        .prop_filter_map("no ticks", |(n, d)| Rate::new(n, d).ok());
    let limits = (any_u32(), any_u32(), any_u32(), 0..8_u8);
    (limits, rates).prop_map(|((a, b, accel, order), rate)| {
        let (least, most) = (a.min(b), a.max(b));
        let (start, max) = if order > 0 {
            (least, most)
        } else {
            (most, least)
        };
        let limits = RampLimits {
            start_millihertz: start,
            max_millihertz: max,
            accel_steps_per_s2: accel,
        };
        (limits, rate)
    })
}

/// Limits and tick rates of real motors and timers: acceleration times of 1 ms to 10 s, or as short
/// as may be.
fn real_ramp() -> impl Strategy<Value = (RampLimits, Rate)> {
    let tick_rates = (100_000..=200_000_000_u32, 1..=64_u32);
    (
        tick_rates,
        10_000..=50_000_000_u32,
        0..=999_u32,
        prop_oneof![1 => Just(0), 3 => 1..=10_000_u32],
    )
        .prop_filter_map(
            "too fast for the timer",
            |((clock, divider), max, start, ms)| {
                let rate = Rate::new(clock, divider).ok()?;
                // max / 1000 steps/s in `ms` milliseconds.
                let accel = u64::from(max).checked_div(u64::from(ms));
                let accel = u32::try_from(accel.unwrap_or(u32::MAX.into())).ok()?.max(1);
                let start = u64::from(max) * u64::from(start) / 1000;
                let limits = RampLimits {
                    start_millihertz: u32::try_from(start).ok()?,
                    max_millihertz: max,
                    accel_steps_per_s2: accel,
                };
                Ramp::new([1], &limits, rate)
                    .is_ok()
                    .then_some((limits, rate))
            },
        )
}

/// Checks the edges, and returns the intervals between steps, the first from the start.
fn steps(axis: AxisRamp, steps: i32, end: u64) -> Result<Vec<u64>, TestCaseError> {
    let edges = axis.remaining();
    prop_assert_eq!(edges, 2 * u64::from(steps.unsigned_abs()));
    let intervals: Vec<u64> = axis.collect();
    prop_assert_eq!(intervals.len() as u64, edges);
    prop_assert!(intervals.iter().all(|&interval| interval > 0));
    prop_assert!(intervals.iter().sum::<u64>() <= end);
    let mut low = 0;
    let steps = intervals.chunks(2).map(|pair| {
        let step = low + pair[0];
        low = pair[1];
        step
    });
    Ok(steps.collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn short_moves_at_any_limits_make_all_steps(
        (limits, rate) in any_ramp(),
        n in prop::array::uniform3(-300..=300_i32),
        (entry_millihertz, exit_millihertz) in (any_u32(), any_u32()),
    ) {
        let ends = RampEnds { entry_millihertz, exit_millihertz };
        let ramps = [Ramp::new(n, &limits, rate), Ramp::between(n, &limits, ends, rate)];
        for ramp in ramps.into_iter().flatten() {
            for (axis, n) in ramp.axes().into_iter().zip(n) {
                steps(axis, n, ramp.end_ticks())?;
            }
        }
    }

    #[test]
    fn long_moves_at_any_limits_go_forward((limits, rate) in any_ramp(), steps in [any_i32(), any_i32()]) {
        if let Ok(ramp) = Ramp::new(steps, &limits, rate) {
            prop_assert!(limits.start_millihertz <= limits.max_millihertz);
            prop_assert!(limits.accel_steps_per_s2 > 0 && !steps.contains(&i32::MIN));
            let mut last = 0;
            for edge in ramp.edges().take(300).take_while(|edge| edge.ticks < PATIENCE_TICKS) {
                prop_assert!(edge.ticks >= last && edge.ticks <= ramp.end_ticks());
                last = edge.ticks;
            }
            for (axis, n) in ramp.axes().into_iter().zip(steps) {
                prop_assert_eq!(axis.remaining(), 2 * u64::from(n.unsigned_abs()));
                let mut ticks = 0;
                for interval in axis.take(300) {
                    prop_assert!(interval > 0);
                    ticks += interval;
                    if ticks > PATIENCE_TICKS {
                        break;
                    }
                }
            }
        }
    }
}

/// Rows of 2^31 ticks pass one by one: for a step in years there are too many.
const PATIENCE_TICKS: u64 = 1 << 42;

/// Steps are off their places by less than 2 ticks, so that the difference of two intervals is off
/// by less than 8.
const TREND_TICKS: u64 = 8;

proptest! {
    #[test]
    fn speed_rises_to_the_limit_and_falls(
        (limits, rate) in real_ramp(),
        n in 1..=3000_i32,
        m in 0..=3000_i32,
    ) {
        let ramp = Ramp::new([n, -m.min(n)], &limits, rate).unwrap();
        // A period at the highest rate, rounded down, in ticks.
        let fastest = 1000 * u64::from(rate.numerator())
            / (u64::from(rate.denominator()) * u64::from(limits.max_millihertz));
        for (axis, n) in ramp.axes().into_iter().zip([n, m.min(n)]) {
            let steps = steps(axis, n, ramp.end_ticks())?;
            // The first interval is that of half a step.
            for &interval in steps.iter().skip(1) {
                prop_assert!(interval + 4 > fastest);
            }
            let between = steps.get(1..).unwrap_or_default();
            let (up, down) = between.split_at(between.len() / 2);
            for pair in up.windows(2) {
                prop_assert!(pair[1] <= pair[0] + TREND_TICKS, "{pair:?}");
            }
            for pair in down.windows(2) {
                prop_assert!(pair[0] <= pair[1] + TREND_TICKS, "{pair:?}");
            }
            // Deceleration mirrors acceleration.
            for (a, b) in up.iter().zip(down.iter().rev()) {
                prop_assert!(a.abs_diff(*b) <= TREND_TICKS, "{a} and {b}");
            }
        }
    }
}
