//! How far the tool's path and the drawing are apart, both ways.

use kurbo::BezPath;
use nalgebra::Point2;
use rstar::{AABB, PointDistance, RTree, RTreeObject};

use crate::drawing::flatten;

/// The drawing is measured as lines that are within this of it, in mm.
const FINE_MM: f64 = 0.0005;

/// The drawing is looked at in pieces no longer than this, in mm.
const PIECE_MM: f64 = 0.2;

/// Moves that are looked up together.
const BATCH: usize = 32;

/// Distance of `p` from the straight line between `a` and `b`.
pub(crate) fn distance_to_segment(p: Point2<f64>, a: Point2<f64>, b: Point2<f64>) -> f64 {
    let way = b - a;
    let length2 = way.norm_squared();
    let share = if length2 > 0.0 {
        ((p - a).dot(&way) / length2).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (a + way * share - p).norm()
}

/// Deviations of a whole drawing, in mm.
pub(crate) struct Deviation {
    pub(crate) path_to_drawing_mm: f64,
    /// At least; a stroke that is missing altogether counts as `reach_mm`.
    pub(crate) drawing_to_path_mm: f64,
    pub(crate) rms_mm: f64,
    /// Length of the drawing to which the path never came within `reach_mm`.
    pub(crate) missing_mm: f64,
    pub(crate) reach_mm: f64,
}

/// A short straight piece of the drawing.
struct Piece {
    from: Point2<f64>,
    to: Point2<f64>,
    index: usize,
}

impl RTreeObject for Piece {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.from.into(), self.to.into())
    }
}

impl PointDistance for Piece {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        distance_to_segment((*point).into(), self.from, self.to).powi(2)
    }
}

/// Compares a path, move by move, with a drawing.
pub(crate) struct Gauge {
    pieces: RTree<Piece>,
    lengths: Vec<f64>,
    /// Distance of the path from the beginning of each piece, as far as seen.
    nearest: Vec<f64>,
    /// How far around the path is looked for the drawing.
    reach: f64,
    batch: Vec<(Point2<f64>, Point2<f64>)>,
    worst: f64,
    squares: f64,
    count: f64,
}

impl Gauge {
    /// A gauge for `outlines` in mm that tells distances of up to `reach` apart.
    pub(crate) fn new(outlines: &[BezPath], reach: f64) -> Self {
        let mut pieces = Vec::new();
        for outline in outlines {
            cut_up(&flatten(outline, FINE_MM), &mut pieces);
        }
        Self {
            lengths: pieces.iter().map(|p| (p.to - p.from).norm()).collect(),
            nearest: vec![f64::INFINITY; pieces.len()],
            pieces: RTree::bulk_load(pieces),
            reach,
            batch: Vec::with_capacity(BATCH),
            worst: 0.0,
            squares: 0.0,
            count: 0.0,
        }
    }

    /// The tool went straight from one place to another, engraving.
    pub(crate) fn engraved(&mut self, from: Point2<f64>, to: Point2<f64>) {
        self.batch.push((from, to));
        if self.batch.len() == BATCH {
            self.look_up();
        }
    }

    pub(crate) fn finish(mut self) -> Deviation {
        self.look_up();
        let seen = self.nearest.iter().map(|nearest| nearest.min(self.reach));
        let missed = self.nearest.iter().zip(&self.lengths);
        Deviation {
            path_to_drawing_mm: self.worst,
            drawing_to_path_mm: seen.fold(0.0, f64::max),
            rms_mm: (self.squares / self.count.max(1.0)).sqrt(),
            missing_mm: missed
                .filter(|(nearest, _)| **nearest > self.reach)
                .map(|(_, length)| length)
                .sum(),
            reach_mm: self.reach,
        }
    }

    fn look_up(&mut self) {
        let Some((first, _)) = self.batch.first() else {
            return;
        };
        let (mut low, mut high) = (*first, *first);
        for (from, to) in &self.batch {
            low = low.inf(from).inf(to);
            high = high.sup(from).sup(to);
        }
        let around = nalgebra::Vector2::repeat(self.reach);
        let envelope = AABB::from_corners((low - around).into(), (high + around).into());
        let near: Vec<&Piece> = self.pieces.locate_in_envelope_intersecting(envelope).collect();
        for (from, to) in &self.batch {
            let mut off = f64::INFINITY;
            for piece in &near {
                off = off.min(distance_to_segment(*to, piece.from, piece.to));
                if let Some(nearest) = self.nearest.get_mut(piece.index) {
                    *nearest = nearest.min(distance_to_segment(piece.from, *from, *to));
                }
            }
            if off > self.reach {
                off = self.off_the_drawing(*to);
            }
            self.worst = self.worst.max(off);
            self.squares += off * off;
            self.count += 1.0;
        }
        self.batch.clear();
    }

    /// The distance where nothing of the drawing is within reach.
    fn off_the_drawing(&self, tool: Point2<f64>) -> f64 {
        self.pieces
            .nearest_neighbor(tool.into())
            .map_or(f64::INFINITY, |piece| distance_to_segment(tool, piece.from, piece.to))
    }
}

/// Pieces of a stroke; its end is a piece without length, so that it is looked at too.
fn cut_up(points: &[Point2<f64>], pieces: &mut Vec<Piece>) {
    let mut add = |from, to| {
        let index = pieces.len();
        pieces.push(Piece { from, to, index });
    };
    for (a, b) in points.iter().zip(points.iter().skip(1)) {
        let parts = ((b - a).norm() / PIECE_MM).ceil().max(1.0);
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
