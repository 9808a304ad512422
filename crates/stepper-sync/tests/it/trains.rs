//! Pulse trains against the published numbers and the reference table.
use stepper_sync::{
    AxisTrain, CounterWidth, Direction, Edge, Edges, Level, Rounding, Timer, TrainError, Trains,
};

/// Half period of [Engraver 2000], in machine cycles.
const T: u64 = 4096;

fn mcs51() -> Timer {
    Timer::mcs51_mode1(11_059_200).unwrap()
}

/// Difference of the ends of two single-reload trains over all pairs of 1..=30 pulses, at worst.
fn worst_skew(rounding: Rounding) -> u128 {
    let pairs = (1..=30).flat_map(|n1| (1..=30).map(move |n2| [n1, n2]));
    pairs
        .map(|pair| {
            let [a, b] = Trains::new(pair, T).unwrap().single_reload(rounding);
            a.skew_ticks().abs_diff(b.skew_ticks())
        })
        .max()
        .unwrap()
}

#[test]
fn worst_skew_of_the_rounded_reload_is_24() {
    assert_eq!(worst_skew(Rounding::Nearest), 24);
}

#[test]
fn worst_skew_of_the_truncated_reload_is_42() {
    assert_eq!(worst_skew(Rounding::Down), 42);
}

#[test]
fn skew_of_65535_to_32768_is_8192() {
    let trains = Trains::new([65_535, 32_768], T).unwrap();
    let [leader, follower] = trains.single_reload(Rounding::Nearest);
    assert_eq!(leader.skew_ticks(), 0);
    assert_eq!(follower.skew_ticks().unsigned_abs(), 8192);
    let [_, follower] = trains.axes();
    assert_eq!(follower.sum::<u64>(), trains.end_ticks());
}

#[test]
fn worst_skew_of_distributed_trains_is_0() {
    for n1 in 1..=30 {
        for n2 in 1..=30 {
            let trains = Trains::new([n1, n2], T).unwrap();
            let ends = trains.axes().map(|axis| axis.sum::<u64>());
            assert_eq!(ends, [trains.end_ticks(); 2]);
        }
    }
}

#[test]
fn the_14_ratios_17_to_30_overflow_16_bits() {
    let timer = mcs51();
    let overflowing: Vec<i32> = (1..=30)
        .filter(|&n| {
            let [_, slow] = Trains::new([n, 1], T).unwrap().axes();
            timer.reload(slow.longest_ticks()).is_err()
        })
        .collect();
    assert_eq!(overflowing, (17..=30).collect::<Vec<_>>());
    for n in overflowing {
        let [_, slow] = Trains::new([n, 1], T).unwrap().axes();
        for interval in slow {
            let periods = timer.periods(interval).unwrap();
            assert_eq!(periods.remaining(), 2);
            assert_eq!(periods.sum::<u64>(), interval);
        }
    }
}

#[test]
fn thirty_to_one_in_16_bits_loads_57344_and_ends_at_47_percent() {
    let trains = Trains::new([30, 1], T).unwrap();
    let [_, slow] = trains.single_reload(Rounding::Nearest);
    assert_eq!(slow.interval_ticks(), 122_880);
    let kept = slow.kept_by(CounterWidth::Bits16);
    assert_eq!(kept.interval_ticks(), 57_344);
    let per_mille = kept.end_ticks() * 1000 / u128::from(trains.end_ticks());
    assert_eq!(per_mille, 466);
    assert_eq!(kept.skew_ticks(), 2 * (57_344 - 122_880));
}

#[test]
fn sixteen_to_one_in_16_bits_loads_0_which_is_65536() {
    let [_, slow] = Trains::new([16, 1], T)
        .unwrap()
        .single_reload(Rounding::Down);
    assert_eq!(slow.kept_by(CounterWidth::Bits16), slow);
    assert_eq!(mcs51().reload(slow.interval_ticks()), Ok(0));
}

#[test]
fn latency_of_16_cycles_under_the_plain_reload_parts_the_ends() {
    // Each reload comes 16 cycles late [Engraver 2000, in C]; 30 and 20 pulses.
    let late_end = |axis: AxisTrain| axis.map(|interval| interval + 16).sum::<u64>();
    let [a, b] = Trains::new([30, 20], T).unwrap().axes().map(late_end);
    assert_eq!(a - b, 2 * 16 * (30 - 20));
}

#[cfg(target_arch = "x86_64")]
#[test]
fn memory_is_what_the_readme_says() {
    assert_eq!(size_of::<AxisTrain>(), 24);
    assert_eq!(size_of::<Edges<AxisTrain, 2>>(), 80);
}

#[test]
fn edges_come_in_time_order_and_ties_in_axis_order() {
    let edges: Vec<(u64, usize, Level)> = Trains::new([2, 0, -1], 10)
        .unwrap()
        .edges()
        .map(
            |Edge {
                 ticks, axis, level, ..
             }| (ticks, axis, level),
        )
        .collect();
    assert_eq!(
        edges,
        [
            (10, 0, Level::High),
            (20, 0, Level::Low),
            (20, 2, Level::High),
            (30, 0, Level::High),
            (40, 0, Level::Low),
            (40, 2, Level::Low),
        ]
    );
}

#[test]
fn size_hint_counts_down_and_the_end_is_final() {
    let mut edges = Trains::new([3, 2], 7).unwrap().edges();
    for left in (1..=10).rev() {
        assert_eq!(edges.size_hint(), (left, Some(left)));
        assert_eq!(edges.remaining(), left as u64);
        assert!(edges.next().is_some());
    }
    assert_eq!(edges.size_hint(), (0, Some(0)));
    assert!(edges.next().is_none() && edges.next().is_none());
}

#[test]
fn zero_counts_do_not_start() {
    let none = Trains::new([0, 0], T).unwrap();
    assert_eq!((none.end_ticks(), none.edges().count()), (0, 0));
    assert!(Trains::new([], T).unwrap().edges().next().is_none());
    let one = Trains::new([0, 5], T).unwrap();
    assert!(one.edges().all(|edge| edge.axis == 1));
    assert_eq!(one.directions(), [None, Some(Direction::Positive)]);
    assert_eq!(one.steps(), [0, 5]);
}

#[test]
fn extreme_counts_stay_in_64_bits() {
    let (steps, half_period) = ([i32::MAX, -i32::MAX, 1], u64::from(u32::MAX));
    let trains = Trains::new(steps, half_period).unwrap();
    let end = 2 * u64::from(i32::MAX.unsigned_abs()) * half_period;
    assert_eq!(trains.end_ticks(), end);
    let [_, _, slow] = trains.axes();
    assert_eq!(slow.sum::<u64>(), end);
    assert_eq!(trains.edges().remaining(), 4 * 0x7FFF_FFFF + 2);
}

#[test]
fn errors_name_axis_and_value() {
    assert_eq!(Trains::new([1], 0), Err(TrainError::ZeroHalfPeriod));
    // 2^63 - 1 ticks are the longest half period of one pulse.
    let longest = u64::MAX / 2;
    assert_eq!(
        Trains::new([1], longest).map(|t| t.end_ticks()),
        Ok(u64::MAX - 1)
    );
    assert_eq!(
        Trains::new([1], longest + 1).unwrap_err().to_string(),
        "1 pulses with a half period of 9223372036854775808 ticks last 2^64 ticks or more"
    );
    let error = Trains::new([1, i32::MIN], T).unwrap_err();
    assert_eq!(
        error,
        TrainError::TooManySteps {
            axis: 1,
            steps: i32::MIN,
            limit: i32::MAX
        }
    );
    assert_eq!(
        error.to_string(),
        "axis 1: -2147483648 steps, more than 2147483647 either way"
    );
}

/// Each row of the reference table.
#[test]
fn dual_timer_table() {
    let table = include_str!("../data/dual_timer.csv");
    let mut rows = 0;
    for line in table.lines().skip(1) {
        check_row(line);
        rows += 1;
    }
    assert_eq!(rows, 349);
}

fn check_row(line: &str) {
    let cells: Vec<&str> = line.split(',').collect();
    let number = |column: usize| cells[column].parse::<i64>().unwrap();
    let count = |column: usize| cells[column].parse::<u64>().unwrap();
    let steps = [number(0), number(1)].map(|n| i32::try_from(n).unwrap());
    let trains = Trains::new(steps, cells[2].parse().unwrap()).unwrap();
    assert_eq!(trains.end_ticks(), count(3), "D: {line}");

    let slow = match cells[4] {
        "1" | "0" => 1,
        "2" => 0,
        _ => return assert!(trains.edges().next().is_none(), "{line}"),
    };
    let axis = trains.axes()[slow].clone();
    let (num, den, floor) = (count(5), count(6), count(7));
    assert_eq!(axis.shortest_ticks(), floor, "floor: {line}");
    assert_eq!(axis.longest_ticks(), num.div_ceil(den), "ceil: {line}");
    assert_eq!(
        u64::from(axis.long_intervals()),
        count(11),
        "n_long: {line}"
    );

    let down = trains.single_reload(Rounding::Down)[slow];
    let nearest = trains.single_reload(Rounding::Nearest)[slow];
    assert_eq!(down.interval_ticks(), floor, "floor: {line}");
    assert_eq!(nearest.interval_ticks(), count(8), "round: {line}");
    assert_eq!(
        down.skew_ticks(),
        i128::from(number(12)),
        "skew_floor: {line}"
    );
    assert_eq!(
        nearest.skew_ticks(),
        i128::from(number(13)),
        "skew_round: {line}"
    );

    let timer = mcs51();
    let reload = timer.reload(nearest.interval_ticks());
    match cells[9] {
        "-" => assert!(reload.is_err(), "{line}"),
        "OVERFLOW" => assert!(reload.is_err(), "{line}"),
        hex => {
            let expected = u32::from_str_radix(hex.trim_start_matches("0x"), 16).unwrap();
            assert_eq!(reload, Ok(expected), "{line}");
        }
    }
    if axis.remaining() > 0 {
        let periods = timer.periods(axis.longest_ticks()).unwrap();
        assert_eq!(periods.remaining(), count(10), "chunks: {line}");
    }

    // Every edge at its place, for both axes.
    for (axis, n) in trains.axes().into_iter().zip(steps) {
        let edges = u128::from(n.unsigned_abs()) * 2;
        let mut ticks = 0;
        let mut longs = 0;
        for (k, interval) in (1..).zip(axis.clone()) {
            ticks += interval;
            longs += u32::from(interval > axis.shortest_ticks());
            let ideal = k * u128::from(trains.end_ticks()) / edges;
            assert_eq!(u128::from(ticks), ideal, "edge {k}: {line}");
        }
        assert_eq!(longs, axis.long_intervals(), "{line}");
    }
}
