//! What holds for every ramp that is not refused.
#![cfg(test)]

use proptest::prelude::*;
use stepper_sync::{AxisRamp, Ramp, RampLimits, Rate};

/// Numbers of all magnitudes up to 32 bits.
fn magnitudes() -> impl Strategy<Value = u32> {
    (0..=31_u32, any::<u32>()).prop_map(|(shift, bits)| bits >> shift)
}

/// Any limits and tick rates, most of them extreme.
fn any_ramp() -> impl Strategy<Value = (RampLimits, Rate)> {
    let rates = (magnitudes(), prop_oneof![Just(1), 1..=1_u32 << 20])
        .prop_filter_map("no ticks", |(n, d)| Rate::new(n, d).ok());
    (magnitudes(), magnitudes(), magnitudes(), rates).prop_map(|(a, b, accel, rate)| {
        let limits = RampLimits {
            start_millihertz: a.min(b),
            max_millihertz: a.max(b),
            accel_steps_per_s2: accel,
        };
        (limits, rate)
    })
}

/// Limits and tick rates of real motors and timers: acceleration times of 1 ms to 10 s.
fn real_ramp() -> impl Strategy<Value = (RampLimits, Rate)> {
    let tick_rates = (100_000..=200_000_000_u32, 1..=64_u32);
    (
        tick_rates,
        10_000..=50_000_000_u32,
        0..=999_u32,
        1..=10_000_u32,
    )
        .prop_filter_map(
            "too fast for the timer",
            |((clock, divider), max, start, ms)| {
                let rate = Rate::new(clock, divider).ok()?;
                // max / 1000 steps/s in `ms` milliseconds.
                let accel = u32::try_from(u64::from(max) / u64::from(ms)).ok()?.max(1);
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

/// Checks the sum and the count, and returns the intervals.
fn intervals(axis: AxisRamp, steps: i32, end: u64) -> Result<Vec<u64>, TestCaseError> {
    let edges = axis.remaining();
    prop_assert_eq!(edges, 2 * u64::from(steps.unsigned_abs()));
    prop_assert_eq!(axis.clone().count() as u64, edges);
    let intervals: Vec<u64> = axis.collect();
    prop_assert!(intervals.iter().all(|&interval| interval > 0));
    prop_assert!(edges == 0 || intervals.iter().sum::<u64>() == end);
    Ok(intervals)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn short_moves_at_any_limits_end_together(
        (limits, rate) in any_ramp(),
        steps in prop::array::uniform3(-300..=300_i32),
    ) {
        if let Ok(ramp) = Ramp::new(steps, &limits, rate) {
            for (axis, n) in ramp.axes().into_iter().zip(steps) {
                intervals(axis, n, ramp.end_ticks())?;
            }
        }
    }

    #[test]
    fn long_moves_at_any_limits_go_forward(
        (limits, rate) in any_ramp(),
        steps in prop::array::uniform2(magnitudes()),
    ) {
        let steps = steps.map(|n| i32::try_from(n >> 1).unwrap());
        if let Ok(ramp) = Ramp::new(steps, &limits, rate) {
            let mut last = 0;
            for edge in ramp.edges().take(300) {
                prop_assert!(edge.ticks >= last && edge.ticks <= ramp.end_ticks());
                last = edge.ticks;
            }
            for axis in ramp.axes() {
                prop_assert!(axis.take(300).all(|interval| interval > 0));
            }
        }
    }
}

proptest! {
    #[test]
    fn speed_rises_to_the_limit_and_falls(
        (limits, rate) in real_ramp(),
        n in 1..=3000_i32,
        m in 0..=3000_i32,
    ) {
        let ramp = Ramp::new([n, -m.min(n)], &limits, rate).unwrap();
        // Half a period at the highest rate, rounded down, in ticks.
        let fastest = 500 * u64::from(rate.numerator())
            / (u64::from(rate.denominator()) * u64::from(limits.max_millihertz));
        for (axis, steps) in ramp.axes().into_iter().zip([n, m.min(n)]) {
            let intervals = intervals(axis, steps, ramp.end_ticks())?;
            // Rounding and subticks: two ticks at most.
            for &interval in &intervals {
                prop_assert!(interval + 2 > fastest);
            }
            let (up, down) = intervals.split_at(intervals.len() / 2);
            for pair in up.windows(2) {
                prop_assert!(pair[1] <= pair[0] + 2, "{pair:?}");
            }
            for pair in down.windows(2) {
                prop_assert!(pair[0] <= pair[1] + 2, "{pair:?}");
            }
            // The way down mirrors the way up.
            for (a, b) in up.iter().zip(down.iter().rev()) {
                prop_assert!(a.abs_diff(*b) <= 2, "{a} and {b}");
            }
        }
    }

    #[test]
    fn followers_keep_the_proportion(
        (limits, rate) in real_ramp(),
        m in 1..=300_i32,
        factor in 1..=9_i32,
    ) {
        // The edges of a follower with m of f m steps are each f-th edge of the leader.
        let ramp = Ramp::new([m * factor, m], &limits, rate).unwrap();
        let [leader, follower] = ramp.axes().map(|axis| {
            axis.scan(0, |ticks, interval| {
                *ticks += interval;
                Some(*ticks)
            })
        });
        let every = leader.skip(usize::try_from(factor - 1).unwrap());
        for (a, b) in every.step_by(usize::try_from(factor).unwrap()).zip(follower) {
            // Twice the rounding of one edge.
            prop_assert!(u64::abs_diff(a, b) <= 3, "{a} and {b}");
        }
    }
}
