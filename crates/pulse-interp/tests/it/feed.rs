//! Path speed: the variation at a fixed pulse rate, its cure, and speeds that change.

use pulse_interp::{Arc, Factor, Line, Move, Rule, StepIntervals, Turn};
use pvt_steps::{Ramp, RampLimits, Rate};

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
                let ticks = intervals.next(factor)?;
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
            ticks += intervals.next(factor).unwrap();
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
            let ticks: u64 = (0..count).map(|_| intervals.next(factor).unwrap()).sum();
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
    let ticks: Vec<u64> = (0..8)
        .map(|_| intervals.next(line.step_factor()).unwrap())
        .collect();
    // 2.1213 ticks each.
    assert_eq!(ticks, [2, 2, 2, 2, 2, 2, 2, 2]);
    assert_eq!(intervals.next(line.step_factor()), Some(3));
}

/// Units of any length: no interval is off by a tick from the time of its place.
#[test]
fn units_that_change_keep_their_sum() {
    let units = (0..4000_u32).map(|k| (k * k) % 7919 + k % 3);
    let circle = Arc::new([500, 0], [500, 0], Turn::Clockwise).unwrap();
    let mut steps = circle.moves();
    let mut intervals = StepIntervals::from_units(units.clone());
    let (mut length_q16, mut ticks) = (0_u64, 0_u64);
    while steps.remaining() > 0 {
        let factor = steps.factor();
        length_q16 += u64::from(factor.to_q16());
        ticks += intervals.next(factor).unwrap();
        steps.next();
        let whole = usize::try_from(length_q16 >> 16).unwrap();
        let before: u64 = units.clone().take(whole).map(u64::from).sum();
        let unit = u64::from(units.clone().nth(whole).unwrap());
        let wanted = ((before << 16) + unit * (length_q16 & 0xFFFF)) >> 16;
        assert_eq!(ticks, wanted, "at {length_q16}");
    }
}

#[test]
fn there_is_no_interval_after_the_last_unit() {
    let factor = Line::new([1, 1]).unwrap().step_factor();
    let mut intervals = StepIntervals::from_units([1000, 500]);
    let ticks: Vec<_> = (0..4).map(|_| intervals.next(factor)).collect();
    assert_eq!(ticks, [Some(707), Some(500), None, None]);
    // To its very end.
    let mut intervals = StepIntervals::from_units([7, u32::MAX]);
    let ticks = [Factor::ONE; 3].map(|factor| intervals.next(factor));
    assert_eq!(ticks, [Some(7), Some(u32::MAX.into()), None]);
    assert_eq!(StepIntervals::from_units([]).next(Factor::ONE), None);
}

/// A ramp over the length of a path: where the path is at each tick.
#[test]
fn a_circle_follows_its_ramp() {
    /// Half a step by which pulses of a ramp are early, half a step between the sum of factors and
    /// the place of a step along the circle, and what the first unit has of linear in time.
    const OFF_STEPS: f64 = 1.1;
    const RADIUS: i32 = 2000;
    /// The circumference, rounded up.
    const UNITS: i32 = 12_567;
    let limits = RampLimits {
        start_millihertz: 0,
        max_millihertz: 5_000_000,
        accel_steps_per_s2: 50_000,
    };
    let length = core::f64::consts::TAU * f64::from(RADIUS);
    let rate = Rate::from_hz(1_000_000).unwrap();
    let ramp = Ramp::new([UNITS], &limits, rate).unwrap();
    let mut pulses = ramp.axes()[0].clone();
    let mut high_ticks = 0;
    let units = core::iter::from_fn(|| {
        let unit = high_ticks + pulses.next()?;
        high_ticks = pulses.next()?;
        u32::try_from(unit).ok()
    });
    let circle = Arc::new([RADIUS, 0], [RADIUS, 0], Turn::CounterClockwise).unwrap();
    let (mut steps, mut intervals) = (
        circle.steps(Rule::Nearest),
        StepIntervals::from_units(units),
    );
    let (mut at, mut ticks) = ([RADIUS, 0], 0);
    let (mut fastest, mut last_quarter) = (0_f64, (0.0, 0.0));
    while steps.remaining() > 0 {
        ticks += intervals.next(steps.factor()).unwrap();
        let step = steps.next().unwrap();
        at = [at[0] + step.dx(), at[1] + step.dy()];
        let angle = f64::from(at[1]).atan2(f64::from(at[0]));
        let gone = angle.rem_euclid(core::f64::consts::TAU) * f64::from(RADIUS);
        let (seconds, all) = (float(ticks) / 1e6, float(ramp.end_ticks()) / 1e6);
        // 0.1 s up to 5000 steps/s, and down.
        let ramp_steps = |s: f64| {
            let up = s.min(0.1);
            25_000.0 * up * up + 5000.0 * (s - up)
        };
        let wanted = if seconds < all / 2.0 {
            ramp_steps(seconds)
        } else {
            f64::from(UNITS) - ramp_steps(all - seconds)
        };
        let off = (gone - wanted + length / 2.0).rem_euclid(length) - length / 2.0;
        assert!(off.abs() < OFF_STEPS, "{off} at {seconds} s");
        if gone - last_quarter.1 > 100.0 {
            fastest = fastest.max((gone - last_quarter.1) / (seconds - last_quarter.0));
            last_quarter = (seconds, gone);
        }
    }
    assert_eq!(at, [RADIUS, 0]);
    assert!((fastest / 5000.0 - 1.0).abs() < 0.02, "{fastest} steps/s");
}
