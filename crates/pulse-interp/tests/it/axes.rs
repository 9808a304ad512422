//! Lines of several axes against their definitions.

use pulse_interp::{AxesLine, Dda, Line, Move, Rule};

const LEN: i32 = 9;
// What f64 loses in roots and products of small integers.
const ROUNDING: f64 = 1e-12;

/// Distance of a point from the line through the origin and `to`, squared, times |to|².
fn cross_squared(to: [i32; 3], at: [i32; 3]) -> i32 {
    let dot = |a: [i32; 3], b: [i32; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<i32>();
    dot(to, to) * dot(at, at) - dot(to, at).pow(2)
}

fn off(to: [i32; 3], at: [i32; 3]) -> f64 {
    let square: i32 = to.iter().map(|n| n * n).sum();
    (f64::from(cross_squared(to, at)) / f64::from(square.max(1))).sqrt()
}

fn ends() -> impl Iterator<Item = [i32; 3]> {
    (-LEN..=LEN).flat_map(|x| (0..=LEN).flat_map(move |y| (-LEN..=LEN).map(move |z| [x, y, z])))
}

#[test]
fn the_axis_with_the_least_share_steps() {
    let mut worst = 0.0_f64;
    for to in ends() {
        let (mut at, mut worst_here) = ([0_i32; 3], 0.0_f64);
        let steps = AxesLine::new(to).unwrap().steps();
        let sum: i32 = to.iter().map(|n| n.abs()).sum();
        assert_eq!(steps.remaining(), u64::try_from(sum).unwrap());
        for step in steps {
            // (2 p + 1) / n compared across, the first of equals.
            let share = |axis: usize| (2 * at[axis].abs() + 1, to[axis].abs());
            let (made, all) = share(step.axis);
            for other in 0..3 {
                let (p, n) = share(other);
                let ahead = made * n - p * all;
                assert!(n == 0 || ahead < 0 || ahead == 0 && step.axis <= other);
            }
            at[step.axis] += step.direction.sign();
            worst_here = worst_here.max(off(to, at));
        }
        assert_eq!(at, to);
        worst = worst.max(worst_here);
    }
    // sqrt(3)/2 is the bound; lines as short as these come near it.
    assert!(worst <= 0.75_f64.sqrt() + ROUNDING, "{worst}");
    assert!(worst > 0.8, "{worst}");
}

#[test]
fn two_axes_are_the_nearest_line() {
    for to in (-20..=20).flat_map(|x| (-20..=20).map(move |y| [x, y])) {
        let moves = AxesLine::new(to).unwrap().steps().map(|step| {
            match (step.axis, step.direction.sign()) {
                (0, 1) => Move::Right,
                (0, _) => Move::Left,
                (_, 1) => Move::Up,
                _ => Move::Down,
            }
        });
        assert!(
            moves.eq(Line::new(to).unwrap().steps(Rule::Nearest)),
            "{to:?}"
        );
    }
}

#[test]
fn the_clocked_line_is_rounded_at_every_tick() {
    let mut worst = 0.0_f64;
    for to in ends() {
        let longest = to.iter().map(|n| n.abs()).max().unwrap();
        for ticks in [longest, longest + 1, 3 * longest + 2] {
            let dda = Dda::over(to, ticks.unsigned_abs()).unwrap();
            let mut at = [0; 3];
            for (k, steps) in (1..).zip(dda.ticks()) {
                for (at, step) in at.iter_mut().zip(steps) {
                    *at += i32::from(step);
                }
                let rounded = to.map(|n| n.signum() * ((2 * k * n.abs() + ticks) / (2 * ticks)));
                assert_eq!(at, rounded, "{to:?} at {k} of {ticks}");
                if ticks == longest {
                    worst = worst.max(off(to, at));
                }
            }
            assert_eq!(at, to);
        }
    }
    assert!(worst <= 0.5_f64.sqrt() + ROUNDING, "{worst}");
}

#[test]
fn in_a_plane_the_fewest_ticks_are_bresenhams_line() {
    for to in (-20..=20).flat_map(|x| (-20..=20).map(move |y| [x, y])) {
        let moves = Line::new(to).unwrap().moves();
        let ticks = Dda::new(to).unwrap().ticks();
        assert_eq!(ticks.remaining(), moves.remaining());
        assert!(ticks.eq(moves.map(|m| [m.dx(), m.dy()].map(|d| i8::try_from(d).unwrap()))));
    }
}

#[test]
fn no_axis_and_one_axis() {
    assert_eq!(AxesLine::new([]).unwrap().steps().count(), 0);
    assert_eq!(Dda::new([]).unwrap().ticks().count(), 0);
    assert_eq!(AxesLine::new([-3]).unwrap().steps().count(), 3);
    assert_eq!(AxesLine::new([0, 0, 0]).unwrap().steps().count(), 0);
}

#[test]
fn extreme_lengths_begin_as_they_should() {
    let to = [i32::MAX, -i32::MAX, 1];
    assert_eq!(
        (AxesLine::new(to).unwrap().to(), Dda::new(to).unwrap().to()),
        (to, to)
    );
    let mut steps = AxesLine::new(to).unwrap().steps();
    assert_eq!(steps.remaining(), 2 * 0x7FFF_FFFF + 1);
    let axes: Vec<usize> = steps.by_ref().take(6).map(|step| step.axis).collect();
    assert_eq!(axes, [0, 1, 0, 1, 0, 1]);
    let ticks = Dda::new(to).unwrap().ticks();
    assert!(ticks.take(5).all(|tick| tick == [1, -1, 0]));
}

#[cfg(target_arch = "x86_64")]
#[test]
fn memory_is_what_the_readme_says() {
    use pulse_interp::{ArcMoves, ArcSteps, LineMoves, LineSteps};
    assert_eq!(size_of::<LineSteps>(), 20);
    assert_eq!(size_of::<LineMoves>(), 20);
    assert_eq!(size_of::<ArcSteps>(), 96);
    assert_eq!(size_of::<ArcMoves>(), 128);
}
