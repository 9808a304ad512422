//! What holds for every train, timer and carried remainder.

use proptest::prelude::*;
use stepper_sync::{Edge, Level, Position, Rate, StepCarry, Timer, Trains};

use crate::common::timers::{timers, widths};

/// Small, large and extreme half periods.
fn half_periods() -> impl Strategy<Value = u64> {
    prop_oneof![1..=10_u64, 1..=70_000_u64, 1..=u64::from(u32::MAX)]
}

proptest! {
    #[test]
    fn every_edge_is_at_the_floor_of_its_ideal_and_the_last_at_the_end(
        steps in prop::array::uniform3(-400..=400_i32),
        t in half_periods(),
    ) {
        let trains = Trains::new(steps, t).unwrap();
        let most = steps.iter().map(|n| n.unsigned_abs()).max().unwrap();
        let end = 2 * u64::from(most) * t;
        prop_assert_eq!(trains.end_ticks(), end);
        for (axis, n) in trains.axes().into_iter().zip(steps) {
            let edges = 2 * u64::from(n.unsigned_abs());
            prop_assert_eq!(axis.remaining(), edges);
            let mut ticks = 0;
            for (k, interval) in (1..=edges).zip(axis) {
                prop_assert!(interval > 0);
                ticks += interval;
                let ideal = u128::from(k) * u128::from(end) / u128::from(edges);
                prop_assert_eq!(u128::from(ticks), ideal);
            }
            prop_assert!(edges == 0 || ticks == end);
        }
    }

    #[test]
    fn merged_edges_are_the_sorted_edges_of_the_axes(
        steps in prop::array::uniform4(-60..=60_i32),
        t in half_periods(),
    ) {
        let trains = Trains::new(steps, t).unwrap();
        let mut expected = Vec::new();
        for (index, axis) in trains.axes().into_iter().enumerate() {
            let mut ticks = 0;
            let levels = [Level::High, Level::Low].into_iter().cycle();
            for (interval, level) in axis.zip(levels) {
                ticks += interval;
                expected.push((ticks, index, level));
            }
        }
        // Stable: edges of the same tick stay in axis order.
        expected.sort_by_key(|&(ticks, ..)| ticks);
        let edges = trains.edges();
        prop_assert_eq!(edges.remaining(), expected.len() as u64);
        let merged: Vec<_> = edges
            .map(|Edge { ticks, axis, level, .. }| (ticks, axis, level))
            .collect();
        prop_assert_eq!(merged, expected);
    }

    #[test]
    fn a_chosen_timer_holds_the_interval(
        clock_hz in 1..=u32::MAX,
        millihertz in 1..=u32::MAX,
        width in widths(),
    ) {
        let rate = Rate::from_millihertz(millihertz).unwrap();
        let prescalers = [8, 1, 1024, 64, 256];
        let fits = |clocks| {
            let timer = Timer::up_to_overflow(clock_hz, clocks, width).unwrap();
            timer.half_period(rate).and_then(|exact| timer.reload(exact.nearest()))
        };
        let timer = Timer::up_to_overflow(clock_hz, 1, width).unwrap();
        match timer.with_finest_prescaler(&prescalers, rate) {
            Ok(timer) => {
                prop_assert!(fits(timer.clocks_per_tick()).is_ok());
                for finer in prescalers.into_iter().filter(|&p| p < timer.clocks_per_tick()) {
                    prop_assert!(fits(finer).is_err());
                }
            }
            Err(_) => prop_assert!(prescalers.into_iter().all(|p| fits(p).is_err())),
        }
    }

    #[test]
    fn periods_are_legal_and_sum_exactly(
        (timer, _) in timers(),
        full in 0..200_u64,
        rest: u32,
    ) {
        let max = timer.max_ticks();
        let ticks = full * max + u64::from(rest) % max;
        let timer = timer.with_min_ticks(max / 2).unwrap();
        match timer.periods(ticks) {
            Ok(periods) => {
                prop_assert_eq!(periods.remaining(), ticks.div_ceil(max));
                prop_assert_eq!(periods.clone().count() as u64, periods.remaining());
                prop_assert_eq!(periods.clone().sum::<u64>(), ticks);
                for period in periods {
                    prop_assert!(timer.reload(period).is_ok());
                }
            }
            Err(_) => prop_assert!(ticks < max / 2),
        }
    }

    #[test]
    fn reloads_toggle_at_the_edges_of_the_train(
        steps in prop::array::uniform2(1..=60_i32),
        t in 1..=100_000_u64,
        width in widths(),
    ) {
        let timer = Timer::up_to_overflow(1_000_000, 1, width).unwrap();
        for axis in Trains::new(steps, t).unwrap().axes() {
            let reloads = timer.reloads(axis.clone());
            prop_assert!(reloads.size_hint().0 as u64 >= axis.remaining());
            let mut interval = 0;
            let mut edges = axis;
            for reload in reloads {
                let reload = reload.unwrap();
                prop_assert_eq!(timer.ticks_of_reload(reload.value), Ok(reload.ticks));
                interval += reload.ticks;
                if reload.toggles {
                    prop_assert_eq!(edges.next(), Some(interval));
                    interval = 0;
                }
            }
            prop_assert_eq!((edges.next(), interval), (None, 0));
        }
    }

    #[test]
    fn carried_remainder_rounds_the_sum(
        steps in prop_oneof![-1000..=-1_i32, 1..=1000_i32],
        units in 1..=1_000_000_u32,
        increments in prop::collection::vec(-1_000_000..=1_000_000_i32, 1..50),
    ) {
        let mut carry = StepCarry::new(steps, units).unwrap();
        let (mut sum, mut made) = (0_i64, 0_i64);
        for increment in increments {
            sum += i64::from(increment);
            made += i64::from(carry.advance(increment).unwrap());
            let off = 2 * (made * i64::from(units) - sum * i64::from(steps));
            prop_assert!(off.abs() <= i64::from(units));
        }
    }

    #[test]
    fn any_moves_are_tracked_or_refused_whole(
        moves in prop::collection::vec(prop::array::uniform2(any::<i32>()), 1..20),
    ) {
        let mut position = Position::home();
        let mut sums = [0_i64; 2];
        for steps in moves {
            let next = [0, 1].map(|axis| sums[axis] + i64::from(steps[axis]));
            let legal = next.iter().all(|sum| sum.unsigned_abs() <= 0x7FFF_FFFF);
            prop_assert_eq!(position.apply(steps).is_ok(), legal);
            if legal {
                sums = next;
            }
            prop_assert_eq!(position.steps().map(i64::from), sums);
            prop_assert_eq!(position.homing().map(i64::from), sums.map(|sum| -sum));
        }
    }
}
