//! What holds for lines, arcs, axes and loops of any size: 0, the largest and smallest numbers,
//! what overflows. The answer is right, against its definition in 128 bits, or an error.

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use pulse_interp::{
    Arc, ArcError, AxesError, AxesLine, AxisLoop, Dda, Direction, Homing, HomingOrder,
    HomingSettings, Line, LoopSettings, Move, Rule, ScaleRatio, StepIntervals, SwitchError,
    Switches, Turn,
};
use test_support::{any_i32, any_u32};

/// Steps looked at of a path that may have billions.
const WINDOW: usize = 3000;

fn lengths() -> impl Strategy<Value = i32> {
    prop_oneof![-1400..=1400, -100_000..=100_000, any_i32()]
}

fn turns() -> impl Strategy<Value = Turn> {
    prop_oneof![Just(Turn::CounterClockwise), Just(Turn::Clockwise)]
}

fn directions() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::Positive), Just(Direction::Negative)]
}

/// Points up to the largest radius, and beyond.
fn points() -> impl Strategy<Value = [i32; 2]> {
    const MOST: i32 = 759_250_124; // 2^30 / sqrt(2)
    let coordinate = || prop_oneof![-70..=70, -100_000..=100_000, -MOST..=MOST];
    let whole = prop_oneof![1..=100, 1..=1 << 30];
    prop_oneof![
        2 => [coordinate(), coordinate()],
        1 => whole.clone().prop_map(|r| [r, 0]),
        1 => whole.prop_map(|r| [0, -r]),
        1 => [any_i32(), any_i32()],
    ]
}

fn square([x, y]: [i128; 2]) -> i128 {
    x * x + y * y
}

fn after(at: [i128; 2], step: Move) -> [i128; 2] {
    [at[0] + i128::from(step.dx()), at[1] + i128::from(step.dy())]
}

/// |r² - R²| <= 2 R d + d² for every point within d of the circle, in hundredths of a step.
fn within(at: [i128; 2], radius_squared: i128, hundredths: i128) -> bool {
    let radius_up = radius_squared.isqrt() + 1;
    let off = (square(at) - radius_squared).abs() * 10_000;
    off <= 200 * radius_up * hundredths + hundredths * hundredths
}

/// A way of walking an arc: its moves, how many it tells, and how far it strays, in hundredths.
type Walk = (Box<dyn Iterator<Item = Move>>, u64, i128);

fn walks(arc: &Arc) -> [Walk; 3] {
    let (published, nearest) = (arc.steps(Rule::Published), arc.steps(Rule::Nearest));
    let (moves, [of_published, of_nearest]) =
        (arc.moves(), [published.remaining(), nearest.remaining()]);
    let of_moves = moves.remaining();
    [
        (Box::new(published), of_published, 100),
        (Box::new(nearest), of_nearest, 71),
        (Box::new(moves), of_moves, 50),
    ]
}

/// From the start on, near its circle, and at its end where the window holds that.
fn check_arc(arc: &Arc, end_hundredths: i128) -> TestCaseResult {
    let (start, end) = (arc.start().map(i128::from), arc.end().map(i128::from));
    for (moves, remaining, hundredths) in walks(arc) {
        prop_assert!(remaining > 0);
        let (mut at, mut made) = (start, 0);
        for step in moves.take(WINDOW) {
            at = after(at, step);
            made += 1;
            prop_assert!(within(at, square(start), hundredths + end_hundredths));
        }
        prop_assert_eq!(made, remaining.min(WINDOW as u64));
        prop_assert!(made < remaining || at == end);
    }
    Ok(())
}

/// The size hint is what remains, step by step, and the end is final.
fn counts_down<I: Iterator>(mut steps: I, remaining: impl Fn(&I) -> u64) -> TestCaseResult {
    for left in (0..=steps.size_hint().0).rev() {
        prop_assert_eq!(steps.size_hint(), (left, Some(left)));
        prop_assert_eq!(remaining(&steps), left as u64);
        prop_assert_eq!(steps.next().is_some(), left > 0);
    }
    prop_assert!(steps.next().is_none());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn lines_follow_their_rule(to in [lengths(), lengths()], unit_ticks in any_u32()) {
        let line = Line::new(to);
        prop_assert_eq!(line.is_ok(), !to.contains(&i32::MIN));
        let Ok(line) = line else { return Ok(()) };
        let end = to.map(i128::from);
        let [xe, ye] = end.map(i128::abs);
        for (rule, bound) in [(Rule::Published, 1), (Rule::Nearest, 2)] {
            let steps = line.steps(rule);
            let count = steps.remaining();
            prop_assert_eq!(i128::from(count), xe + ye);
            let mut at = [0_i128; 2];
            for step in steps.take(WINDOW) {
                prop_assert!(!step.is_diagonal());
                let [x, y] = at.map(i128::abs);
                let f = y * xe - x * ye;
                let x_is_next = match rule {
                    Rule::Published => f >= 0 && x < xe,
                    _ => y == ye || x < xe && 2 * f >= ye - xe,
                };
                prop_assert_eq!(step.dx() != 0, x_is_next);
                prop_assert!(step.dx() * to[0].signum() >= 0 && step.dy() * to[1].signum() >= 0);
                at = after(at, step);
                // The distance from the line times its length.
                let off = at[1] * end[0] - at[0] * end[1];
                prop_assert!(bound * off * off <= square(end));
            }
            prop_assert!(count > WINDOW as u64 || at == end);
        }
        let (mut at, n) = ([0; 2], xe.max(ye));
        let moves = line.moves();
        prop_assert_eq!(i128::from(moves.remaining()), n);
        for (k, step) in (1..).zip(moves.take(WINDOW)) {
            at = after(at, step);
            let rounded = end.map(|len| len.signum() * ((2 * k * len.abs() + n) / (2 * n)));
            prop_assert_eq!(at, rounded);
        }
        prop_assert!(n > WINDOW as i128 || at == end);
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

    /// To an end anywhere, and back to the start.
    #[test]
    fn arcs_stay_at_their_circle(
        (start, end) in (points(), points()),
        turn in turns(),
        tolerance in any_u32(),
    ) {
        let (from, to) = (start.map(i128::from), end.map(i128::from));
        // In thousandths of a step, rounded down.
        let radius = |point| (square(point) * 1_000_000).isqrt();
        for (end, off) in [(end, radius(to) - radius(from)), (start, 0)] {
            let arc = match Arc::near(start, end, turn, tolerance) {
                Ok(arc) => arc,
                Err(ArcError::NoRadius) => { prop_assert_eq!(start, [0, 0]); return Ok(()); },
                Err(ArcError::EndAtCentre) => { prop_assert_eq!(end, [0, 0]); continue }
                Err(ArcError::RadiusTooLarge { .. }) => { prop_assert!(square(from) > 1 << 60); return Ok(()); },
                Err(error) => {
                    prop_assert!(end != start && off.abs() + 1 >= i128::from(tolerance), "{error}");
                    continue;
                }
            };
            prop_assert!(off.abs() <= i128::from(tolerance) + 1);
            check_arc(&arc, if end == start { 0 } else { off.abs() / 10 + 1 })?;
            if end == start {
                prop_assert!(arc.steps(Rule::Published).remaining().is_multiple_of(8));
                prop_assert!(arc.steps(Rule::Nearest).remaining().is_multiple_of(8));
            }
            // From 0.7071 to 1, and to 1.4142; a start near the centre is not far off either.
            prop_assert!(arc.steps(Rule::Nearest).factor().to_q16() <= 65_537);
            prop_assert!(arc.moves().factor().to_q16() <= 92_683);
        }
    }

    /// Ends rounded from angles: met, in the number of steps told, within rule and end.
    #[test]
    fn rounded_ends_are_met(
        start in [-900..=900, -900..=900],
        angle in 0.0..core::f64::consts::TAU,
        turn in turns(),
    ) {
        prop_assume!(start != [0, 0]);
        let radius = f64::from(start[0]).hypot(f64::from(start[1]));
        #[expect(clippy::cast_possible_truncation, reason = "within 1300")]
        let end = [angle.cos(), angle.sin()].map(|share| (radius * share).round() as i32);
        prop_assume!(end != [0, 0]);
        let arc = Arc::near(start, end, turn, 708).unwrap();
        for (moves, remaining, hundredths) in walks(&arc) {
            let (mut at, mut made) = (start.map(i128::from), 0);
            for step in moves {
                at = after(at, step);
                made += 1;
                prop_assert!(within(at, square(start.map(i128::from)), hundredths + 71));
            }
            prop_assert_eq!((at, made), (end.map(i128::from), remaining));
        }
    }

    #[test]
    fn size_hints_are_exact(start in [-40..=40, -40..=40], end in [-40..=40, -40..=40], turn in turns()) {
        let line = Line::new(end).unwrap();
        for rule in [Rule::Published, Rule::Nearest] {
            counts_down(line.steps(rule), |steps| steps.remaining())?;
        }
        counts_down(line.moves(), |moves| moves.remaining())?;
        counts_down(AxesLine::new(end).unwrap().steps(), |steps| steps.remaining())?;
        counts_down(Dda::new(end).unwrap().ticks(), |ticks| ticks.remaining())?;
        let Ok(arc) = Arc::near(start, end, turn, 5000) else {
            return Ok(());
        };
        for rule in [Rule::Published, Rule::Nearest] {
            counts_down(arc.steps(rule), |steps| steps.remaining())?;
        }
        counts_down(arc.moves(), |moves| moves.remaining())?;
    }
}

/// The same of what has several parts a step.
const SHORT: usize = 60;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn lines_of_many_axes(to in [any_i32(), any_i32(), any_i32()], ticks in any_u32()) {
        let lengths = to.map(|n| i128::from(n).abs());
        let refused = |error| matches!(error, AxesError::TooLong { .. }) && to.contains(&i32::MIN);
        match AxesLine::new(to) {
            Ok(line) => {
                let count = lengths.iter().sum::<i128>();
                prop_assert_eq!(i128::from(line.steps().remaining()), count);
                let mut made = [0_i128; 3];
                for step in line.steps().take(SHORT) {
                    let share = |axis: usize| (2 * made[axis] + 1, lengths[axis]);
                    let (p, n) = share(step.axis);
                    let least = (0..3).map(share).all(|(q, m)| m == 0 || p * m <= q * n);
                    prop_assert!(least && p < 2 * n);
                    made[step.axis] += 1;
                }
                prop_assert!(count > SHORT as i128 || made == lengths);
            }
            Err(error) => prop_assert!(refused(error)),
        }
        for dda in [Dda::new(to), Dda::over(to, ticks)] {
            match dda {
                Ok(dda) => {
                    let all = i128::from(dda.ticks().remaining());
                    let mut at = [0_i128; 3];
                    for (k, steps) in (1..).zip(dda.ticks().take(SHORT)) {
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
        max_steps in any_u32(),
        clear_steps in any_u32(),
        levels in prop::collection::vec(any::<bool>(), 1..40),
        position in any_i32(),
    ) {
        let settings = HomingSettings { direction, max_steps, clear_steps };
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
            prop_assert!(steps <= 3 * u64::from(max_steps));
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

/// The largest circle, through its octants and quadrants: at each axis and diagonal by way of an
/// arc that begins just before it.
#[test]
fn the_largest_circle_crosses_axes_and_diagonals() {
    const R: i32 = 1 << 30;
    let circle = Arc::new([R, 0], [R, 0], Turn::CounterClockwise).unwrap();
    let [(_, published, _), (_, nearest, _), (_, moves, _)] = walks(&circle);
    assert_eq!((published, nearest), (8 << 30, 8 << 30));
    // 4 sqrt(2) R moves, but for rounding.
    assert!(moves.abs_diff(6_074_000_999) < 8, "{moves}");

    for (start, turn) in [
        ([1200, 1_073_741_823], Turn::CounterClockwise),
        ([-1_073_741_823, -1200], Turn::Clockwise),
        ([759_250_500, 759_249_000], Turn::CounterClockwise),
        ([759_249_000, -759_250_500], Turn::CounterClockwise),
    ] {
        let arc = Arc::new(start, start, turn).unwrap();
        let start = start.map(i128::from);
        for (moves, _, hundredths) in walks(&arc) {
            let mut at = start;
            for step in moves.take(100_000) {
                at = after(at, step);
                assert!(within(at, square(start), hundredths));
            }
        }
    }
}
