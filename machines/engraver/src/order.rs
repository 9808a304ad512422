//! The order of the strokes: always the nearest end next, so that the lifted tool travels little.

use nalgebra::Point2;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// A stroke as straight lines between points, in mm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stroke {
    /// In the drawing, from 1.
    pub(crate) number: usize,
    /// It is engraved from its end in the drawing.
    pub(crate) is_reversed: bool,
    pub(crate) points: Vec<Point2<f64>>,
}

impl Stroke {
    /// Where it begins and ends.
    fn ends(&self) -> Option<[Point2<f64>; 2]> {
        Some([*self.points.first()?, *self.points.last()?])
    }
}

/// An end of a stroke: its index, and whether it is the last point.
type End = GeomWithData<[f64; 2], (usize, bool)>;

/// Strokes from a start on, each begun at the end that is nearest to where the one before ended.
///
/// Nearest neighbours make no shortest tour, which would be some 25 % shorter; they cost a look-up
/// for each stroke.
pub(crate) fn nearest_first(strokes: Vec<Stroke>, start: Point2<f64>) -> Vec<Stroke> {
    let mut ends = Vec::with_capacity(2 * strokes.len());
    for (index, stroke) in strokes.iter().enumerate() {
        if let Some([first, last]) = stroke.ends() {
            ends.push(End::new(first.into(), (index, false)));
            ends.push(End::new(last.into(), (index, true)));
        }
    }
    let mut tree = RTree::bulk_load(ends);
    let mut left: Vec<_> = strokes.into_iter().map(Some).collect();
    let mut ordered = Vec::with_capacity(left.len());
    let mut tool = start;
    while let Some(end) = tree.pop_nearest_neighbor(tool.into()) {
        let (index, is_last) = end.data;
        // The other end of a stroke that has been taken stays in the tree.
        let Some(mut stroke) = left.get_mut(index).and_then(Option::take) else {
            continue;
        };
        if is_last {
            stroke.points.reverse();
            // A dot has no direction.
            stroke.is_reversed = stroke.points.len() > 1;
        }
        tool = stroke.points.last().copied().unwrap_or(tool);
        ordered.push(stroke);
    }
    ordered
}

/// How far the lifted tool travels from a start over all strokes and back, in straight lines, in
/// mm.
pub(crate) fn travel_mm(strokes: &[Stroke], start: Point2<f64>) -> f64 {
    let (mut tool, mut travel) = (start, 0.0);
    for [first, last] in strokes.iter().filter_map(Stroke::ends) {
        travel += (first - tool).norm();
        tool = last;
    }
    travel + (start - tool).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stroke(number: usize, points: &[[f64; 2]]) -> Stroke {
        let points = points.iter().copied().map(Point2::from).collect();
        Stroke {
            number,
            is_reversed: false,
            points,
        }
    }

    #[test]
    fn the_nearest_end_is_next_and_strokes_are_reversed() {
        let mut far = stroke(1, &[[30.0, 0.0], [20.0, 0.0]]);
        let near = stroke(2, &[[1.0, 0.0], [9.0, 0.0]]);
        let dot = stroke(3, &[[12.0, 1.0]]);
        let start = Point2::origin();
        let file = vec![far.clone(), near.clone(), dot.clone()];
        let travel = 30.0 + 19.0 + 10_f64.sqrt() + 145_f64.sqrt();
        assert!((travel_mm(&file, start) - travel).abs() < 1e-12);
        let ordered = nearest_first(file, start);
        let travel = 1.0 + 10_f64.sqrt() + 65_f64.sqrt() + 30.0;
        assert!((travel_mm(&ordered, start) - travel).abs() < 1e-12);
        far.points.reverse();
        far.is_reversed = true;
        assert_eq!(ordered, [near, dot, far]);
    }
}
