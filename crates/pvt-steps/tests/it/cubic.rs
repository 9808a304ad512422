//! Steps along hand-worked cubics, and pictures.

use proptest::prelude::*;
use pvt_steps::{
    AxisSegments, Direction, JoinedSegments, PvtKnot, PvtRow, PvtSteps, RowError, SegmentPlayer,
};

use crate::common::rows::{LEAST, STEP, STEP_A_TICK, knot, steps};

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
    let travel = i64::try_from((i128::from(v) * i128::from(ticks)) >> 24).unwrap();
    let mut axis = AxisSegments::new(knot(-travel, v), LEAST);
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

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "numbers of a few digits"
)]
/// Where a turn within 2^-8 steps of a place spares two steps, an axis may rest that much further
/// than half a step from its count, and no further; the next row makes the step.
#[test]
fn at_rest_the_count_is_within_half_a_step_and_the_touch() {
    // q(s) = q0 + c (s³/3 - 0.9 s² + 0.8 s): back from its turn at s = 0.8 by c / 750 at s = 1.
    let row = |c: f64, end: f64| {
        let ticks = 100_000_u32;
        let at = |steps: f64| (steps * (STEP as f64)).round() as i64;
        let speed = 0.8 * c / f64::from(ticks) * (STEP_A_TICK as f64);
        let start = end - c * (1.0 / 3.0 - 0.1);
        let mut axis = AxisSegments::new(knot(at(start), speed as i64), LEAST);
        axis.push(ticks, knot(at(end), 0)).unwrap();
        let steps: i64 = axis
            .by_ref()
            .map(|segment| i64::from(segment.count()))
            .sum();
        (axis, steps)
    };
    // The turn is at 0.5037 and at 0.5040 steps.
    let (mut axis, steps) = row(0.5, 0.503);
    assert_eq!((steps, axis.steps()), (0, 0));
    axis.push(100_000, PvtKnot::at_rest(1)).unwrap();
    let segments: Vec<_> = axis.by_ref().collect();
    assert!(
        segments.len() == 1 && segments[0].delay_ticks() == 100_000,
        "{segments:?}"
    );
    let (axis, steps) = row(0.5, 0.503_4);
    assert_eq!((steps, axis.steps()), (1, 1));
    // Many turns: never further.
    for n in 0..2000 {
        let end = 0.49 + 1e-5 * f64::from(n);
        let (axis, _) = row(0.5, end);
        let off = (end - axis.steps() as f64).abs();
        assert!(off <= 0.5 + 1.0 / 256.0, "{end}: {off}");
    }
}
