//! Every function with anything: 0, the largest and smallest numbers, what overflows. The answer is
//! right, against its definition in 128 bits, or an error.

use proptest::prelude::*;
use pulse_interp::{
    Arc, ArcError, AxesError, AxesLine, AxisLoop, Dda, Direction, Homing, HomingOrder,
    HomingSettings, Line, LoopSettings, Move, Rule, ScaleRatio, StepIntervals, SwitchError,
    Switches, Turn,
};
use test_support::{any_i32, any_u32};

/// Steps looked at of a path that may have billions.
const WINDOW: usize = 60;

fn turns() -> impl Strategy<Value = Turn> {
    prop_oneof![Just(Turn::CounterClockwise), Just(Turn::Clockwise)]
}

fn directions() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::Positive), Just(Direction::Negative)]
}

fn square([x, y]: [i128; 2]) -> i128 {
    x * x + y * y
}

fn after(at: [i128; 2], step: Move) -> [i128; 2] {
    [at[0] + i128::from(step.dx()), at[1] + i128::from(step.dy())]
}

/// Whether r² is within what d hundredths of a step off the circle leave.
fn beside_circle(at: [i128; 2], radius_squared: i128, hundredths: i128) -> bool {
    let radius_up = radius_squared.isqrt() + 1;
    let off = (square(at) - radius_squared).abs() * 10_000;
    off <= 200 * radius_up * hundredths + hundredths * hundredths
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn lines(to in [any_i32(), any_i32()], unit_ticks in any_u32()) {
        let line = Line::new(to);
        prop_assert_eq!(line.is_ok(), !to.contains(&i32::MIN));
        let Ok(line) = line else { return Ok(()) };
        let end = to.map(i128::from);
        let [width, height] = end.map(i128::abs);
        // |y xe - x ye| is the distance from the line times its length.
        let off = |[x, y]: [i128; 2]| (y * end[0] - x * end[1]).abs();
        for (rule, bound) in [(Rule::Published, 1), (Rule::Nearest, 2)] {
            let steps = line.steps(rule);
            let count = width + height;
            prop_assert_eq!(i128::from(steps.remaining()), count);
            let mut at = [0; 2];
            for step in steps.take(WINDOW) {
                at = after(at, step);
                prop_assert!(bound * off(at) * off(at) <= square(end));
            }
            prop_assert!(count > 60 || at == end);
        }
        let moves = line.moves();
        let count = width.max(height);
        prop_assert_eq!(i128::from(moves.remaining()), count);
        let at = moves.take(WINDOW).fold([0; 2], after);
        prop_assert!(2 * off(at) <= count);
        prop_assert!(count > 60 || at == end);
        for factor in [line.step_factor(), line.move_factor()] {
            let mut intervals = StepIntervals::new(unit_ticks);
            let mut ticks = 0;
            for n in 1..9 {
                ticks += u128::from(intervals.next(factor).unwrap());
                let exact = u128::from(unit_ticks) * u128::from(factor.to_q16()) * n;
                prop_assert_eq!(ticks, exact >> 16);
            }
        }
    }

    #[test]
    fn arcs(start in [any_i32(), any_i32()], end in [any_i32(), any_i32()], turn in turns(), tolerance in any_u32()) {
        let (from, to) = (start.map(i128::from), end.map(i128::from));
        // In thousandths of a step, rounded down.
        let radius = |point| (square(point) * 1_000_000).isqrt();
        let off = radius(to) - radius(from);
        for (end, to, off) in [(end, to, off), (start, from, 0)] {
            let arc = match Arc::near(start, end, turn, tolerance) {
                Ok(arc) => arc,
                Err(ArcError::NoRadius) => { prop_assert_eq!(start, [0, 0]); return Ok(()); },
                Err(ArcError::EndAtCentre) => { prop_assert_eq!(end, [0, 0]); continue }
                Err(ArcError::RadiusTooLarge { .. }) => { prop_assert!(square(from) > 1 << 60); return Ok(()); },
                Err(error) => {
                    prop_assert!(off.abs() + 1 >= i128::from(tolerance), "{error}");
                    continue;
                }
            };
            prop_assert!(off.abs() <= i128::from(tolerance) + 1);
            let allowed = off.abs() / 10 + 1;
            for (moves, remaining, hundredths) in [
                (Box::new(arc.steps(Rule::Published)) as Box<dyn Iterator<Item = Move>>, arc.steps(Rule::Published).remaining(), 100),
                (Box::new(arc.steps(Rule::Nearest)), arc.steps(Rule::Nearest).remaining(), 71),
                (Box::new(arc.moves()), arc.moves().remaining(), 50),
            ] {
                prop_assert!(remaining > 0);
                let mut at = from;
                for step in moves.take(WINDOW) {
                    at = after(at, step);
                    prop_assert!(beside_circle(at, square(from), hundredths + allowed));
                }
                prop_assert!(remaining > 60 || at == to);
            }
            // From 0.7071 to 1, and to 1.4142; a start near the centre is not far off either.
            prop_assert!(arc.steps(Rule::Nearest).factor().to_q16() <= 65_537);
            prop_assert!(arc.moves().factor().to_q16() <= 92_683);
        }
    }

    #[test]
    fn lines_of_many_axes(to in [any_i32(), any_i32(), any_i32()], ticks in any_u32()) {
        let lengths = to.map(|n| i128::from(n).abs());
        let refused = |error| matches!(error, AxesError::TooLong { .. }) && to.contains(&i32::MIN);
        match AxesLine::new(to) {
            Ok(line) => {
                let count = lengths.iter().sum::<i128>();
                prop_assert_eq!(i128::from(line.steps().remaining()), count);
                let mut made = [0_i128; 3];
                for step in line.steps().take(WINDOW) {
                    let share = |axis: usize| (2 * made[axis] + 1, lengths[axis]);
                    let (p, n) = share(step.axis);
                    let least = (0..3).map(share).all(|(q, m)| m == 0 || p * m <= q * n);
                    prop_assert!(least && p < 2 * n);
                    made[step.axis] += 1;
                }
                prop_assert!(count > 60 || made == lengths);
            }
            Err(error) => prop_assert!(refused(error)),
        }
        for dda in [Dda::new(to), Dda::over(to, ticks)] {
            match dda {
                Ok(dda) => {
                    let all = i128::from(dda.ticks().remaining());
                    let mut at = [0_i128; 3];
                    for (k, steps) in (1..).zip(dda.ticks().take(WINDOW)) {
                        for axis in 0..3 {
                            at[axis] += i128::from(steps[axis]);
                            let rounded = (2 * k * lengths[axis] + all) / (2 * all);
                            prop_assert_eq!(at[axis], rounded * i128::from(to[axis].signum()));
                        }
                    }
                }
                Err(AxesError::Ticks { ticks, least, limit }) => prop_assert!(ticks < least || ticks > limit),
                Err(error) => prop_assert!(refused(error)),
            }
        }
    }

    #[test]
    fn corrections(
        (counts, steps) in any::<(u16, u16)>(),
        (dead_band_counts, alarm_counts) in (any_u32(), any_u32()),
        read in any_i32(),
        commanded in -300..300_i32,
    ) {
        let ratio = ScaleRatio::new(counts, steps);
        prop_assert_eq!(ratio.is_ok(), counts > 0 && steps > 0);
        let Ok(ratio) = ratio else { return Ok(()) };
        let axis = AxisLoop::new(LoopSettings { ratio, dead_band_counts, alarm_counts });
        prop_assert_eq!(axis.is_ok(), dead_band_counts < alarm_counts);
        let Ok(mut axis) = axis else { return Ok(()) };
        let direction = if commanded < 0 { Direction::Negative } else { Direction::Positive };
        (0..commanded.abs()).for_each(|_| axis.command(direction));
        let (counts, steps) = (i128::from(counts), i128::from(steps));
        // In counts times the steps of the ratio.
        let error = i128::from(read) * steps - i128::from(commanded) * counts;
        let within = |limit: u32| error.abs() <= i128::from(limit) * steps;
        match axis.correction(read) {
            Ok(correction) if within(dead_band_counts) => prop_assert_eq!(correction, 0),
            Ok(correction) => {
                prop_assert!(within(alarm_counts));
                prop_assert!(2 * (i128::from(correction) * counts + error).abs() <= counts);
            }
            Err(lost) => {
                prop_assert_eq!(i128::from(lost.error_counts), error / steps);
                prop_assert!(!within(alarm_counts) || error.abs() / counts >= 0x7FFF_FFFF);
                prop_assert!(axis.correction(0).is_err());
            }
        }
    }

    #[test]
    fn homing_and_switches(
        direction in directions(),
        most_steps in any_u32(),
        clear_steps in any_u32(),
        levels in prop::collection::vec(any::<bool>(), 1..40),
        position in any_i32(),
    ) {
        let settings = HomingSettings { direction, most_steps, clear_steps };
        let mut homing = Homing::new(settings);
        let mut ended = None;
        let mut steps = 0;
        for closed in levels {
            let order = homing.next(closed);
            match order {
                Ok(HomingOrder::Step { .. }) => {
                    prop_assert!(ended.is_none());
                    steps += 1;
                }
                end => prop_assert_eq!(*ended.get_or_insert(end), end),
            }
            prop_assert!(steps <= 3 * u64::from(most_steps));
        }
        for (lower, upper) in [(false, false), (true, false), (false, true), (true, true)] {
            let permitted = Switches { lower, upper }.permit(direction, position);
            match permitted {
                Ok(()) => {
                    let closed = if direction == Direction::Positive { upper } else { lower };
                    prop_assert!(!closed);
                }
                Err(SwitchError::Hit { position_steps, .. }) => prop_assert_eq!(position_steps, position),
                Err(error) => {
                    prop_assert_eq!(error, SwitchError::BothClosed { position_steps: position });
                    prop_assert!(lower && upper);
                }
            }
        }
    }
}
