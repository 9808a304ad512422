//! Where a plot's frame is in the picture, and how its axes are scaled.

use super::axis::ticks;
use super::plot::{Plot, Point};

/// Room for the numbers and the name of the x axis.
pub(super) const BELOW_PX: f64 = 42.0;
/// Room for the name of the y axis, without its numbers.
const BESIDE_PX: f64 = 30.0;
const RIGHT_PX: f64 = 14.0;
/// Between two ticks at least.
const TICKS_PX: [f64; 2] = [62.0, 30.0];
/// Mean width of a character, as a fraction of the font's size.
const CHARACTER: f64 = 0.58;

/// Estimated width of a text.
pub(super) fn text_px(text: &str, font_px: f64) -> f64 {
    text.chars()
        .fold(0.0, |width, _| width + CHARACTER * font_px)
}

/// A plot's frame: `left`, `top`, `right`, `bottom` in the picture, and the ends of its axes.
#[derive(Debug)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
    ends: [[f64; 2]; 2],
    pub(super) ticks: [Vec<(f64, String)>; 2],
}

impl Frame {
    /// The frame of a plot in a cell of this width, with its top at 0 and its left at the cell's.
    ///
    /// Its numbers have at least `numbers_px` beside it, so that charts below each other share
    /// their horizontal axis.
    pub(super) fn new(plot: &Plot, cell_px: f64, numbers_px: f64) -> Self {
        let [x_axis, y_axis] = &plot.axes;
        let ends = [
            x_axis.ends(plot.coordinates(0)),
            y_axis.ends(plot.coordinates(1)),
        ];
        let [[x0, x1], [y0, y1]] = ends;
        let y_ticks = |height: f64| ticks([y0, y1], height / TICKS_PX[1]);
        let left = BESIDE_PX + numbers_px.max(Self::numbers_px(plot));
        let mut width = cell_px - left - RIGHT_PX;
        let mut height = plot.height_px;
        if plot.is_map {
            let scale = (width / (x1 - x0)).min(height / (y1 - y0));
            (width, height) = (scale * (x1 - x0), scale * (y1 - y0));
        }
        Self {
            left,
            top: 0.0,
            right: left + width,
            bottom: height,
            ends,
            ticks: [ticks([x0, x1], width / TICKS_PX[0]), y_ticks(height)],
        }
    }

    /// The width of the widest number beside the frame. It depends on the height, which for a map
    /// depends on the width.
    pub(super) fn numbers_px(plot: &Plot) -> f64 {
        let [_, y_axis] = &plot.axes;
        let ends = y_axis.ends(plot.coordinates(1));
        ticks(ends, plot.height_px / TICKS_PX[1])
            .iter()
            .map(|(_, text)| text_px(text, 12.0))
            .fold(0.0, f64::max)
    }

    /// The same frame elsewhere.
    pub(super) fn moved(self, x: f64, y: f64) -> Self {
        Self {
            left: self.left + x,
            right: self.right + x,
            top: self.top + y,
            bottom: self.bottom + y,
            ..self
        }
    }

    pub(super) const fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) const fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// A point in the picture.
    pub(super) fn at(&self, [x, y]: Point) -> Point {
        let [[x0, x1], [y0, y1]] = self.ends;
        [
            self.left + (x - x0) / (x1 - x0) * self.width(),
            self.bottom - (y - y0) / (y1 - y0) * self.height(),
        ]
    }

    /// Whether a line between two points of the picture is certainly outside.
    pub(super) fn is_beside(&self, a: Point, b: Point) -> bool {
        let ([ax, ay], [bx, by]) = (a, b);
        ax.max(bx) < self.left
            || ax.min(bx) > self.right
            || ay.max(by) < self.top
            || ay.min(by) > self.bottom
    }
}
