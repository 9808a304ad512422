//! Lines as data of SVG paths, in few characters.

use core::fmt::{self, Write as _};

use super::frame::Frame;
use super::plot::Point;

/// Of a chart's line, the points of a column so wide are drawn as their least and largest.
const COLUMN_PX: f64 = 0.5;

/// Lines as the data of one path; what is beside the frame is left out.
pub(super) fn path_data(lines: &[Vec<Point>], frame: &Frame, is_map: bool) -> String {
    let mut data = String::new();
    for line in lines {
        for run in line.split(|[x, y]| !(x.is_finite() && y.is_finite())) {
            let points: Vec<Point> = run.iter().map(|point| frame.at(*point)).collect();
            let points = if is_map { points } else { columns(points) };
            if let [point] = *points {
                write_dot(&mut data, point);
            }
            write_line(&mut data, &points, frame);
        }
    }
    data
}

/// A line of no length, which shows where ends are round.
fn write_dot(data: &mut String, point: Point) {
    let [x, y] = tenths(point);
    // A string takes what is written.
    let _ = write!(data, "M{}{}l0 0", Tenths(x), Next(y));
}

fn write_line(data: &mut String, points: &[Point], frame: &Frame) {
    // Where the pen is, on the grid of the path's numbers, so that rounding does not add up.
    let mut pen = None;
    for pair in points.windows(2) {
        let [from, to] = pair else { continue };
        if frame.is_beside(*from, *to) {
            end_line(data);
            pen = None;
            continue;
        }
        let [x, y] = *pen.get_or_insert_with(|| {
            let [x, y] = tenths(*from);
            let _ = write!(data, "M{}{}l", Tenths(x), Next(y));
            [x, y]
        });
        let at = tenths(*to);
        let (dx, dy) = (at[0] - x, at[1] - y);
        if (dx, dy) != (0, 0) {
            let separator = if data.ends_with('l') || dx < 0 {
                ""
            } else {
                " "
            };
            let _ = write!(data, "{separator}{}{}", Tenths(dx), Next(dy));
            pen = Some(at);
        }
    }
    end_line(data);
}

/// A line whose points are one on the grid is a dot: `l` without numbers would end the path.
fn end_line(data: &mut String) {
    if data.ends_with('l') {
        data.push_str("0 0");
    }
}

/// Of many points along x, the least and largest of each column, in their order.
fn columns(points: Vec<Point>) -> Vec<Point> {
    let is_forward = points.is_sorted_by(|a, b| a[0] <= b[0]);
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return points;
    };
    let many = 8.0 * (last[0] - first[0]) / COLUMN_PX;
    let count = points.iter().fold(0.0, |count, _| count + 1.0);
    if !is_forward || count <= many.max(64.0) {
        return points;
    }
    let column = |point: &Point| (point[0] / COLUMN_PX).floor().to_bits();
    let same = |a: &Point, b: &Point| column(a) == column(b);
    let mut thinned = Vec::new();
    for column in points.chunk_by(same) {
        let by_height = |a: &&Point, b: &&Point| a[1].total_cmp(&b[1]);
        let high = column.iter().min_by(by_height);
        let low = column.iter().max_by(by_height);
        let mut kept: Vec<Point> = [column.first(), high, low, column.last()]
            .into_iter()
            .flatten()
            .copied()
            .collect();
        kept.sort_by(|a, b| a[0].total_cmp(&b[0]));
        thinned.append(&mut kept);
    }
    thinned
}

/// A point of the picture in tenths of a pixel.
fn tenths(point: Point) -> [i32; 2] {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "saturates far outside of the picture"
    )]
    point.map(|px| (px * 10.0).round() as i32)
}

/// Tenths as a decimal number in the fewest characters.
struct Tenths(i32);

impl fmt::Display for Tenths {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let (whole, tenth) = (self.0.unsigned_abs() / 10, self.0.unsigned_abs() % 10);
        match (whole, tenth) {
            (_, 0) => write!(f, "{sign}{whole}"),
            (0, _) => write!(f, "{sign}.{tenth}"),
            _ => write!(f, "{sign}{whole}.{tenth}"),
        }
    }
}

/// A number after another one: a sign parts them as well as a space.
struct Next(i32);

impl fmt::Display for Next {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let space = if self.0 < 0 { "" } else { " " };
        write!(f, "{space}{}", Tenths(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::axis::Axis;
    use crate::figure::plot::Plot;

    #[test]
    fn lines_of_no_length_are_dots() {
        let plot = Plot::map(
            Axis::new("x").over(0.0..=10.0),
            Axis::new("y").over(0.0..=10.0),
        );
        let frame = Frame::new(&plot, 700.0, 0.0);
        let standing = vec![[5.0, 5.0], [5.0, 5.0]];
        let moving = vec![[5.0, 5.0], [5.0001, 5.0], [6.0, 5.0]];
        // Beside the frame before it moves.
        let leaving = vec![[5.0, 5.0], [5.0, 5.0], [11.0, 11.0], [12.0, 11.0]];
        let dot = path_data(&[vec![[5.0, 5.0]]], &frame, true);
        assert_eq!(
            path_data(core::slice::from_ref(&standing), &frame, true),
            dot
        );
        for lines in [[standing.clone(), moving], [standing, leaving]] {
            let data = path_data(&lines, &frame, true);
            assert!(data.starts_with(&dot), "{data}");
            let mut numbers = data.split('M').skip(1).map(|line| line.split_once('l'));
            let is_drawn = |line: Option<(&str, &str)>| line.is_some_and(|(_, to)| !to.is_empty());
            assert!(numbers.all(is_drawn), "{data}");
        }
    }
}
