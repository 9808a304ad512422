//! Steps along hand-worked cubics, what is refused, and pictures.
#![cfg(test)]

use proptest::prelude::*;
use stepper_sync::{
    AxisSegments, Direction, JoinedSegments, MinIntervals, PvtKnot, PvtRow, PvtSteps, Rate,
    RowError, SegmentPlayer, StepDirTiming,
};

/// One step in 2^-32 steps, and one step a tick in 2^-56.
const STEP: i64 = 1 << 32;
const STEP_A_TICK: i64 = 1 << 56;

const LEAST: MinIntervals = MinIntervals {
    step_ticks: 10,
    reversal_ticks: 30,
};

const fn knot(position: i64, velocity: i64) -> PvtKnot {
    PvtKnot { position, velocity }
}

/// Ticks since the start and directions, as +1 and -1, of the steps of one axis.
fn steps(start: PvtKnot, rows: &[(u32, PvtKnot)]) -> Vec<(u64, i64)> {
    let mut axis = AxisSegments::new(start, LEAST);
    let mut player = SegmentPlayer::new();
    let mut made = Vec::new();
    let mut ticks = 0;
    for &(row, knot) in rows {
        axis.push(row, knot).unwrap();
        for segment in axis.by_ref() {
            let sign = match segment.direction() {
                Direction::Positive => 1,
                Direction::Negative => -1,
            };
            ticks += player.load(&segment);
            made.push((ticks, sign));
            for interval in player.by_ref() {
                ticks += u64::from(interval);
                made.push((ticks, sign));
            }
        }
    }
    assert_eq!(
        axis.steps(),
        i64::from(start.position >= STEP / 2) + made.iter().map(|step| step.1).sum::<i64>()
    );
    made
}

/// The same without directions, all forwards.
fn forwards(start: PvtKnot, rows: &[(u32, PvtKnot)]) -> Vec<u64> {
    let made = steps(start, rows);
    assert!(made.iter().all(|step| step.1 == 1));
    made.into_iter().map(|step| step.0).collect()
}

#[test]
fn constant_speed_steps_at_half_steps() {
    // A step in 100 ticks: half steps at 50, 150, ...
    let v = STEP_A_TICK / 100;
    let made = forwards(knot(0, v), &[(1000, knot(10 * STEP, v))]);
    assert_eq!(made, [50, 150, 250, 350, 450, 550, 650, 750, 850, 950]);
    // Cut anywhere, the same.
    let rows = [(333, knot(333 * STEP / 100, v)), (667, knot(10 * STEP, v))];
    assert_eq!(forwards(knot(0, v), &rows), made);
}

#[test]
fn constant_acceleration_steps_at_square_roots() {
    // q = 8 s², s = t / 1000: k + 1/2 at 1000 sqrt((2 k + 1) / 16).
    let v = STEP_A_TICK / 1000 * 16;
    let made = forwards(knot(0, 0), &[(1000, knot(8 * STEP, v))]);
    // 250.0, 433.01, 559.02, 661.44, 750.0, 829.16, 901.39, 968.25
    assert_eq!(made, [250, 433, 559, 661, 750, 829, 901, 968]);
}

#[test]
fn a_whole_cubic_steps_at_its_roots() {
    // q = 4 (3 s² - 2 s³), s = t / 10,000: 1/2, 3/2, 5/2, 7/2 at 2202.5, 3881.5, ...
    let made = forwards(knot(0, 0), &[(10_000, knot(4 * STEP, 0))]);
    // In 10^-12 steps.
    let cubic = |t: u64| 4 * t * t * (30_000 - 2 * t);
    for (t, half_steps) in made.iter().zip([1, 3, 5, 7]) {
        let place = half_steps * 10_u64.pow(12) / 2;
        assert!(cubic(t - 1) < place && cubic(t + 1) > place, "{t}");
    }
    assert_eq!(made.len(), 4);
    assert_eq!(made[0] + made[3], 10_000);
}

#[test]
fn turning_round_steps_back_at_the_same_place() {
    // q = 4 s - 4 s² up to 1 at s = 1/2 and back: 1/2 at s = (1 ± sqrt(1/2)) / 2.
    let v = STEP_A_TICK / 1000 * 4;
    let made = steps(knot(0, v), &[(1000, knot(0, -v))]);
    // 146.4, 853.6
    assert_eq!(made, [(146, 1), (854, -1)]);
}

#[test]
fn two_turns_in_a_row() {
    // q = 6 (s - 1/4 - ...): 0 to 0 with v = 12 at both ends, up, down through 0, up again.
    let v = STEP_A_TICK / 10_000 * 12;
    let made = steps(knot(0, v), &[(10_000, knot(0, v))]);
    // q = 12 s - 36 s² + 24 s³: 1.155 at s = 0.2113, 0 at 1/2, -1.155 at 0.7887.
    let signs: Vec<_> = made.iter().map(|step| step.1).collect();
    assert_eq!(signs, [1, -1, -1, 1]);
    for (a, b) in made.iter().zip(made.iter().rev()) {
        assert_eq!(a.0 + b.0, 10_000);
    }
}

#[test]
fn a_touch_makes_no_step() {
    // Rest at 1/2 exactly, and back: |q - 0| <= 1/2 all the time.
    let rows = [(1000, knot(STEP / 2, 0)), (1000, knot(0, 0))];
    assert_eq!(steps(knot(0, 0), &rows), []);
    // Rest at 1/2, and on: the step comes when it leaves.
    let rows = [(1000, knot(STEP / 2, 0)), (1000, knot(STEP, 0))];
    assert_eq!(steps(knot(0, 0), &rows), [(1000, 1)]);
    // Within a row: q = 2 s - 2 s² touches 1/2 at s = 1/2; 1/500 of a step more passes it by
    // less than 2^-8 steps, 1/100 more by more.
    for (millionths, count) in [(0, 0), (4_000, 0), (20_000, 2)] {
        let v = STEP_A_TICK / 1_000_000 * 2 * (1_000_000 + millionths) / 1_000_000;
        let made = steps(knot(0, v), &[(1_000_000, knot(0, -v))]);
        assert_eq!(made.len(), count, "{millionths}");
    }
}

#[test]
fn an_axis_at_rest_makes_no_step() {
    for position in [0, 7, STEP / 2, -STEP / 2, i64::MAX, i64::MIN] {
        let mut axis = AxisSegments::new(knot(position, 0), LEAST);
        axis.push(u32::MAX, knot(position, 0)).unwrap();
        assert_eq!(axis.next(), None);
    }
}

#[test]
fn the_nearest_step_is_where_counting_begins() {
    let count = |position| AxisSegments::new(knot(position, 0), LEAST).steps();
    assert_eq!(count(0), 0);
    assert_eq!(count(STEP / 2 - 1), 0);
    assert_eq!(count(STEP / 2), 1);
    assert_eq!(count(-STEP / 2), 0);
    assert_eq!(count(-STEP / 2 - 1), -1);
    assert_eq!(count(i64::MAX), 1 << 31);
    assert_eq!(count(i64::MIN), -(1 << 31));
}

#[test]
fn long_and_fast_rows() {
    // A step in 12 ticks, the fastest that is allowed, for 2^32 - 1 ticks.
    let ticks = u32::MAX;
    let v = STEP_A_TICK / 12;
    let way = i64::try_from((i128::from(v) * i128::from(ticks)) >> 24).unwrap();
    let mut axis = AxisSegments::new(knot(-way, v), LEAST);
    axis.push(ticks, knot(0, v)).unwrap();
    let segments: Vec<_> = axis.by_ref().take(1000).collect();
    let count: u64 = segments
        .iter()
        .map(|segment| u64::from(segment.count()))
        .sum();
    // A thousand segments at 12 ticks a step are nearly full.
    assert!(count > 900_000, "{count}");
    for segment in segments.iter().skip(20) {
        assert!(
            segment
                .intervals()
                .all(|interval| (11..=13).contains(&interval))
        );
    }
}

#[test]
fn a_jump_changes_the_velocity_at_once() {
    let v = STEP_A_TICK / 100;
    let rows = [
        (150, knot(STEP * 3 / 2, v)),
        (0, knot(STEP * 3 / 2, v / 2)),
        (300, knot(STEP * 3, v / 2)),
    ];
    // 1/2 at 50; 3/2 is passed at 150, 5/2 two hundred ticks later.
    assert_eq!(forwards(knot(0, v), &rows), [50, 150, 350]);
}

#[test]
fn a_step_back_waits_for_the_driver() {
    // Up to 1/2 + 1/400 at a step in 100 ticks, and back at once: passed for half a tick.
    let v = STEP_A_TICK / 100;
    let top = knot(STEP / 2 + STEP / 400, v);
    let back = knot(top.position, -v);
    let rows = [(50, top), (0, back), (50, knot(STEP / 400, -v))];
    // 30 ticks later the axis would be 0.3 steps past its place.
    let mut axis = AxisSegments::new(knot(0, v), LEAST);
    axis.push(50, top).unwrap();
    assert_eq!(axis.by_ref().count(), 1);
    axis.push(0, back).unwrap();
    let before = axis.clone();
    let error = RowError::ReversalTooQuick {
        row: 2,
        axis: 0,
        ticks: 80,
        least_ticks: 30,
    };
    assert_eq!(axis.push(50, rows[2].1), Err(error));
    assert_eq!(axis, before);
    assert_eq!(
        error.to_string(),
        "row 2, axis 0, tick 80: steps back in fewer than 30 ticks"
    );
    // A hundredth as fast it is past by 0.003 steps: the step waits.
    let v = v / 100;
    let made = steps(
        knot(0, v),
        &[
            (5000, knot(STEP / 2 + 1000, v)),
            (0, knot(STEP / 2 + 1000, -v)),
            (5000, knot(1000, -v)),
        ],
    );
    assert_eq!(made, [(5000, 1), (5030, -1)]);
}

#[test]
fn what_is_too_fast_is_refused_with_its_place() {
    let mut axis = AxisSegments::new(knot(0, 0), LEAST);
    let too_fast = |ticks, interval_ticks| RowError::TooFast {
        row: 0,
        axis: 0,
        ticks,
        interval_ticks,
        least_ticks: 12,
    };
    // At the end; in the middle: 150 steps in 1000 ticks from rest to rest peak at 0.225 a tick.
    let fast = knot(STEP, STEP_A_TICK / 11);
    assert_eq!(axis.push(1000, fast), Err(too_fast(1000, 11)));
    assert_eq!(axis.push(1000, knot(150 * STEP, 0)), Err(too_fast(500, 4)));
    assert_eq!(
        axis.push(0, knot(0, -STEP_A_TICK / 11)),
        Err(too_fast(0, 11))
    );
    assert_eq!(axis.push(1, knot(i64::MAX, 0)), Err(too_fast(1, 0)));
    assert_eq!(
        too_fast(500, 4).to_string(),
        "row 0, axis 0, tick 500: a step every 4 ticks, fewer than 12"
    );
    // What begins too fast.
    let mut axis = AxisSegments::new(knot(0, STEP_A_TICK / 11), LEAST);
    assert_eq!(axis.push(1000, knot(STEP, 0)), Err(too_fast(0, 11)));
    // Exactly the limit is none.
    let v = STEP_A_TICK / 12;
    let mut axis = AxisSegments::new(knot(0, v), LEAST);
    assert_eq!(axis.push(1200, knot(100 * STEP, v)), Ok(()));
}

#[test]
fn other_refusals_name_row_and_axis() {
    let v = STEP_A_TICK / 100;
    let mut steps = PvtSteps::new([knot(0, 0), knot(0, v)], LEAST);
    let row = |ticks, second| PvtRow {
        ticks,
        knots: [knot(0, 0), second],
    };
    let error = steps.push(&row(0, knot(1, v))).unwrap_err();
    assert_eq!(error, RowError::NoTime { row: 0, axis: 1 });
    assert_eq!(error.to_string(), "row 0, axis 1: moves in 0 ticks");
    steps.push(&row(1000, knot(10 * STEP, v))).unwrap();
    let error = steps.push(&row(1000, knot(20 * STEP, v))).unwrap_err();
    assert_eq!(error, RowError::Busy { row: 1, axis: 1 });
    assert_eq!(
        error.to_string(),
        "row 1, axis 1: steps of the row before are still to be taken"
    );
    assert_eq!(steps.by_ref().count(), 10);
    assert_eq!(steps.push(&row(1000, knot(20 * STEP, v))), Ok(()));
    // A turn within the row that no driver could follow: 40 ticks up and down by 1.4 steps.
    let mut axis = AxisSegments::new(knot(0, STEP_A_TICK / 12), LEAST);
    assert_eq!(
        axis.push(40, knot(0, -STEP_A_TICK / 12)),
        Err(RowError::ReversalTooQuick {
            row: 0,
            axis: 0,
            ticks: 20,
            least_ticks: 30
        })
    );
}

#[test]
fn data_sheets_in_ticks() {
    let rate = Rate::from_hz(72_000_000).unwrap();
    // 1.9 us are 136.8 ticks, 650 ns 46.8.
    assert_eq!(
        StepDirTiming::DRV8825.min_intervals(rate),
        MinIntervals {
            step_ticks: 274,
            reversal_ticks: 274
        }
    );
    let slow_turn = StepDirTiming {
        setup_ns: 5000,
        hold_ns: 5000,
        ..StepDirTiming::DRV8825
    };
    assert_eq!(slow_turn.min_intervals(rate).reversal_ticks, 720);
    let slowest = StepDirTiming {
        pulse_ns: u32::MAX,
        pause_ns: u32::MAX,
        setup_ns: 0,
        hold_ns: 0,
    };
    let fastest = Rate::from_hz(u32::MAX).unwrap();
    // 4.294967295 s, twice.
    assert_eq!(slowest.min_intervals(fastest).step_ticks, 36_893_488_132);
}

/// Pulses of two columns and the level of the direction pin of each axis, a column in ten ticks.
fn picture<const N: usize>(
    start: [PvtKnot; N],
    rows: &[PvtRow<N>],
    names: [&str; N],
) -> Vec<String> {
    let ticks: u32 = rows.iter().map(|row| row.ticks).sum();
    let columns = usize::try_from(ticks / 10 + 1).unwrap();
    let mut pulses = names.map(|_| vec!['_'; columns + 2]);
    let mut directions = names.map(|_| vec![' '; columns]);
    let mut steps = PvtSteps::new(start, LEAST);
    let mut last = 0;
    for row in rows {
        steps.push(row).unwrap();
        for step in steps.by_ref() {
            assert!(step.ticks >= last, "steps in time order");
            last = step.ticks;
            let column = usize::try_from(step.ticks / 10).unwrap();
            pulses[step.axis][column..column + 3].copy_from_slice(&['|', '-', '|']);
            let level = if step.direction == Direction::Positive {
                '-'
            } else {
                '_'
            };
            directions[step.axis][column..].fill(level);
        }
    }
    let mut lines = Vec::new();
    for ((name, pulses), directions) in names.iter().zip(&pulses).zip(&directions) {
        lines.push(format!(
            "{name} {}",
            pulses[..columns].iter().collect::<String>()
        ));
        lines.push(format!("> {}", directions.iter().collect::<String>()));
    }
    lines
}

#[test]
fn pictures_of_pulses() {
    let v = STEP_A_TICK / 100;
    // x goes on at a step in 100 ticks; y comes from rest, goes a step, and back.
    let rows = [
        PvtRow {
            ticks: 200,
            knots: [knot(2 * STEP, v), knot(STEP, 0)],
        },
        PvtRow {
            ticks: 200,
            knots: [knot(4 * STEP, v), knot(0, 0)],
        },
    ];
    assert_eq!(
        picture([knot(0, v), knot(0, 0)], &rows, ["x", "y"]),
        [
            "x _____|-|_______|-|_______|-|_______|-|___",
            ">      ------------------------------------",
            "y __________|-|_________________|-|________",
            ">           --------------------___________",
        ]
    );
}

/// Rows of three axes, some too fast or too quick for some of them.
fn any_rows() -> impl Strategy<Value = Vec<PvtRow<3>>> {
    let knots = prop::array::uniform3((-40..40_i64, -5_i64..5));
    prop::collection::vec((0..5000_u32, knots), 1..20).prop_map(|rows| {
        let row = |(ticks, knots): (u32, [(i64, i64); 3])| PvtRow {
            ticks,
            knots: knots.map(|(position, velocity)| {
                knot(position * STEP / 2, velocity * (STEP_A_TICK / 50))
            }),
        };
        rows.into_iter().map(row).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// The steps of all axes are those of each by itself, in time order; a row is taken by all
    /// axes or by none.
    #[test]
    fn axes_are_merged_in_time_order(rows in any_rows()) {
        let start = [knot(0, 0), knot(STEP / 2, 0), knot(-3 * STEP, 0)];
        let mut merged = PvtSteps::new(start, LEAST);
        let mut axes = start.map(|knot| AxisSegments::new(knot, LEAST));
        let mut last_ticks = [0; 3];
        for row in rows {
            let before = axes.clone();
            let alone: Vec<_> = axes
                .iter_mut()
                .zip(row.knots)
                .map(|(axis, knot)| axis.push(row.ticks, knot))
                .collect();
            let first_refusal = alone.iter().position(Result::is_err);
            let taken = merged.push(&row);
            prop_assert_eq!(taken.is_err(), first_refusal.is_some());
            if let Some(axis) = first_refusal {
                let named = match taken.unwrap_err() {
                    RowError::NoTime { axis, .. }
                    | RowError::TooFast { axis, .. }
                    | RowError::ReversalTooQuick { axis, .. } => axis,
                    other => panic!("{other}"),
                };
                prop_assert_eq!(named, axis);
                prop_assert!(merged.next().is_none());
                axes = before;
                continue;
            }
            let mut wanted = Vec::new();
            for (index, (axis, last)) in axes.iter_mut().zip(&mut last_ticks).enumerate() {
                for segment in axis.by_ref() {
                    let mut player = SegmentPlayer::new();
                    *last += player.load(&segment);
                    wanted.push((*last, index, segment.direction()));
                    for interval in player {
                        *last += u64::from(interval);
                        wanted.push((*last, index, segment.direction()));
                    }
                }
            }
            wanted.sort_by_key(|&(ticks, axis, _)| (ticks, axis));
            let made: Vec<_> = merged
                .by_ref()
                .map(|step| (step.ticks, step.axis, step.direction))
                .collect();
            prop_assert_eq!(made, wanted);
            prop_assert_eq!(merged.steps(), axes.each_ref().map(AxisSegments::steps));
            prop_assert_eq!(merged.end_ticks(), axes[0].end_ticks());
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[test]
fn memory_is_what_the_readme_says() {
    assert_eq!(size_of::<SegmentPlayer>(), 40);
    assert_eq!(size_of::<AxisSegments>(), 280);
    assert_eq!(size_of::<PvtSteps<2>>(), 680);
    assert_eq!(size_of::<JoinedSegments>(), 8560);
}
