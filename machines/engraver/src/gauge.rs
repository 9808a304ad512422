//! How far the tool's path is from the drawing, and the drawing from the path.

use kurbo::BezPath;
use machine_sim::Profile;
use nalgebra::{Point2, Vector2};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

use crate::drawing::flatten;

/// The drawing is measured as lines that are within this fraction of the tolerance.
const FINE: f64 = 0.01;

/// The drawing is measured in pieces no longer than this, in mm, nor than this fraction of the
/// reach: a gap as wide as the bound shows on fine machines too.
const PIECE_MM: f64 = 0.2;
const PIECE_FRACTION: f64 = 0.25;

/// Moves that are looked up together.
const BATCH: usize = 8;

/// Distance of `p` from the straight line between `a` and `b`.
pub(crate) fn distance_to_segment(p: Point2<f64>, a: Point2<f64>, b: Point2<f64>) -> f64 {
    Segment::new(a, b).distance_2(p).sqrt()
}

/// A straight line between two points, ready to be asked for distances.
#[derive(Clone, Copy)]
struct Segment {
    from: Point2<f64>,
    span: Vector2<f64>,
    /// One over the length squared; 0 for a point.
    per_length_2: f64,
}

impl Segment {
    fn new(from: Point2<f64>, to: Point2<f64>) -> Self {
        let span = to - from;
        let length_2 = span.norm_squared();
        Self {
            from,
            span,
            per_length_2: if length_2 > 0.0 {
                length_2.recip()
            } else {
                0.0
            },
        }
    }

    fn to(&self) -> Point2<f64> {
        self.from + self.span
    }

    fn distance_2(&self, p: Point2<f64>) -> f64 {
        let off = p - self.from;
        let along = (off.dot(&self.span) * self.per_length_2).clamp(0.0, 1.0);
        (off - self.span * along).norm_squared()
    }
}

/// Deviations of a whole drawing, in mm.
#[derive(Debug, Clone)]
pub(crate) struct Deviation {
    pub(crate) path_to_drawing_mm: f64,
    /// A point to which the path never came within the gauge's reach counts as that far.
    pub(crate) drawing_to_path_mm: f64,
    pub(crate) rms_mm: f64,
    /// Length of the drawing to which the path never came within the gauge's reach.
    pub(crate) missing_mm: f64,
    /// Where the path is farthest from the drawing.
    pub(crate) worst_at: Option<Point2<f64>>,
    /// Max distance of the path from the drawing over time, in timer ticks.
    pub(crate) profile: Profile,
}

/// A short straight piece of the drawing.
struct DrawnSegment {
    line: Segment,
    index: usize,
}

impl RTreeObject for DrawnSegment {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.line.from.into(), self.line.to().into())
    }
}

impl PointDistance for DrawnSegment {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        self.line.distance_2((*point).into())
    }
}

/// Compares a path, move by move, with a drawing.
pub(crate) struct Gauge {
    pieces: RTree<DrawnSegment>,
    lengths: Vec<f64>,
    /// Squared distance of the path from the beginning of each piece, as far as seen.
    nearest_2: Vec<f64>,
    /// How far around the path the drawing is looked for.
    reach: f64,
    batch: Vec<Step>,
    worst_2: f64,
    worst_at: Option<Point2<f64>>,
    squares: f64,
    count: f64,
    profile: Profile,
}

/// A move of the tool.
#[derive(Clone, Copy)]
struct Step {
    line: Segment,
    ticks: u64,
}

impl Gauge {
    /// A gauge for `outlines` in mm that tells distances of up to `reach` apart, to a hundredth of
    /// `tolerance`.
    pub(crate) fn new(outlines: &[BezPath], tolerance: f64, reach: f64) -> Self {
        let longest = PIECE_MM.min(reach * PIECE_FRACTION);
        let mut pieces = Vec::new();
        for outline in outlines {
            cut_up(&flatten(outline, tolerance * FINE), longest, &mut pieces);
        }
        Self {
            lengths: pieces.iter().map(|piece| piece.line.span.norm()).collect(),
            nearest_2: vec![f64::INFINITY; pieces.len()],
            pieces: RTree::bulk_load(pieces),
            reach,
            batch: Vec::with_capacity(BATCH),
            worst_2: 0.0,
            worst_at: None,
            squares: 0.0,
            count: 0.0,
            profile: Profile::new(),
        }
    }

    /// The tool went straight from one point to another, engraving, at a time.
    pub(crate) fn engraved(&mut self, from: Point2<f64>, to: Point2<f64>, ticks: u64) {
        // A new stroke may be far away: not one box around both.
        let last = self.batch.last();
        let goes_on = last.is_none_or(|last| last.line.to() == from);
        if !goes_on || self.batch.len() == BATCH {
            self.look_up();
        }
        let line = Segment::new(from, to);
        self.batch.push(Step { line, ticks });
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
            worst_at: self.worst_at,
            profile: self.profile,
        }
    }

    fn look_up(&mut self) {
        let Some(first) = self.batch.first() else {
            return;
        };
        let (mut low, mut high) = (first.line.from, first.line.from);
        for step in &self.batch {
            low = low.inf(&step.line.to());
            high = high.sup(&step.line.to());
        }
        let around = Vector2::repeat(self.reach);
        let envelope = AABB::from_corners((low - around).into(), (high + around).into());
        let near: Vec<&DrawnSegment> = self
            .pieces
            .locate_in_envelope_intersecting(envelope)
            .collect();
        let mut distances_2 = [f64::INFINITY; BATCH];
        for (step, distance_2) in self.batch.iter().zip(&mut distances_2) {
            for piece in &near {
                *distance_2 = distance_2.min(piece.line.distance_2(step.line.to()));
                if let Some(nearest_2) = self.nearest_2.get_mut(piece.index) {
                    *nearest_2 = nearest_2.min(step.line.distance_2(piece.line.from));
                }
            }
        }
        let mut batch = core::mem::take(&mut self.batch);
        for (step, distance_2) in batch.drain(..).zip(distances_2) {
            self.note(&step, distance_2);
        }
        self.batch = batch;
    }

    /// Notes how far the end of a step is from what is near of the drawing, squared.
    fn note(&mut self, step: &Step, near_2: f64) {
        let tool = step.line.to();
        let distance_2 = if near_2 > self.reach * self.reach {
            self.off_the_drawing(tool)
        } else {
            near_2
        };
        if distance_2 > self.worst_2 {
            (self.worst_2, self.worst_at) = (distance_2, Some(tool));
        }
        self.squares += distance_2;
        self.count += 1.0;
        self.profile.add(step.ticks, distance_2.sqrt());
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
fn cut_up(points: &[Point2<f64>], longest: f64, pieces: &mut Vec<DrawnSegment>) {
    let mut add = |from, to| {
        let index = pieces.len();
        let line = Segment::new(from, to);
        pieces.push(DrawnSegment { line, index });
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
