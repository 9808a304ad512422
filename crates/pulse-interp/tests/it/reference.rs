//! Lines and arcs against the published step strings and the reference tables.

use pulse_interp::{Arc, ArcError, Line, Move, Rule, Turn};

use crate::common::walk::{Walked, off_circle, off_line, path};

/// The tables have six decimals.
const DEVIATION: f64 = 5.1e-7;

fn letter(step: Move) -> char {
    match step {
        Move::Right => 'R',
        Move::Left => 'L',
        Move::Up => 'U',
        Move::Down => 'D',
        diagonal => panic!("{diagonal:?} in a path of single steps"),
    }
}

/// `1R2U` as `RUU`; strings without numbers as they are.
fn spelled_out(runs: &str) -> String {
    let mut text = String::new();
    let mut count = 0;
    for c in runs.chars() {
        match c.to_digit(10) {
            Some(digit) => count = 10 * count + digit as usize,
            None => {
                text.extend(core::iter::repeat_n(c, count.max(1)));
                count = 0;
            }
        }
    }
    text
}

fn text(steps: impl IntoIterator<Item = Move>) -> String {
    steps.into_iter().map(letter).collect()
}

fn line(to: [i32; 2]) -> String {
    text(Line::new(to).unwrap().steps(Rule::Published))
}

fn arc(start: [i32; 2], end: [i32; 2], turn: Turn) -> String {
    text(Arc::new(start, end, turn).unwrap().steps(Rule::Published))
}

#[test]
fn published_arc() {
    let steps = arc([4, 0], [0, 4], Turn::CounterClockwise);
    assert_eq!(steps, "LUUULULL");
}

#[test]
fn no_step_of_x_where_there_is_none_to_make() {
    assert_eq!(line([0, 3]), "UUU");
    assert_eq!(line([0, -2]), "DD");
    assert_eq!(line([2, 0]), "RR");
    assert_eq!(line([0, 0]), "");
}

/// By hand: through the centre, the deviation of which is the whole radius.
#[test]
fn radius_1() {
    assert_eq!(arc([1, 0], [0, 1], Turn::CounterClockwise), "LU");
    assert_eq!(arc([1, 0], [1, 0], Turn::CounterClockwise), "LUDLRDUR");
    assert_eq!(arc([0, 1], [0, -1], Turn::Clockwise), "DRLD");
    let nearest = Arc::new([1, 0], [1, 0], Turn::CounterClockwise).unwrap();
    assert_eq!(text(nearest.steps(Rule::Nearest)), "ULLDDRRU");
    let diagonals = [Move::UpLeft, Move::DownLeft, Move::DownRight, Move::UpRight];
    assert!(nearest.moves().eq(diagonals));
}

/// Every row of `line4.csv`.
#[test]
fn line_table() {
    let mut rows = 0;
    for row in include_str!("../data/line4.csv").lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let to = [cells[0], cells[1]].map(|cell| cell.parse::<i32>().unwrap());
        let steps = Line::new(to).unwrap().steps(Rule::Published);
        assert_eq!(steps.remaining(), cells[2].parse::<u64>().unwrap(), "{row}");
        assert_eq!(text(steps.clone()), spelled_out(cells[3]), "{row}");

        let path = path([0, 0], steps);
        assert_eq!(path.last(), Some(&to), "{row}");
        let wanted: f64 = cells[5].parse().unwrap();
        let off = off_line(&path, to);
        assert!((off - wanted).abs() < DEVIATION, "{row}");
        // The unrepaired rule fails along Y alone.
        assert_eq!(cells[4] == "0", to[0] == 0 && to[1] != 0, "{row}");
        rows += 1;
    }
    assert_eq!(rows, 107);
}

/// Every row of `arc4.csv`.
#[test]
fn arc_table() {
    let (mut rows, mut missed) = (0, 0);
    for row in include_str!("../data/arc4.csv").lines().skip(1) {
        missed += u32::from(!check_arc(row));
        rows += 1;
    }
    assert_eq!((rows, missed), (500, 11));
}

/// Checks a row; whether the published walk, which counts its steps without a look at the end,
/// meets it.
fn check_arc(row: &str) -> bool {
    let cells: Vec<&str> = row.split(',').collect();
    let turn = match cells[1] {
        "ccw" => Turn::CounterClockwise,
        _ => Turn::Clockwise,
    };
    let number = |k: usize| cells[k].parse::<i32>().unwrap();
    let (start, end) = ([number(2), number(3)], [number(4), number(5)]);
    let (wanted, hits) = (spelled_out(cells[7]), cells[10] == "1");
    let arc = match (cells[0], Arc::new(start, end, turn)) {
        ("exact", arc) => arc.unwrap(),
        // An end that was rounded is not on the circle, or by chance.
        (_, Ok(arc)) => arc,
        (_, Err(error)) => {
            assert!(matches!(error, ArcError::EndOffCircle { .. }), "{row}");
            Arc::near(start, end, turn, 1000).unwrap()
        }
    };

    assert_eq!(wanted.len(), cells[6].parse::<usize>().unwrap(), "{row}");
    let published_end = [number(8), number(9)];
    assert_eq!(published_end == end, hits, "{row}");
    // With end tests: the same path where it hits, else one as long that does.
    let steps = arc.steps(Rule::Published);
    assert_eq!(steps.remaining(), wanted.len() as u64, "{row}");
    assert_eq!(text(steps) == wanted, hits, "{row}");
    let max_dev: f64 = cells[11].parse().unwrap();
    let Walked { paths, .. } = Walked::arc(&arc);
    let published = off_circle(&paths[0], start);
    assert!(!hits || (published - max_dev).abs() < DEVIATION, "{row}");
    for path in paths {
        assert_eq!(path.last(), Some(&end), "{row}");
        assert!(off_circle(&path, start) <= 1.0, "{row}");
    }
    hits
}
