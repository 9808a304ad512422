//! What a plot shows, before it is drawn.

use super::axis::Axis;
use super::look::{Colour, Mark, Stroke};

/// A point in the units of both axes; a line is broken where a number is not finite.
pub type Point = [f64; 2];

/// Classes of a colour scale.
const CLASSES: u32 = 16;

/// What is drawn, from below to above.
#[derive(Debug, Clone)]
pub(super) enum Layer {
    Lines(Stroke, Vec<Vec<Point>>),
    Marks(Mark, Colour, Vec<Point>),
    Label(Point, String),
}

/// An entry of the legend.
#[derive(Debug, Clone)]
pub(super) enum Sample {
    Line(Stroke),
    Mark(Mark, Colour),
    /// The values at both ends of the colour scale.
    Scale([f64; 2]),
}

/// A frame with two axes: a map, on which a millimetre is as long in both, or a chart.
#[derive(Debug, Clone)]
pub struct Plot {
    pub(super) axes: [Axis; 2],
    pub(super) is_map: bool,
    pub(super) title: String,
    pub(super) height_px: f64,
    pub(super) weight: f64,
    pub(super) layers: Vec<Layer>,
    pub(super) legend: Vec<(Sample, String)>,
}

impl Plot {
    /// A chart: each axis with its own scale, 180 px high.
    #[must_use]
    pub const fn chart(x: Axis, y: Axis) -> Self {
        Self::new(x, y, false, 180.0)
    }

    /// A map: one scale for both axes, at most 620 px high.
    #[must_use]
    pub const fn map(x: Axis, y: Axis) -> Self {
        Self::new(x, y, true, 620.0)
    }

    const fn new(x: Axis, y: Axis, is_map: bool, height_px: f64) -> Self {
        Self {
            axes: [x, y],
            is_map,
            title: String::new(),
            height_px,
            weight: 1.0,
            layers: Vec::new(),
            legend: Vec::new(),
        }
    }

    /// The same under a title.
    #[must_use]
    pub fn with_title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// The same with another height of the frame; of a map, the max height.
    #[must_use]
    pub const fn with_height(mut self, px: f64) -> Self {
        self.height_px = px;
        self
    }

    /// The same with another part of its row's width than the other plots.
    #[must_use]
    pub const fn with_weight(mut self, weight: f64) -> Self {
        self.weight = weight;
        self
    }

    /// A line through points; without a name it is not in the legend.
    #[must_use]
    pub fn line(self, name: &str, stroke: Stroke, points: impl IntoIterator<Item = Point>) -> Self {
        self.lines(name, stroke, [points])
    }

    /// Lines of one kind.
    #[must_use]
    pub fn lines<L: IntoIterator<Item = Point>>(
        mut self,
        name: &str,
        stroke: Stroke,
        lines: impl IntoIterator<Item = L>,
    ) -> Self {
        let lines = lines.into_iter().map(|line| line.into_iter().collect());
        self.layers.push(Layer::Lines(stroke, lines.collect()));
        self.explain(Sample::Line(stroke), name)
    }

    /// Lines coloured by a value of each; the name ends in the value's unit.
    #[must_use]
    pub fn coloured<L: IntoIterator<Item = Point>>(
        mut self,
        name: &str,
        width_px: f64,
        lines: impl IntoIterator<Item = (f64, L)>,
    ) -> Self {
        let lines: Vec<(f64, Vec<Point>)> = lines
            .into_iter()
            .map(|(value, line)| (value, line.into_iter().collect()))
            .collect();
        let values = lines.iter().map(|(value, _)| *value);
        let low = values.clone().fold(f64::INFINITY, f64::min);
        let high = values.fold(f64::NEG_INFINITY, f64::max);
        let last = f64::from(CLASSES - 1);
        let class = |value: f64| ((value - low) / (high - low) * last).round();
        for number in 0..CLASSES {
            let number = f64::from(number);
            let of_class = lines.iter().filter(|(value, _)| {
                let class = class(*value);
                // All values are one.
                let class = if class.is_nan() { 0.0 } else { class };
                (class - number).abs() < 0.5
            });
            let of_class: Vec<_> = of_class.map(|(_, line)| line.clone()).collect();
            if !of_class.is_empty() {
                let stroke = Stroke::solid(Colour::of_scale(number / last), width_px);
                self.layers.push(Layer::Lines(stroke, of_class));
            }
        }
        if low <= high {
            self.explain(Sample::Scale([low, high]), name)
        } else {
            self
        }
    }

    /// Signs at points; without a name they are not in the legend.
    #[must_use]
    pub fn marks(
        mut self,
        name: &str,
        mark: Mark,
        colour: Colour,
        points: impl IntoIterator<Item = Point>,
    ) -> Self {
        let points = points.into_iter().collect();
        self.layers.push(Layer::Marks(mark, colour, points));
        self.explain(Sample::Mark(mark, colour), name)
    }

    /// The sign where a path begins.
    #[must_use]
    pub fn start(self, at: Point) -> Self {
        self.marks("start", Mark::Start, Colour::rgb(0, 125, 90), [at])
    }

    /// A text beside a point.
    #[must_use]
    pub fn label(mut self, at: Point, text: impl Into<String>) -> Self {
        self.layers.push(Layer::Label(at, text.into()));
        self
    }

    fn explain(mut self, sample: Sample, name: &str) -> Self {
        if !name.is_empty() {
            self.legend.push((sample, name.to_owned()));
        }
        self
    }

    /// All points, for the range of an axis.
    pub(super) fn coordinates(&self, axis: usize) -> impl Iterator<Item = f64> {
        let points = self.layers.iter().flat_map(|layer| match layer {
            Layer::Lines(_, lines) => lines.iter().map(Vec::as_slice).collect(),
            Layer::Marks(_, _, points) => vec![points.as_slice()],
            Layer::Label(at, _) => vec![core::slice::from_ref(at)],
        });
        let finite = |[x, y]: &&Point| x.is_finite() && y.is_finite();
        points
            .flatten()
            .filter(finite)
            .filter_map(move |point| point.get(axis).copied())
    }
}
