//! What holds for lines and arcs of any size.

use proptest::prelude::*;
use pulse_interp::{Arc, ArcError, Line, Move, Rule, Turn};

/// Steps looked at of a path that may have billions.
const WINDOW: usize = 3000;

const RULES: [Rule; 2] = [Rule::Published, Rule::Nearest];

fn lengths() -> impl Strategy<Value = i32> {
    prop_oneof![-70..=70, -100_000..=100_000, -i32::MAX..=i32::MAX]
}

fn turns() -> impl Strategy<Value = Turn> {
    prop_oneof![Just(Turn::CounterClockwise), Just(Turn::Clockwise)]
}

/// Coordinates of a start, up to the largest radius.
fn starts() -> impl Strategy<Value = [i32; 2]> {
    const MOST: i32 = 759_250_124; // 2^30 / sqrt(2)
    let coordinate = || prop_oneof![-70..=70, -100_000..=100_000, -MOST..=MOST];
    let whole = prop_oneof![1..=100, 1..=1 << 30];
    prop_oneof![
        [coordinate(), coordinate()],
        whole.clone().prop_map(|r| [r, 0]),
        whole.prop_map(|r| [0, -r]),
    ]
    .prop_filter("the centre has no radius", |p| *p != [0, 0])
}

fn after(at: [i64; 2], step: Move) -> [i64; 2] {
    [at[0] + i64::from(step.dx()), at[1] + i64::from(step.dy())]
}

/// |r² - R²| <= 2 R d + d² for every point within d of the circle, in hundredths of a step.
fn within(at: [i64; 2], radius_squared: u64, hundredths: i128) -> bool {
    let square = at.map(|c| i128::from(c).pow(2)).iter().sum::<i128>();
    let off = 10_000 * (square - i128::from(radius_squared)).abs();
    let radius_up = i128::from(radius_squared.isqrt()) + 1;
    off <= 200 * radius_up * hundredths + hundredths * hundredths
}

proptest! {
    #[test]
    fn lines_follow_their_rule(to in [lengths(), lengths()]) {
        let line = Line::new(to).unwrap();
        let [xe, ye] = to.map(|n| i128::from(n.abs()));
        for rule in RULES {
            let steps = line.steps(rule);
            prop_assert_eq!(i128::from(steps.remaining()), xe + ye);
            let (mut x, mut y) = (0_i128, 0_i128);
            for step in steps.take(WINDOW) {
                prop_assert!(!step.is_diagonal());
                let f = y * xe - x * ye;
                let x_is_next = match rule {
                    Rule::Published => f >= 0 && x < xe,
                    _ => y == ye || x < xe && 2 * f >= ye - xe,
                };
                prop_assert_eq!(step.dx() != 0, x_is_next);
                x += i128::from(step.dx().abs());
                y += i128::from(step.dy().abs());
                prop_assert!(step.dx() * to[0] >= 0 && step.dy() * to[1] >= 0);
            }
        }
        let (mut at, n) = ([0, 0], xe.max(ye));
        for (k, step) in (1..).zip(line.moves().take(WINDOW)) {
            at = after(at, step);
            let rounded = to.map(|len| {
                let len = i128::from(len);
                len.signum() * ((2 * k * len.abs() + n) / (2 * n))
            });
            prop_assert_eq!(at.map(i128::from), rounded);
        }
    }

    #[test]
    fn short_lines_end_at_their_end(to in [-5000..=5000, -5000..=5000]) {
        let line = Line::new(to).unwrap();
        let end = to.map(i64::from);
        for rule in RULES {
            prop_assert_eq!(line.steps(rule).fold([0, 0], after), end);
        }
        prop_assert_eq!(line.moves().fold([0, 0], after), end);
    }

    /// From anywhere on a circle of any size, and near its end.
    #[test]
    fn arcs_stay_at_their_circle(start in starts(), turn in turns(), skip in 0..4_usize) {
        let arc = match Arc::new(start, start, turn) {
            Ok(arc) => arc,
            Err(error) => {
                let too_large = matches!(error, ArcError::RadiusTooLarge { .. });
                prop_assert!(too_large);
                return Ok(());
            }
        };
        for (rule, hundredths) in [(Rule::Published, 100), (Rule::Nearest, 71)] {
            let steps = arc.steps(rule);
            let left = steps.remaining();
            prop_assert_eq!(left % 8, 0);
            let mut at = start.map(i64::from);
            for (k, step) in (1..).zip(steps.take(WINDOW + skip)) {
                at = after(at, step);
                prop_assert!(within(at, arc.radius_squared(), hundredths));
                prop_assert!(k != left || at == start.map(i64::from));
            }
        }
        let mut at = start.map(i64::from);
        for step in arc.moves().take(WINDOW) {
            at = after(at, step);
            prop_assert!(within(at, arc.radius_squared(), 50));
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
        let wanted = end.map(i64::from);
        for rule in RULES {
            let steps = arc.steps(rule);
            let (mut at, mut made) = (start.map(i64::from), 0);
            let left = steps.remaining();
            for step in steps {
                at = after(at, step);
                made += 1;
                prop_assert!(within(at, arc.radius_squared(), 171));
            }
            prop_assert_eq!((at, made), (wanted, left));
        }
        let moves = arc.moves();
        let (mut at, mut made) = (start.map(i64::from), 0);
        let left = moves.remaining();
        for step in moves {
            at = after(at, step);
            made += 1;
            prop_assert!(within(at, arc.radius_squared(), 121));
        }
        prop_assert_eq!((at, made), (wanted, left));
    }

    /// Size hints count down, and the end is final.
    #[test]
    fn size_hints_are_exact(start in [-40..=40, -40..=40], end in [-40..=40, -40..=40], turn in turns()) {
        let Ok(arc) = Arc::near(start, end, turn, 5000) else {
            return Ok(());
        };
        for rule in RULES {
            let mut steps = arc.steps(rule);
            for left in (0..steps.size_hint().0).rev() {
                prop_assert!(steps.next().is_some());
                prop_assert_eq!(steps.size_hint(), (left, Some(left)));
                prop_assert_eq!(steps.remaining(), left as u64);
            }
            prop_assert!(steps.next().is_none() && steps.next().is_none());
        }
        let mut moves = arc.moves();
        for left in (0..moves.size_hint().0).rev() {
            prop_assert!(moves.next().is_some());
            prop_assert_eq!(moves.size_hint(), (left, Some(left)));
            prop_assert_eq!(moves.remaining(), left as u64);
        }
        prop_assert!(moves.next().is_none() && moves.next().is_none());
    }
}

/// The largest circle, through its octants and quadrants: at each axis and diagonal by way of an
/// arc that begins just before it.
#[test]
fn the_largest_circle_crosses_axes_and_diagonals() {
    const R: i32 = 1 << 30;
    let circle = Arc::new([R, 0], [R, 0], Turn::CounterClockwise).unwrap();
    assert_eq!(circle.steps(Rule::Nearest).remaining(), 8 << 30);
    assert_eq!(circle.steps(Rule::Published).remaining(), 8 << 30);
    // 4 sqrt(2) R moves, but for rounding.
    let moves = circle.moves().remaining();
    assert!(moves.abs_diff(6_074_000_999) < 8, "{moves}");

    for (start, turn) in [
        ([1200, 1_073_741_823], Turn::CounterClockwise),
        ([-1_073_741_823, -1200], Turn::Clockwise),
        ([759_250_500, 759_249_000], Turn::CounterClockwise),
        ([759_249_000, -759_250_500], Turn::CounterClockwise),
    ] {
        let arc = Arc::new(start, start, turn).unwrap();
        let mut at = start.map(i64::from);
        for step in arc.steps(Rule::Published).take(100_000) {
            at = after(at, step);
            assert!(within(at, arc.radius_squared(), 100));
        }
        let mut at = start.map(i64::from);
        for step in arc.moves().take(100_000) {
            at = after(at, step);
            assert!(within(at, arc.radius_squared(), 50));
        }
    }
}

#[test]
fn errors_say_what_and_by_how_much() {
    let ccw = Turn::CounterClockwise;
    assert_eq!(Arc::new([0, 0], [1, 0], ccw), Err(ArcError::NoRadius));
    assert_eq!(
        Arc::near([1, 0], [0, 0], ccw, 9999),
        Err(ArcError::EndAtCentre)
    );
    let error = Arc::new([1 << 30, 1], [1 << 30, 1], ccw).unwrap_err();
    assert_eq!(
        error.to_string(),
        "start (1073741824, 1): the radius is above 1073741824 steps"
    );
    // 5.385 against 5.
    let error = Arc::near([5, 0], [5, 2], ccw, 300).unwrap_err();
    assert_eq!(
        error.to_string(),
        "end (5, 2): 386 thousandths of a step outside the circle, 300 allowed either way"
    );
    let error = Arc::new([5, 0], [2, 4], ccw).unwrap_err();
    assert!(
        matches!(
            error,
            ArcError::EndOffCircle {
                off_millisteps: -528,
                ..
            }
        ),
        "{error:?}"
    );
    // A square off by one, far out: less than a thousandth, but not nothing.
    let error = Arc::new([1 << 29, 0], [1 << 29, 1], ccw).unwrap_err();
    assert!(
        matches!(
            error,
            ArcError::EndOffCircle {
                off_millisteps: 1,
                ..
            }
        ),
        "{error:?}"
    );
}
