//! How far the tool's path and the drawing are apart, both ways.

use kurbo::BezPath;
use nalgebra::{Point2, Vector2};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

use crate::drawing::flatten;

/// The drawing is measured as lines that are within this share of the tolerance.
const FINE: f64 = 0.01;

/// The drawing is looked at in pieces no longer than this, in mm, nor than this share
/// of the reach: a gap as wide as the bound shows on fine machines too.
const PIECE_MM: f64 = 0.2;
const PIECE_SHARE: f64 = 0.25;

/// Moves that are looked up together.
const BATCH: usize = 8;

/// Distance of `p` from the straight line between `a` and `b`.
pub(crate) fn distance_to_segment(p: Point2<f64>, a: Point2<f64>, b: Point2<f64>) -> f64 {
    Segment::new(a, b).distance_2(p).sqrt()
}

/// A straight line between two places, ready to be asked for distances.
#[derive(Clone, Copy)]
struct Segment {
    from: Point2<f64>,
    way: Vector2<f64>,
    /// One over the length squared; 0 for a point.
    per_length_2: f64,
}

impl Segment {
    fn new(from: Point2<f64>, to: Point2<f64>) -> Self {
        let way = to - from;
        let length_2 = way.norm_squared();
        Self {
            from,
            way,
            per_length_2: if length_2 > 0.0 {
                length_2.recip()
            } else {
                0.0
            },
        }
    }

    fn to(&self) -> Point2<f64> {
        self.from + self.way
    }

    fn distance_2(&self, p: Point2<f64>) -> f64 {
        let off = p - self.from;
        let share = (off.dot(&self.way) * self.per_length_2).clamp(0.0, 1.0);
        (off - self.way * share).norm_squared()
    }
}

/// Deviations of a whole drawing, in mm.
pub(crate) struct Deviation {
    pub(crate) path_to_drawing_mm: f64,
    /// A place to which the path never came within the gauge's reach counts as that far.
    pub(crate) drawing_to_path_mm: f64,
    pub(crate) rms_mm: f64,
    /// Length of the drawing to which the path never came within the gauge's reach.
    pub(crate) missing_mm: f64,
}

/// A short straight piece of the drawing.
struct Piece {
    line: Segment,
    index: usize,
}

impl RTreeObject for Piece {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.line.from.into(), self.line.to().into())
    }
}

impl PointDistance for Piece {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        self.line.distance_2((*point).into())
    }
}

/// Compares a path, move by move, with a drawing.
pub(crate) struct Gauge {
    pieces: RTree<Piece>,
    lengths: Vec<f64>,
    /// Squared distance of the path from the beginning of each piece, as far as seen.
    nearest_2: Vec<f64>,
    /// How far around the path is looked for the drawing.
    reach: f64,
    batch: Vec<Segment>,
    worst_2: f64,
    squares: f64,
    count: f64,
}

impl Gauge {
    /// A gauge for `outlines` in mm that tells distances of up to `reach` apart, to a
    /// small part of `tolerance`.
    pub(crate) fn new(outlines: &[BezPath], tolerance: f64, reach: f64) -> Self {
        let longest = PIECE_MM.min(reach * PIECE_SHARE);
        let mut pieces = Vec::new();
        for outline in outlines {
            cut_up(&flatten(outline, tolerance * FINE), longest, &mut pieces);
        }
        Self {
            lengths: pieces.iter().map(|piece| piece.line.way.norm()).collect(),
            nearest_2: vec![f64::INFINITY; pieces.len()],
            pieces: RTree::bulk_load(pieces),
            reach,
            batch: Vec::with_capacity(BATCH),
            worst_2: 0.0,
            squares: 0.0,
            count: 0.0,
        }
    }

    /// The tool went straight from one place to another, engraving.
    pub(crate) fn engraved(&mut self, from: Point2<f64>, to: Point2<f64>) {
        // A new stroke may be far away: not one box around both.
        let goes_on = self.batch.last().is_none_or(|last| last.to() == from);
        if !goes_on || self.batch.len() == BATCH {
            self.look_up();
        }
        self.batch.push(Segment::new(from, to));
    }

    pub(crate) fn finish(mut self) -> Deviation {
        self.look_up();
        let reach_2 = self.reach * self.reach;
        let seen = self
            .nearest_2
            .iter()
            .map(|nearest_2| nearest_2.min(reach_2));
        let missed = self.nearest_2.iter().zip(&self.lengths);
        Deviation {
            path_to_drawing_mm: self.worst_2.sqrt(),
            drawing_to_path_mm: seen.fold(0.0, f64::max).sqrt(),
            rms_mm: (self.squares / self.count.max(1.0)).sqrt(),
            // An empty `sum` is -0.
            missing_mm: missed
                .filter(|(nearest_2, _)| **nearest_2 > reach_2)
                .fold(0.0, |sum, (_, length)| sum + length),
        }
    }

    fn look_up(&mut self) {
        let Some(first) = self.batch.first() else {
            return;
        };
        let (mut low, mut high) = (first.from, first.from);
        for step in &self.batch {
            low = low.inf(&step.to());
            high = high.sup(&step.to());
        }
        let around = Vector2::repeat(self.reach);
        let envelope = AABB::from_corners((low - around).into(), (high + around).into());
        let near: Vec<&Piece> = self
            .pieces
            .locate_in_envelope_intersecting(envelope)
            .collect();
        for step in &self.batch {
            let tool = step.to();
            let mut off_2 = f64::INFINITY;
            for piece in &near {
                off_2 = off_2.min(piece.line.distance_2(tool));
                if let Some(nearest_2) = self.nearest_2.get_mut(piece.index) {
                    *nearest_2 = nearest_2.min(step.distance_2(piece.line.from));
                }
            }
            if off_2 > self.reach * self.reach {
                off_2 = self.off_the_drawing(tool);
            }
            self.worst_2 = self.worst_2.max(off_2);
            self.squares += off_2;
            self.count += 1.0;
        }
        self.batch.clear();
    }

    /// The squared distance where nothing of the drawing is within reach.
    fn off_the_drawing(&self, tool: Point2<f64>) -> f64 {
        self.pieces
            .nearest_neighbor(tool.into())
            .map_or(f64::INFINITY, |piece| piece.line.distance_2(tool))
    }
}

/// Pieces of a stroke, none above `longest`; its end is a piece without length, so that
/// it is looked at too.
fn cut_up(points: &[Point2<f64>], longest: f64, pieces: &mut Vec<Piece>) {
    let mut add = |from, to| {
        let index = pieces.len();
        let line = Segment::new(from, to);
        pieces.push(Piece { line, index });
    };
    for (a, b) in points.iter().zip(points.iter().skip(1)) {
        let parts = ((b - a).norm() / longest).ceil().max(1.0);
        let mut from = *a;
        let mut done = 1.0;
        while done <= parts {
            let to = a + (b - a) * (done / parts);
            add(from, to);
            from = to;
            done += 1.0;
        }
    }
    if let Some(end) = points.last() {
        add(*end, *end);
    }
}
