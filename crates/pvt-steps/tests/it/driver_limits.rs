//! Rows that a driver cannot follow are refused with their place.

use path_timing::{AxisLimits, Corner, Curve, Knot, Table};
use pvt_steps::{
    AxisSegments, MinIntervals, PvtQuantiser, PvtRow, PvtSteps, Rate, RowError, StepDirTiming,
    StepScale,
};
use test_support::Random;

use crate::common::rows::{LEAST, STEP, STEP_A_TICK, knot, steps};

#[test]
fn a_step_back_waits_for_the_driver() {
    // Up to 1/2 + 1/400 at a step in 100 ticks, and back at once: passed for half a tick.
    let v = STEP_A_TICK / 100;
    let top = knot(STEP / 2 + STEP / 400, v);
    let back = knot(top.position, -v);
    let rows = [(50, top), (0, back), (50, knot(STEP / 400, -v))];
    // 30 ticks later the axis would be 0.3 steps past its place, and the row ends before the driver
    // has had its time again.
    let mut axis = AxisSegments::new(knot(0, v), LEAST);
    axis.push(50, top).unwrap();
    assert_eq!(axis.by_ref().count(), 1);
    axis.push(0, back).unwrap();
    let before = axis.clone();
    let error = RowError::ReversalTooQuick {
        row: 2,
        axis: 0,
        ticks: 80,
        min_ticks: 30,
    };
    assert_eq!(axis.push(50, rows[2].1), Err(error));
    assert_eq!(axis, before);
    assert_eq!(
        error.to_string(),
        "row 2, axis 0, tick 80: steps back in fewer than 30 ticks"
    );
    // A row that goes on: the step waits, those after it come in their time.
    let on = knot(STEP / 2 - 5 * STEP, -v);
    let made = steps(knot(0, v), &[(50, top), (0, back), (500, on)]);
    assert_eq!(made[..2], [(50, 1), (80, -1)]);
    assert!(made[2].0 == 150 && made.iter().all(|step| step.0 == 50 || step.1 == -1));
    // At a step in 40 ticks the next one would come 8 ticks after it.
    let (v, top) = (STEP_A_TICK / 40, STEP / 2 + 1);
    let mut axis = AxisSegments::new(knot(STEP / 4, v), LEAST);
    axis.push(10, knot(top, v)).unwrap();
    axis.by_ref().for_each(drop);
    axis.push(0, knot(top, -v)).unwrap();
    let refused = axis.push(200, knot(top - 5 * STEP, -v));
    assert!(
        matches!(refused, Err(RowError::ReversalTooQuick { ticks: 40, .. })),
        "{refused:?}"
    );
    // A hundredth as fast it is past by 0.003 steps: the step waits.
    let v = STEP_A_TICK / 10_000;
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

/// Polylines of ten sides whose corners are jumps, with an opto-isolated driver of 5 us before and
/// after a change of direction: some were refused in the middle while no step back waited where it
/// was late by more than 2^-8 steps.
#[test]
fn corners_with_jumps_turn_slow_drivers() {
    const STEPS_PER_MM: f64 = 400.0;
    const JUMP: [f64; 2] = [20.0; 2];
    let timing = StepDirTiming {
        pulse_ns: 2500,
        pause_ns: 2500,
        setup_ns: 5000,
        hold_ns: 5000,
    };
    let rate = Rate::from_hz(72_000_000).unwrap();
    let axis = AxisLimits {
        speed: 150.0,
        acceleration: 3000.0,
        jerk: None,
    };
    let mut random = Random::new(1);
    for _ in 0..50 {
        let mut point = || [random.within(0.0, 20.0), random.within(0.0, 20.0)];
        let points: [[f64; 2]; 11] = core::array::from_fn(|_| point());
        let lines = points.windows(2).map(|ends| {
            let line = Curve::line(ends[0], ends[1]).unwrap();
            line.with_corner(Corner::Jump(JUMP))
        });
        let mut knots = [Knot::default(); 100];
        let table = Table::plan(lines, [axis; 2], |_| 8, &mut knots).unwrap();
        let scale = StepScale::new(STEPS_PER_MM).unwrap();
        let mut rows = table.rows();
        let start = rows.next().unwrap().position;
        let quantiser = PvtQuantiser::new(rate, [scale; 2], start).unwrap();
        let mut quantiser = quantiser.with_start_stop_speeds(JUMP);
        let mut steps = PvtSteps::new(quantiser.knots(), timing.min_intervals(rate));
        for row in rows {
            let row = quantiser.row(row.time_s, row.position, row.velocity);
            steps.push(&row.unwrap()).unwrap();
            steps.by_ref().for_each(drop);
        }
        for (steps, mm) in steps.steps().into_iter().zip(points[10]) {
            let steps = f64::from(i32::try_from(steps).unwrap());
            assert!((steps - mm * STEPS_PER_MM).abs() <= 0.5);
        }
    }
}

#[test]
fn what_is_too_fast_is_refused_with_its_place() {
    let mut axis = AxisSegments::new(knot(0, 0), LEAST);
    let too_fast = |ticks, interval_ticks| RowError::TooFast {
        row: 0,
        axis: 0,
        ticks,
        interval_ticks,
        min_ticks: 12,
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
            min_ticks: 30
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
