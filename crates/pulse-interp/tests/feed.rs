//! Path speed: the variation at a fixed pulse rate, and its cure.
#![cfg(test)]

use pulse_interp::{Arc, Factor, Line, Move, Rule, StepIntervals, Turn};

/// How far the speed may be off, as a share.
const STEADY: f64 = 0.01;
/// 1 MHz ticks at 1000 steps/s.
const UNIT_TICKS: u32 = 1000;

#[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
fn float(number: u64) -> f64 {
    number as f64
}

/// Least and most speed of the sectors of a circle, in step lengths per unit interval.
///
/// Each sector is measured between the steps that first enter it and the next.
fn speeds(points: impl Iterator<Item = ([i32; 2], f64)>, radius: f64, sectors: u32) -> [f64; 2] {
    let width = core::f64::consts::TAU / f64::from(sectors);
    let (mut now, mut marks) = (0.0, Vec::new());
    let mut next = 0;
    for ([x, y], interval) in points {
        now += interval;
        let angle = f64::from(y)
            .atan2(f64::from(x))
            .rem_euclid(core::f64::consts::TAU);
        if next < sectors && angle >= width * f64::from(next) && angle < width * f64::from(next + 1)
        {
            marks.push((angle, now));
            next += 1;
        }
    }
    assert_eq!(marks.len(), sectors as usize);
    let speeds = marks
        .windows(2)
        .map(|pair| radius * (pair[1].0 - pair[0].0) / (pair[1].1 - pair[0].1));
    speeds.fold([f64::INFINITY, 0.0], |[least, most], speed| {
        [speed.min(least), speed.max(most)]
    })
}

#[test]
fn a_fixed_rate_varies_by_41_percent_and_the_factor_cures_it() {
    const RADIUS: i32 = 20_000;
    let start = [RADIUS, 0];
    let circle = Arc::new(start, start, Turn::CounterClockwise).unwrap();
    for rule in [Rule::Published, Rule::Nearest] {
        for (paced, wanted) in [
            (false, [core::f64::consts::FRAC_1_SQRT_2, 1.0]),
            (true, [1.0, 1.0]),
        ] {
            let mut steps = circle.steps(rule);
            let (mut at, mut intervals) = (start, StepIntervals::new(UNIT_TICKS));
            let points = core::iter::from_fn(|| {
                let factor = if paced { steps.factor() } else { Factor::ONE };
                let ticks = intervals.next(factor);
                let step = steps.next()?;
                at = [at[0] + step.dx(), at[1] + step.dy()];
                Some((at, float(ticks) / f64::from(UNIT_TICKS)))
            });
            let measured = speeds(points, f64::from(RADIUS), 360);
            for (measured, wanted) in measured.into_iter().zip(wanted) {
                assert!(
                    (measured / wanted - 1.0).abs() < STEADY,
                    "{measured}, {rule:?}"
                );
            }
        }
    }
}

#[test]
fn moves_to_eight_neighbours_are_cured_too() {
    const RADIUS: i32 = 20_000;
    let start = [RADIUS, 0];
    let circle = Arc::new(start, start, Turn::CounterClockwise).unwrap();
    let (mut moves, mut at) = (circle.moves(), start);
    let points = core::iter::from_fn(|| {
        let factor = f64::from(moves.factor().to_q16()) / 65_536.0;
        let step = moves.next()?;
        at = [at[0] + step.dx(), at[1] + step.dy()];
        Some((at, factor))
    });
    for speed in speeds(points, f64::from(RADIUS), 360) {
        assert!((speed - 1.0).abs() < STEADY, "{speed}");
    }
}

/// Whole small circles take their circumference.
#[test]
fn small_circles_last_as_long_as_they_are() {
    for radius in 50..60 {
        let start = [0, radius];
        let circle = Arc::new(start, start, Turn::Clockwise).unwrap();
        let (mut steps, mut intervals, mut ticks) =
            (circle.steps(Rule::Nearest), StepIntervals::new(1000), 0);
        loop {
            let factor = steps.factor();
            if steps.next().is_none() {
                break;
            }
            ticks += intervals.next(factor);
        }
        let wanted = core::f64::consts::TAU * f64::from(radius) * 1000.0;
        assert!(
            (float(ticks) / wanted - 1.0).abs() < STEADY,
            "radius {radius}"
        );
    }
}

#[test]
fn lines_last_as_long_as_they_are() {
    for to in [[3, 4], [-5000, 5000], [1, 9999], [0, -77], [20_000, -3]] {
        let line = Line::new(to).unwrap();
        let length = f64::from(to[0]).hypot(f64::from(to[1]));
        for (count, factor) in [
            (line.steps(Rule::Published).remaining(), line.step_factor()),
            (line.moves().remaining(), line.move_factor()),
        ] {
            let mut intervals = StepIntervals::new(UNIT_TICKS);
            let ticks: u64 = (0..count).map(|_| intervals.next(factor)).sum();
            let share = float(ticks) / (length * f64::from(UNIT_TICKS)) - 1.0;
            assert!(share.abs() < 1e-3, "{to:?}: {share}");
        }
    }
}

#[test]
fn factors_at_the_ends_of_their_range() {
    let factor = |to: [i32; 2]| Line::new(to).unwrap().step_factor().to_q16();
    assert_eq!(factor([0, 0]), 65_536);
    assert_eq!(factor([7, 0]), 65_536);
    // sqrt(1/2) and sqrt(2) in 65536ths: 46340.95, 92681.9.
    assert_eq!(factor([-i32::MAX, i32::MAX]), 46_341);
    for end in [1, 2, 1000, i32::MAX] {
        let line = Line::new([end, end]).unwrap();
        assert_eq!(line.step_factor().to_q16(), 46_341);
        assert_eq!(line.move_factor().to_q16(), 92_682);
    }
    // Back to an end outside that the rule has passed: a straight step.
    let arc = Arc::near([0, -10], [11, 1], Turn::CounterClockwise, 2000).unwrap();
    let mut steps = arc.steps(Rule::Nearest);
    let _ = steps
        .by_ref()
        .take(arc.steps(Rule::Nearest).count() - 1)
        .last();
    assert_eq!(
        (steps.factor(), steps.next()),
        (Factor::ONE, Some(Move::Right))
    );
    let arc = Arc::near([0, -10], [13, 2], Turn::CounterClockwise, 4000).unwrap();
    let mut steps = arc.steps(Rule::Nearest);
    let _ = steps
        .by_ref()
        .take(arc.steps(Rule::Nearest).count() - 3)
        .last();
    for left in [3, 2, 1] {
        let seen = (steps.remaining(), steps.factor(), steps.next());
        assert_eq!(seen, (left, Factor::ONE, Some(Move::Right)));
    }
    // The one circle whose path passes the centre.
    let circle = Arc::new([1, 0], [1, 0], Turn::CounterClockwise).unwrap();
    let mut steps = circle.steps(Rule::Published);
    steps.next();
    assert_eq!(steps.factor(), Factor::ONE);
}

#[test]
fn fractions_of_a_tick_are_carried() {
    let line = Line::new([1, 1]).unwrap();
    let mut intervals = StepIntervals::new(3);
    let ticks: Vec<u64> = (0..8).map(|_| intervals.next(line.step_factor())).collect();
    // 2.1213 ticks each.
    assert_eq!(ticks, [2, 2, 2, 2, 2, 2, 2, 2]);
    assert_eq!(intervals.next(line.step_factor()), 3);
}
