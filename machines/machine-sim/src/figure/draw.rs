//! Draws a figure.

use svg::Document;
use svg::node::element::{
    Circle, ClipPath, Definitions, Group, Line, Path, Rectangle, Text, Title,
};

use super::frame::{BELOW_PX, Frame, text_px};
use super::look::{Colour, FONT, GRID, INK, Mark, Stroke};
use super::path::path_data;
use super::plot::{Layer, Plot, Point, Sample};

const WIDTH_PX: f64 = 960.0;
const MARGIN_PX: f64 = 20.0;
/// Between two plots.
const GAP_PX: f64 = 18.0;
const TITLE_PX: f64 = 19.0;
const HEADING_PX: f64 = 14.0;
const TEXT_PX: f64 = 12.0;
/// From one line of text to the next.
const LINE_PX: f64 = 18.0;
/// A sample in a legend, and the room after it.
const SAMPLE_PX: f64 = 26.0;
const SCALE_PX: f64 = 90.0;

/// The whole document.
pub(super) fn document(title: &str, notes: &[String], rows: &[Vec<Plot>]) -> Document {
    let mut body = Group::new();
    let mut y = MARGIN_PX + TITLE_PX;
    body = body.add(text([MARGIN_PX, y], TITLE_PX, "start", title).set("font-weight", "600"));
    for note in notes {
        y += LINE_PX;
        body = body.add(text([MARGIN_PX, y], TEXT_PX, "start", note));
    }
    y += GAP_PX;
    let mut clips = Definitions::new();
    let mut number = 0;
    // Charts that stand alone share their horizontal axis, mostly time.
    let alone = rows.iter().filter_map(|plots| match &plots[..] {
        [plot] if !plot.is_map => Some(Frame::numbers_px(plot)),
        _ => None,
    });
    let numbers_px = alone.fold(0.0, f64::max);
    for plots in rows {
        let weights: f64 = plots.iter().map(|plot| plot.weight).sum();
        let gaps = plots.iter().skip(1).fold(0.0, |sum, _| sum + GAP_PX);
        let width = WIDTH_PX - 2.0 * MARGIN_PX - gaps;
        let cells: Vec<_> = plots
            .iter()
            .map(|plot| {
                let shared = if plots.len() == 1 && !plot.is_map {
                    numbers_px
                } else {
                    0.0
                };
                Cell::new(plot, width * plot.weight / weights, shared)
            })
            .collect();
        // The frames of a row begin at one height.
        let head = cells.iter().map(Cell::head_px).fold(0.0, f64::max);
        let mut x = MARGIN_PX;
        let mut bottom = y;
        for cell in cells {
            let next = x + cell.width + GAP_PX;
            number += 1;
            let clip = format!("plot-{number}");
            let (frame, drawn) = cell.draw([x, y], head, &clip);
            let window = rectangle(&frame);
            clips = clips.add(ClipPath::new().set("id", clip).add(window));
            bottom = bottom.max(frame.bottom + BELOW_PX);
            body = body.add(drawn);
            x = next;
        }
        y = bottom + GAP_PX;
    }
    let height = y.ceil();
    Document::new()
        .set("width", WIDTH_PX)
        .set("height", height)
        .set("viewBox", format!("0 0 {WIDTH_PX} {height}"))
        .set("font-family", FONT)
        .add(Title::new(title))
        .add(clips)
        .add(
            Rectangle::new()
                .set("width", "100%")
                .set("height", "100%")
                .set("fill", "white"),
        )
        .add(body)
}

/// A plot and the width it has.
struct Cell<'a> {
    plot: &'a Plot,
    width: f64,
    /// The legend's entries, row by row, with their left ends.
    legend: Vec<Vec<(f64, &'a (Sample, String))>>,
    frame: Frame,
}

impl<'a> Cell<'a> {
    fn new(plot: &'a Plot, width: f64, numbers_px: f64) -> Self {
        let frame = Frame::new(plot, width, numbers_px);
        let room = width - frame.left;
        let mut legend: Vec<Vec<_>> = Vec::new();
        let mut x = f64::INFINITY;
        for entry in &plot.legend {
            let (sample, name) = entry;
            let wide = sample_px(sample) + text_px(name, TEXT_PX) + 20.0;
            if x + wide > room {
                legend.push(Vec::new());
                x = 0.0;
            }
            if let Some(row) = legend.last_mut() {
                row.push((x, entry));
            }
            x += wide;
        }
        Self {
            plot,
            width,
            legend,
            frame,
        }
    }

    /// Room above the frame.
    fn head_px(&self) -> f64 {
        let title = if self.plot.title.is_empty() {
            0.0
        } else {
            LINE_PX + 2.0
        };
        let legend = self.legend.iter().fold(0.0, |sum, _| sum + LINE_PX);
        title + legend + 6.0
    }

    fn draw(self, [x, y]: Point, head: f64, clip: &str) -> (Frame, Group) {
        let Self { plot, legend, .. } = self;
        let frame = self.frame.moved(x, y + head);
        let mut group = Group::new();
        let mut line = y + HEADING_PX;
        if !plot.title.is_empty() {
            let heading = text([frame.left, line], HEADING_PX, "start", &plot.title);
            group = group.add(heading.set("font-weight", "600"));
            line += LINE_PX + 2.0;
        }
        for row in legend {
            for (offset, (sample, name)) in row {
                group = entry(group, [frame.left + offset, line], sample, name);
            }
            line += LINE_PX;
        }
        group = axes(group, plot, &frame);
        let mut data = Group::new()
            .set("clip-path", format!("url(#{clip})"))
            .set("fill", "none")
            .set("stroke-linecap", "round")
            .set("stroke-linejoin", "round");
        for layer in &plot.layers {
            data = match layer {
                Layer::Lines(stroke, lines) => {
                    let path = path_data(lines, &frame, plot.is_map);
                    data.add(stroked(Path::new().set("d", path), *stroke))
                }
                Layer::Marks(mark, colour, points) => points.iter().fold(data, |data, at| {
                    self::mark(data, frame.at(*at), *mark, *colour)
                }),
                Layer::Label(at, name) => {
                    let [x, y] = frame.at(*at);
                    data.add(text([x + 7.0, y - 5.0], TEXT_PX, "start", name))
                }
            };
        }
        group = group.add(data);
        let border = rectangle(&frame).set("fill", "none").set("stroke", INK);
        let group = group.add(border.set("stroke-width", 0.8));
        (frame, group)
    }
}

fn sample_px(sample: &Sample) -> f64 {
    match sample {
        Sample::Line(_) => SAMPLE_PX + 6.0,
        Sample::Mark(..) => 18.0,
        Sample::Scale(ends) => {
            let numbers = ends_of_scale(*ends);
            let numbers = numbers.iter().map(|number| text_px(number, TEXT_PX));
            SCALE_PX + 18.0 + numbers.sum::<f64>()
        }
    }
}

/// An entry of a legend: a sample, and what it means.
fn entry(group: Group, [x, y]: Point, sample: &Sample, name: &str) -> Group {
    let middle = y - TEXT_PX * 0.36;
    let named = text([x + sample_px(sample), y], TEXT_PX, "start", name);
    match *sample {
        Sample::Line(stroke) => {
            let line = Path::new().set("d", format!("M{x:.1} {middle:.1}h{SAMPLE_PX}"));
            group.add(stroked(line.set("fill", "none"), stroke))
        }
        Sample::Mark(kind, colour) => mark(group, [x + 7.0, middle], kind, colour),
        Sample::Scale(ends) => {
            let [low, high] = ends_of_scale(ends);
            let left = x + text_px(&low, TEXT_PX) + 6.0;
            let steps = 15_u32;
            let width = SCALE_PX / f64::from(steps + 1);
            let bars = (0..=steps).fold(group, |group, k| {
                let colour = Colour::of_scale(f64::from(k) / f64::from(steps));
                let bar = Rectangle::new()
                    .set("x", round(left + width * f64::from(k)))
                    .set("y", round(middle - 4.0))
                    .set("width", round(width + 0.3))
                    .set("height", 8)
                    .set("fill", colour.css());
                group.add(bar)
            });
            let right = left + SCALE_PX + 6.0;
            bars.add(text([x, y], TEXT_PX, "start", &low)).add(text(
                [right, y],
                TEXT_PX,
                "start",
                &high,
            ))
        }
    }
    .add(named)
}

/// Grid, numbers and names of both axes.
fn axes(mut group: Group, plot: &Plot, frame: &Frame) -> Group {
    let [x_ticks, y_ticks] = &frame.ticks;
    let line = |from: Point, to: Point| {
        Line::new()
            .set("x1", round(from[0]))
            .set("y1", round(from[1]))
            .set("x2", round(to[0]))
            .set("y2", round(to[1]))
            .set("stroke", GRID)
    };
    for (value, number) in x_ticks {
        let [x, _] = frame.at([*value, 0.0]);
        group = group.add(line([x, frame.top], [x, frame.bottom])).add(text(
            [x, frame.bottom + 15.0],
            TEXT_PX,
            "middle",
            number,
        ));
    }
    for (value, number) in y_ticks {
        let [_, y] = frame.at([0.0, *value]);
        group = group.add(line([frame.left, y], [frame.right, y])).add(text(
            [frame.left - 6.0, y + 4.0],
            TEXT_PX,
            "end",
            number,
        ));
    }
    let [x_name, y_name] = plot.axes.each_ref().map(|axis| axis.name.as_str());
    let middle = [f64::midpoint(frame.left, frame.right), frame.bottom + 33.0];
    let widest = y_ticks.iter().map(|(_, number)| text_px(number, TEXT_PX));
    let beside = frame.left - 14.0 - widest.fold(0.0, f64::max);
    let height = f64::midpoint(frame.top, frame.bottom);
    let turned = format!("translate({beside:.1} {height:.1}) rotate(-90)");
    group
        .add(text(middle, TEXT_PX, "middle", x_name))
        .add(text([0.0, 0.0], TEXT_PX, "middle", y_name).set("transform", turned))
}

fn mark(group: Group, [x, y]: Point, mark: Mark, colour: Colour) -> Group {
    let circle = |r: f64| {
        Circle::new()
            .set("cx", round(x))
            .set("cy", round(y))
            .set("r", r)
    };
    let ring = |r: f64| {
        let ring = circle(r).set("fill", "none").set("stroke", colour.css());
        ring.set("stroke-width", 1.6)
    };
    let dot = |r: f64| circle(r).set("fill", colour.css());
    match mark {
        Mark::Dot => group.add(dot(2.6)),
        Mark::Ring => group.add(ring(6.5)),
        Mark::Start => group.add(ring(5.5)).add(dot(2.0)),
    }
}

fn text([x, y]: Point, size: f64, anchor: &str, content: &str) -> Text {
    // XML has no place for control characters, not even escaped.
    let content = content.replace(char::is_control, " ");
    Text::new(content)
        .set("x", round(x))
        .set("y", round(y))
        .set("font-size", size)
        .set("text-anchor", anchor)
        .set("fill", INK)
}

fn rectangle(frame: &Frame) -> Rectangle {
    Rectangle::new()
        .set("x", round(frame.left))
        .set("y", round(frame.top))
        .set("width", round(frame.width()))
        .set("height", round(frame.height()))
}

fn stroked(path: Path, stroke: Stroke) -> Path {
    let path = path
        .set("stroke", stroke.colour.css())
        .set("stroke-width", stroke.width_px);
    if stroke.is_dashed {
        path.set("stroke-dasharray", "5 3.5")
            .set("stroke-linecap", "butt")
    } else {
        path
    }
}

fn round(px: f64) -> f64 {
    (px * 100.0).round() / 100.0
}

/// The numbers at the ends of a scale, in three digits; 0 where that is nothing beside the other
/// end.
fn ends_of_scale(ends: [f64; 2]) -> [String; 2] {
    /// Half of the last digit of the other end.
    const NOTHING: f64 = 0.0005;
    let [low, high] = ends.map(f64::abs);
    ends.map(|end| {
        if end.abs() <= NOTHING * low.max(high) {
            "0".to_owned()
        } else {
            short(end)
        }
    })
}

/// A number in three digits.
fn short(value: f64) -> String {
    let decimals = 2.0 - value.abs().max(1e-9).log10().floor();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped"
    )]
    let decimals = decimals.clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_that_is_nothing_beside_the_other_is_0() {
        for (ends, wanted) in [
            ([1e-12, 8.46], ["0", "8.46"]),
            ([0.0, 123.4], ["0", "123"]),
            ([-1e-13, 0.05], ["0", "0.0500"]),
            ([-20.0, 0.001], ["-20.0", "0"]),
            ([0.02, 8.0], ["0.0200", "8.00"]),
            ([0.0, 0.0], ["0", "0"]),
        ] {
            assert_eq!(ends_of_scale(ends), wanted, "{ends:?}");
        }
    }
}
