//! Every function with anything: 0, the largest and smallest numbers, what overflows, NaN. The
//! answer is right, against the same formula in 128 bits, or an error.

use core::time::Duration;
use proptest::num::f64;
use proptest::prelude::*;
use stepper_sync::{
    Direction, Position, Rate, Rounding, StepCarry, StepScale, Timer, TimerError, TrainError,
    Trains,
};
use test_support::{any_i32, any_u32, any_u64};

use crate::common::timers::timers;

/// The quotient to the nearest, halves up.
fn nearest(numerator: u128, denominator: u128) -> u128 {
    (numerator + denominator / 2) / denominator
}

/// Ticks per second as a ratio.
fn tick_hz(timer: &Timer) -> (u128, u128) {
    let rate = timer.tick_rate();
    (rate.numerator().into(), rate.denominator().into())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn rates(numerator in any_u32(), denominator in any_u32()) {
        let rate = Rate::new(numerator, denominator);
        prop_assert_eq!(rate.is_ok(), numerator > 0 && denominator > 0);
        prop_assert_eq!(Rate::from_hz(numerator).is_ok(), numerator > 0);
        prop_assert_eq!(Rate::from_millihertz(numerator).is_ok(), numerator > 0);
        if let Ok(rate) = rate {
            let (n, d) = (u128::from(numerator), u128::from(denominator));
            prop_assert_eq!(u128::from(rate.to_millihertz()), nearest(n * 1000, d));
            prop_assert_eq!(u128::from(rate.half_period_ns()), nearest(d * 500_000_000, n));
        }
    }

    #[test]
    fn intervals_of_a_timer(
        (timer, _) in timers(),
        (numerator, denominator) in (1..=u32::MAX, 1..=u32::MAX),
        ticks in any_u64(),
        duration in (any_u64(), 0..1_000_000_000_u32),
    ) {
        let (n, d) = tick_hz(&timer);
        let rate = Rate::new(numerator, denominator).unwrap();
        let (n2, d2) = (n * u128::from(denominator), d * u128::from(numerator) * 2);
        match timer.half_period(rate) {
            Ok(exact) => {
                prop_assert_eq!(u128::from(exact.floor()), n2 / d2);
                prop_assert_eq!(u128::from(exact.nearest()), nearest(n2, d2));
                // 10^6 (ticks / exact - 1), in floating point.
                #[expect(clippy::cast_precision_loss, reason = "compared to 12 digits")]
                let (wanted, ppm) = {
                    let ratio = ticks as f64 * d2 as f64 / n2 as f64;
                    (1e6 * (ratio - 1.0), exact.error_ppm(ticks) as f64)
                };
                #[expect(clippy::cast_precision_loss, reason = "the end of the range")]
                let wanted = wanted.min(i64::MAX as f64);
                prop_assert!((ppm - wanted).abs() <= 0.5 + 1e-9 * wanted.abs().max(1e6));
            }
            Err(_) => prop_assert_eq!(nearest(n2, d2), 0),
        }
        let clocks = u128::from(ticks) * d;
        prop_assert_eq!(timer.ticks_to_ns(ticks), nearest(clocks * 1_000_000_000, n));
        match timer.half_period_to_millihertz(ticks) {
            Ok(millihertz) => {
                prop_assert_eq!(u128::from(millihertz), nearest(n * 1000, clocks * 2));
            }
            Err(_) => prop_assert_eq!(ticks, 0),
        }
        let duration = Duration::new(duration.0, duration.1);
        let wanted = nearest(duration.as_nanos() * n, 1_000_000_000 * d);
        prop_assert_eq!(timer.ticks_in(duration).ok(), u64::try_from(wanted).ok());
    }

    #[test]
    fn registers_of_a_timer(
        (timer, to_overflow) in timers(),
        min_ticks in any_u64(),
        ticks in prop_oneof![any_u64(), any_u32().prop_map(u64::from)],
        count in any_u32(),
        stopped in any_u32(),
        prescalers in prop::collection::vec(any_u32(), 0..4),
        millihertz in 1..=u32::MAX,
    ) {
        let max = timer.max_ticks();
        let limited = timer.with_min_ticks(min_ticks);
        prop_assert_eq!(limited.is_ok(), (1..=max / 2).contains(&min_ticks));
        let timer = limited.unwrap_or(timer);
        let legal = (timer.min_ticks()..=max).contains(&ticks);
        let interval = |register: u32| match to_overflow {
            true => max - u64::from(register),
            false => u64::from(register) + 1,
        };
        prop_assert_eq!(timer.reload(ticks).is_ok(), legal);
        if let Ok(register) = timer.reload(ticks) {
            prop_assert!(u64::from(register) <= timer.width().max_value());
            prop_assert_eq!(interval(register), ticks);
            prop_assert_eq!(timer.ticks_of_reload(register), Ok(ticks));
        }
        match timer.ticks_of_reload(count) {
            Ok(ticks) => prop_assert_eq!(timer.reload(ticks), Ok(count)),
            Err(TimerError::IntervalTooShort { ticks, limit }) => {
                prop_assert_eq!((ticks, limit), (interval(count), timer.min_ticks()));
                prop_assert!(ticks < limit);
            }
            Err(_) => prop_assert!(u64::from(count) >= max),
        }
        match timer.compensated_reload(count, ticks, stopped) {
            Ok(register) => {
                let since_wrap = if to_overflow { count.into() } else { max - 1 - u64::from(count) };
                prop_assert_eq!(since_wrap + u64::from(stopped) + interval(register), ticks);
            }
            Err(TimerError::TooLate { elapsed, ticks }) => prop_assert!(elapsed >= ticks),
            Err(TimerError::StartsAgain) => prop_assert!(!to_overflow),
            Err(_) => prop_assert!(!legal || u64::from(count) >= max),
        }
        match timer.periods(ticks) {
            Ok(periods) => {
                prop_assert_eq!(periods.remaining(), ticks.div_ceil(max));
                prop_assert!(periods.take(3).all(|period| timer.reload(period).is_ok()));
            }
            Err(_) => prop_assert!(ticks < timer.min_ticks()),
        }
        let rate = Rate::from_millihertz(millihertz).unwrap();
        if let Ok(fitting) = timer.with_finest_prescaler(&prescalers, rate) {
            let half_period = fitting.half_period(rate).unwrap().nearest();
            prop_assert!(fitting.reload(half_period).is_ok());
        }
    }

    #[test]
    fn trains(steps in [any_i32(), any_i32()], half_period in any_u64()) {
        let most = steps.map(i32::unsigned_abs).into_iter().max().unwrap();
        let half = u128::from(most) * u128::from(half_period);
        let trains = match Trains::new(steps, half_period) {
            Ok(trains) => trains,
            Err(TrainError::ZeroHalfPeriod) => { prop_assert_eq!(half_period, 0); return Ok(()); },
            Err(TrainError::TooLong { .. }) => { prop_assert!(2 * half >= 1 << 64); return Ok(()); },
            Err(_) => { prop_assert!(steps.contains(&i32::MIN)); return Ok(()); },
        };
        prop_assert_eq!(u128::from(trains.end_ticks()), 2 * half);
        let reloads = [Rounding::Nearest, Rounding::Down].map(|rounding| trains.single_reload(rounding));
        for (axis, train) in trains.axes().into_iter().enumerate() {
            let pulses = u128::from(steps[axis].unsigned_abs());
            prop_assert_eq!(u128::from(train.remaining()), 2 * pulses);
            let mut ticks = 0;
            for (k, interval) in (1..=200).zip(train.clone()) {
                prop_assert!((train.shortest_ticks()..=train.longest_ticks()).contains(&interval));
                ticks += u128::from(interval);
                prop_assert_eq!(ticks, k * half / pulses);
            }
            if pulses > 0 {
                let exact = [nearest(half, pulses), half / pulses];
                for (reload, interval) in reloads.map(|both| both[axis]).into_iter().zip(exact) {
                    prop_assert_eq!(u128::from(reload.interval_ticks()), interval);
                    prop_assert_eq!(reload.end_ticks(), 2 * pulses * interval);
                    let skew = reload.end_ticks().cast_signed() - (2 * half).cast_signed();
                    prop_assert_eq!(reload.skew_ticks(), skew);
                }
            }
        }
        let edges = trains.edges();
        prop_assert_eq!(edges.remaining(), steps.map(|n| 2 * u64::from(n.unsigned_abs())).iter().sum::<u64>());
        prop_assert!(edges.take(20).is_sorted_by_key(|edge| (edge.ticks, edge.axis)));
    }

    #[test]
    fn scales(steps_per_unit in f64::ANY, position in f64::ANY, steps in any_i32(), units in any_u32(), increment in any_i32()) {
        let scale = StepScale::new(steps_per_unit);
        let in_range = (1e-150..=1e150).contains(&steps_per_unit.abs());
        prop_assert_eq!(scale.is_ok(), in_range);
        if let Ok(scale) = scale {
            let exact = position * steps_per_unit;
            match scale.to_steps(position) {
                Ok(whole) => prop_assert!((exact - f64::from(whole)).abs() <= 0.5),
                Err(_) => prop_assert!(!exact.is_finite() || exact.abs() >= 2_147_483_647.5),
            }
            let back = scale.to_steps(scale.to_position(steps));
            prop_assert_eq!(back.ok(), Some(steps).filter(|steps| *steps != i32::MIN));
        }
        let carry = StepCarry::new(steps, units);
        prop_assert_eq!(carry.is_ok(), steps != 0 && units > 0);
        if let Ok(mut carry) = carry {
            let doubled = i64::from(increment) * i64::from(steps) * 2 + i64::from(units);
            let due = doubled.div_euclid(2 * i64::from(units));
            let wanted = i32::try_from(due).ok().filter(|due| *due != i32::MIN);
            prop_assert_eq!(carry.advance(increment).ok(), wanted);
        }
    }

    #[test]
    fn positions(
        start in any_i32(), min in any_i32(), max in any_i32(),
        steps in any_i32(), target in any_i32(), axis in 0..3_usize,
    ) {
        let mut position = Position::<2>::home();
        prop_assert_eq!(position.apply([0, start]).is_ok(), start != i32::MIN);
        let at = i64::from(position.steps()[1]);
        let limited = position.with_limits(axis, min, max);
        let of_axis = if axis == 1 { at } else { 0 };
        let holds = min != i32::MIN && i64::from(min) <= of_axis && of_axis <= i64::from(max);
        prop_assert_eq!(limited.is_ok(), holds && axis < 2);
        let (mut position, range) = match limited {
            Ok(limited) if axis == 1 => (limited, i64::from(min)..=i64::from(max)),
            _ => (position, -i64::from(i32::MAX)..=i64::from(i32::MAX)),
        };
        let mut stepped = position;
        prop_assert_eq!(stepped.step(1, Direction::Negative).is_ok(), range.contains(&(at - 1)));
        prop_assert!(stepped.step(2, Direction::Negative).is_err());
        let mut applied = position;
        prop_assert_eq!(applied.apply([0, steps]).is_ok(), range.contains(&(at + i64::from(steps))));
        let travel = i64::from(target) - at;
        let reached = range.contains(&i64::from(target)) && travel.unsigned_abs() <= 0x7FFF_FFFF;
        prop_assert_eq!(position.move_to([0, target]).map(|moves| i64::from(moves[1])).ok(), reached.then_some(travel));
        prop_assert_eq!(i64::from(position.homing()[1]), if reached { -i64::from(target) } else { -at });
    }
}
