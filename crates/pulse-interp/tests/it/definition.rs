//! The recurrences against the definitions, evaluated anew at every step, for all small lines and
//! arcs; and how far each rule strays.

use pulse_interp::{Arc, Line, Move, Rule, Turn};

use crate::common::walk::{Path, Walked, after, off_circle, off_line};

const LEN: i32 = 64;

// The deviations that the documentation states, in steps.
const LINE: [f64; 3] = [1.0, 0.7072, 0.5];
const ARC: [f64; 3] = [1.0, 0.7072, 0.5];
// What f64 loses in a root of a number below 10^5.
const ROUNDING: f64 = 1e-12;

const SINGLE: [Move; 4] = [Move::Right, Move::Up, Move::Left, Move::Down];

/// The line by the definition: F and its two successors at each point.
fn line_by_definition(to: [i32; 2], rule: Rule) -> Path {
    let f = |[x, y]: [i32; 2]| y * to[0].abs() - x * to[1].abs();
    let signs = to.map(i32::signum);
    let (mut at, mut path) = ([0, 0], vec![[0, 0]]);
    let ends = to.map(i32::abs);
    while at != ends {
        let (x, y) = ([at[0] + 1, at[1]], [at[0], at[1] + 1]);
        let x_is_next = match rule {
            _ if at[0] == ends[0] => false,
            _ if at[1] == ends[1] => true,
            Rule::Published => f(at) >= 0,
            _ => f(x).abs() <= f(y).abs(),
        };
        at = if x_is_next { x } else { y };
        path.push([at[0] * signs[0], at[1] * signs[1]]);
    }
    path
}

/// The other coordinate rounded at each step of the longer one.
fn bresenham_by_definition(to: [i32; 2]) -> Path {
    let [x, y] = to.map(i32::abs);
    let n = x.max(y);
    let at = |k: i32, len: i32| (2 * k * len + n) / (2 * n).max(1);
    (0..=n)
        .map(|k| [at(k, x) * to[0].signum(), at(k, y) * to[1].signum()])
        .collect()
}

#[test]
fn lines_are_those_of_the_definition() {
    let mut worst = [0.0_f64; 3];
    for to in (-LEN..=LEN).flat_map(|x| (-LEN..=LEN).map(move |y| [x, y])) {
        let defined = Walked::telling([
            line_by_definition(to, Rule::Published),
            line_by_definition(to, Rule::Nearest),
            bresenham_by_definition(to),
        ]);
        assert_eq!(Walked::line(&Line::new(to).unwrap()), defined, "{to:?}");
        for (worst, path) in worst.iter_mut().zip(&defined.paths) {
            *worst = worst.max(off_line(path, to));
        }
    }
    assert_worst(worst, LINE);
}

/// Within the stated bounds, and not by much, so that these say something.
fn assert_worst(worst: [f64; 3], stated: [f64; 3]) {
    for (worst, stated) in worst.into_iter().zip(stated) {
        assert!(worst <= stated + ROUNDING, "{worst} > {stated}");
        assert!(worst > stated - 0.01, "{worst} is far below {stated}");
    }
}

/// The two moves of the published table, inward and outward, at a point of a circle.
///
/// On an axis the quadrant is the one that the motion enters; at the centre, which only the circle
/// of radius 1 passes, it is the one that the motion is in.
fn moves_at([x, y]: [i32; 2], turn: Turn, last: Option<[Move; 2]>) -> [Move; 2] {
    use Move::{Down, Left, Right, Up};
    let ccw = turn == Turn::CounterClockwise;
    match (x.signum(), y.signum()) {
        (0, 0) => last.unwrap(),
        (1, 0 | 1) if ccw => [Left, Up],
        (-1 | 0, 1) if ccw => [Down, Left],
        (-1, -1 | 0) if ccw => [Right, Down],
        _ if ccw => [Up, Right],
        (0 | 1, 1) => [Down, Right],
        (1, -1 | 0) => [Left, Down],
        (-1 | 0, -1) => [Up, Left],
        _ => [Right, Up],
    }
}

/// The full circle from `start`, F evaluated at each point.
fn circle_by_definition(start: [i32; 2], turn: Turn, rule: Rule) -> Path {
    let square = |[x, y]: [i32; 2]| x * x + y * y;
    let f = |at: [i32; 2]| square(at) - square(start);
    let (mut at, mut path, mut last) = (start, vec![start], None);
    loop {
        let [inward, outward] = moves_at(at, turn, last);
        let goes_in = match rule {
            Rule::Published => f(at) >= 0,
            _ => f(after(at, inward)).abs() < f(after(at, outward)).abs(),
        };
        at = after(at, if goes_in { inward } else { outward });
        last = Some([inward, outward]);
        path.push(at);
        if at == start {
            return path;
        }
    }
}

/// The full circle of moves to eight neighbours, F at each midpoint.
fn midpoint_by_definition(start: [i32; 2], turn: Turn) -> Path {
    let square = |[x, y]: [i32; 2]| x * x + y * y;
    // At half steps.
    let f = |doubled: [i32; 2]| square(doubled) - 4 * square(start);
    let (mut at, mut path) = (start, vec![start]);
    loop {
        let [inward, outward] = moves_at(at, turn, None);
        let radial = |step: Move| (at[0] * step.dx() + at[1] * step.dy()).abs();
        // a is the coordinate along which the inward move goes, b that of the outward one.
        let outward_leads = radial(inward) > radial(outward);
        let lead = if outward_leads { outward } else { inward };
        let other = if outward_leads { inward } else { outward };
        let straight = after(at, lead);
        let between = [2 * straight[0] + other.dx(), 2 * straight[1] + other.dy()];
        let joins = if outward_leads {
            f(between) >= 0
        } else {
            f(between) < 0
        };
        at = if joins {
            after(straight, other)
        } else {
            straight
        };
        path.push(at);
        if at == start {
            return path;
        }
    }
}

/// All points of the grid within the largest radius, by their squares.
fn circles(largest_square: i32) -> Vec<Path> {
    let side = largest_square.isqrt();
    let mut circles = vec![Vec::new(); usize::try_from(largest_square).unwrap() + 1];
    for at in (-side..=side).flat_map(|x| (-side..=side).map(move |y| [x, y])) {
        let square = at[0] * at[0] + at[1] * at[1];
        if (1..=largest_square).contains(&square) {
            circles[usize::try_from(square).unwrap()].push(at);
        }
    }
    circles
}

/// Every arc between two points of every circle through the start.
#[test]
fn arcs_are_those_of_the_definition() {
    let mut worst = [0.0_f64; 3];
    for points in circles(LEN * LEN) {
        for (start, turn) in points
            .iter()
            .flat_map(|p| [Turn::CounterClockwise, Turn::Clockwise].map(|turn| (*p, turn)))
        {
            let circles = [
                circle_by_definition(start, turn, Rule::Published),
                circle_by_definition(start, turn, Rule::Nearest),
                midpoint_by_definition(start, turn),
            ];
            for (worst, circle) in worst.iter_mut().zip(&circles) {
                *worst = worst.max(off_circle(circle, start));
            }
            for end in &points {
                let arc = Arc::new(start, *end, turn).unwrap();
                let defined = [0, 1, 2].map(|of| up_to(*end, &circles[of]));
                assert_eq!(Walked::arc(&arc), Walked::telling(defined), "{arc:?}");
            }
        }
    }
    assert_worst(worst, ARC);
}

/// An arc is the circle up to its end.
fn up_to(end: [i32; 2], circle: &Path) -> Path {
    let before = circle.iter().skip(1).position(|at| *at == end).unwrap();
    circle[..before + 2].to_vec()
}

/// The bounds do not grow with the radius.
#[test]
fn large_circles_stay_as_close() {
    let mut worst = [0.0_f64; 3];
    for radius in (LEN..=800).step_by(7) {
        let start = [0, radius];
        let circle = Arc::new(start, start, Turn::Clockwise).unwrap();
        for (worst, path) in worst.iter_mut().zip(&Walked::arc(&circle).paths) {
            *worst = worst.max(off_circle(path, start));
        }
    }
    assert_worst(worst, ARC);
}

#[test]
fn full_circles_of_whole_radius_have_8_r_steps() {
    for radius in 1..=LEN {
        let arc = Arc::new([0, -radius], [0, -radius], Turn::Clockwise).unwrap();
        for rule in [Rule::Published, Rule::Nearest] {
            let steps = u64::try_from(8 * radius).unwrap();
            assert_eq!(arc.steps(rule).remaining(), steps);
        }
    }
}

/// Ends near the circle, as far as 3 steps off it: met all the same, in the number of steps told.
#[test]
fn ends_near_the_circle_are_met() {
    const ROUND: i32 = 12;
    let ends = (-ROUND..=ROUND).flat_map(|x| (-ROUND..=ROUND).map(move |y| [x, y]));
    let starts = circles(81).into_iter().flatten();
    for (start, end) in starts.flat_map(|start| ends.clone().map(move |end| (start, end))) {
        for turn in [Turn::CounterClockwise, Turn::Clockwise] {
            if let Ok(arc) = Arc::near(start, end, turn, 3000) {
                check_near(&arc);
            }
        }
    }
}

fn check_near(arc: &Arc) {
    let (start, end) = (arc.start(), arc.end());
    let Walked { paths, told } = Walked::arc(arc);
    for ((path, told), stated) in paths.iter().zip(told).zip(ARC) {
        assert_eq!(path.last(), Some(&end), "{arc:?}");
        assert_eq!(path.len() as u64, told + 1, "{arc:?}");
        let worst = off_circle(path, start);
        // No more than rule and end together.
        let stated = stated + off_circle(&[end], start);
        assert!(worst <= stated + ROUNDING, "{arc:?}: {worst}");
    }
}

#[test]
fn single_moves_are_unit_vectors() {
    let sum = SINGLE.iter().fold([0, 0], |at, step| after(at, *step));
    assert_eq!(sum, [0, 0]);
    assert!(SINGLE.iter().all(|step| !step.is_diagonal()));
    assert!(Move::DownLeft.is_diagonal());
}
