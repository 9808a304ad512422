//! The path of the simulated tool, thinned for pictures.

use nalgebra::Point2;

/// A line of the path in the glass.
#[derive(Debug, Clone)]
pub(crate) struct EngravedLine {
    /// In mm; the first is the last of the line before, if that is of the same stroke.
    pub(crate) points: Vec<Point2<f64>>,
    /// Mean speed in mm/s, where the arms move.
    pub(crate) speed_mm_s: Option<f64>,
}

/// The path: in the glass by records, above it by travels.
#[derive(Debug, Clone)]
pub(crate) struct ToolTrace {
    /// Where the tool is at home.
    pub(crate) start: Point2<f64>,
    pub(crate) engraved: Vec<EngravedLine>,
    pub(crate) travels: Vec<Vec<Point2<f64>>>,
    /// Points nearer to each other are one.
    spacing_mm: f64,
    /// In the glass since the record began, or above it since it was lifted.
    open: Vec<Point2<f64>>,
    in_glass: bool,
}

impl ToolTrace {
    pub(crate) fn new(start: Point2<f64>, spacing_mm: f64) -> Self {
        Self {
            start,
            engraved: Vec::new(),
            travels: Vec::new(),
            spacing_mm,
            open: vec![start],
            in_glass: false,
        }
    }

    /// The tool is at a point, in the glass or above it.
    pub(crate) fn at(&mut self, tool: Point2<f64>, in_glass: bool) {
        if in_glass != self.in_glass {
            self.end_travel();
            self.open = vec![tool];
            self.in_glass = in_glass;
            return;
        }
        let last = self.open.last();
        if last.is_none_or(|last| (tool - last).norm() >= self.spacing_mm) {
            self.open.push(tool);
        }
    }

    /// A record is done, with the tool at a point.
    pub(crate) fn record(&mut self, tool: Point2<f64>, speed_mm_s: Option<f64>) {
        if !self.in_glass {
            return;
        }
        let mut points = core::mem::replace(&mut self.open, vec![tool]);
        if points.last() != Some(&tool) {
            points.push(tool);
        }
        self.engraved.push(EngravedLine { points, speed_mm_s });
    }

    /// The run is over.
    pub(crate) fn finish(&mut self, tool: Point2<f64>) {
        if !self.in_glass {
            self.open.push(tool);
            self.end_travel();
        }
    }

    fn end_travel(&mut self) {
        let points = core::mem::take(&mut self.open);
        if !self.in_glass && points.len() > 1 {
            self.travels.push(points);
        }
    }
}
