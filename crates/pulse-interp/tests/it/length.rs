//! Lengths of lines and arcs, against whole numbers and against the sum of all steps.

use core::f64::consts::TAU;

use proptest::prelude::*;
use pulse_interp::{Arc, Line, Rule, Turn};

/// A length is rounded up, and both ways round the circle are.
const ROUNDED: f64 = 2.0;
/// 53 bits of a length below 2^33, and of the sine of its angle.
const DIGITS: f64 = 1e-5;

fn arc(start: [i32; 2], end: [i32; 2], turn: Turn) -> Arc {
    Arc::near(start, end, turn, 1_000_000).unwrap()
}

fn as_float(length: u64) -> f64 {
    f64::from(u32::try_from(length).unwrap())
}

#[test]
fn of_whole_circles_and_quarters() {
    for turn in [Turn::CounterClockwise, Turn::Clockwise] {
        assert_eq!(arc([400, 0], [400, 0], turn).length(), 2514);
        assert_eq!(arc([400, 0], [-400, 0], turn).length(), 1257);
        let largest = arc([1 << 30, 0], [1 << 30, 0], turn).length();
        assert_eq!(largest, 6_746_518_853); // 2π 2^30 = 6746518852.26
    }
    let [short, long] = [Turn::CounterClockwise, Turn::Clockwise];
    assert_eq!(arc([0, -100], [100, 0], short).length(), 158);
    assert_eq!(arc([0, -100], [100, 0], long).length(), 472);
    // A step of the largest circle.
    assert_eq!(arc([1 << 30, 0], [1 << 30, 1], short).length(), 1);
}

#[test]
fn of_an_arc_is_the_sum_of_its_steps_at_constant_feed() {
    let arc = arc([3000, 4000], [-4000, 3000], Turn::CounterClockwise);
    let mut steps = arc.steps(Rule::Nearest);
    let mut sum = 0.0;
    while steps.remaining() > 0 {
        sum += f64::from(steps.factor().to_q16()) / 65_536.0;
        steps.next();
    }
    let length = as_float(arc.length());
    assert!((sum - length).abs() < 0.001 * length, "{sum} {length}");
}

proptest! {
    #[test]
    fn of_a_line_is_the_root_rounded_up(x in -i32::MAX..=i32::MAX, y in -i32::MAX..=i32::MAX) {
        let length = u128::from(Line::new([x, y]).unwrap().length());
        let square = u128::from(x.unsigned_abs()).pow(2) + u128::from(y.unsigned_abs()).pow(2);
        prop_assert!(length * length >= square);
        prop_assert!(length == 0 || (length - 1).pow(2) < square);
    }

    #[test]
    fn both_ways_round_make_a_circle(x in 1..100_000, y in -100_000..100_000, quarters in 1_u32..4) {
        let end = (0..quarters).fold([x, y], |[x, y]: [i32; 2], _| [-y, x]);
        let [there, back] = [Turn::CounterClockwise, Turn::Clockwise]
            .map(|turn| as_float(arc([x, y], end, turn).length()));
        let circle = TAU * f64::from(x).hypot(f64::from(y));
        prop_assert!(there + back >= circle - DIGITS && there + back <= circle + ROUNDED);
        let part = circle * f64::from(quarters) / 4.0;
        prop_assert!(there >= part - DIGITS && there <= part + 1.0 + DIGITS);
    }
}
