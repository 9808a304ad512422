//! The picture of a run: drawing and engraved path by tool speed, the worst point enlarged, the
//! deviation along the path.

use known_load::{torque_chart, vibration_chart};
use machine_sim::{Axis, Colour, Figure, Mark, Plot, Stroke};
use nalgebra::Point2;

use crate::report::AXES;
use crate::simulation::Run;

/// Half the side of the enlarged square, in bounds.
const ENLARGED: f64 = 5.0;
const WORST: Colour = Colour::rgb(0, 125, 90);

impl Run {
    /// The drawing and the engraved path, as an SVG figure.
    #[must_use]
    pub fn picture(&self) -> Figure {
        let deviation = &self.deviation;
        let title = format!(
            "Engraved: {} strokes in {:.0} s",
            self.drawing.len(),
            self.duration_s
        );
        let note = format!(
            "The path of the simulated tool is within {:.3} mm of the drawing, {:.3} mm rms; the bound is {:.3} mm.",
            self.max_deviation_mm(),
            deviation.rms_mm,
            self.bound_mm
        );
        let mut figure = Figure::new(title)
            .with_note(note)
            .with_row(maps(self))
            .with_row([profile(self)]);
        let time = Axis::new("time in s").over(0.0..=self.duration_s);
        if let Some(used) = &self.torque {
            figure = figure.with_row([torque_chart(used, AXES, time)]);
        }
        if let Some(vibration) = &self.vibration {
            let chart = vibration_chart("the tool", vibration, self.unshaped.as_ref());
            figure = figure.with_row([chart]);
        }
        figure
    }
}

fn maps(run: &Run) -> Vec<Plot> {
    let [x, y] = ["x in mm", "y in mm"].map(Axis::new);
    let whole = drawn(run, Plot::map(x, y), true)
        .with_weight(2.2)
        .start(run.trace.start.into());
    let Some(at) = run.deviation.worst_at else {
        return vec![whole];
    };
    let half = run.bound_mm * ENLARGED;
    let [x, y] = ["x in mm", "y in mm"].map(Axis::new);
    let x = x.over(at.x - half..=at.x + half);
    let y = y.over(at.y - half..=at.y + half);
    let near = drawn(run, Plot::map(x, y), false)
        .with_title("Enlarged: largest deviation")
        .marks("", Mark::Ring, WORST, [at.into()]);
    let whole = whole.marks("largest deviation", Mark::Ring, WORST, [at.into()]);
    vec![whole, near]
}

/// The drawing, rapids, and the path by speed.
fn drawn(run: &Run, plot: Plot, is_explained: bool) -> Plot {
    let line = |points: &Vec<Point2<f64>>| -> Vec<[f64; 2]> {
        points.iter().copied().map(Into::into).collect()
    };
    let name = |name: &'static str| if is_explained { name } else { "" };
    let drawing = run.drawing.iter().map(line);
    let rapids = run.trace.travels.iter().map(line);
    let moved = run.trace.engraved.iter();
    let moved = moved.filter_map(|piece| Some((piece.speed_mm_s?, line(&piece.points))));
    plot.lines(name("drawing"), Stroke::COMMANDED, drawing)
        .lines(name("rapid, tool lifted"), Stroke::RAPID, rapids)
        .coloured(name("tool speed in mm/s"), 1.4, moved)
}

/// How far the path is from the drawing, over time.
fn profile(run: &Run) -> Plot {
    // The line is broken where the tool is lifted.
    let points = run.deviation_over_time();
    let points = points.map(|(seconds, max)| [seconds, max.unwrap_or(f64::NAN)]);
    let (bound, end) = (run.bound_mm, run.duration_s);
    Plot::chart(
        Axis::new("time in s").over(0.0..=end),
        Axis::new("distance in mm").including(0.0),
    )
    .with_title("Distance of the tool from the drawing")
    .line("max of each part of the time", Stroke::ACTUAL, points)
    .line("bound", Stroke::LIMIT, [[0.0, bound], [end, bound]])
}
