//! The motion of the body: axis by axis, its distance error, and before and after.

use machine_sim::{Axis, Colour, Figure, Mark, Plot, Stroke};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use pose_pt::Platform;

use crate::examination::{Examination, Moment};
use crate::machine::{Machine, isometry};
use crate::pose::Pose;
use crate::table::AxisState;

/// Points of a curve, at most: some for each pixel.
const CURVE: usize = 2000;
/// How far the drawn body moves at most, as a fraction of its size, and how far it turns.
const MAX_MOVE: f64 = 0.3;
const MAX_TURN_RAD: f64 = 0.5;
const BEFORE: Colour = Colour::rgb(90, 90, 90);
const AFTER: Colour = Colour::rgb(140, 29, 24);

/// Body before and after, axis positions and speeds, distance error.
pub(crate) fn align<const N: usize>(
    machine: &Machine,
    platform: &Platform<N>,
    examination: &Examination<N>,
    [from, to]: [Pose; 2],
    via: &[Pose],
    bound_mm: f64,
) -> Figure {
    let body = Body::new(machine, platform, [from, to], via);
    let factor = body.factor;
    let times = if factor > 1.0 {
        format!("{factor} times as large as it is")
    } else {
        "as large as it is".to_owned()
    };
    let end_s = examination.moments.last().map_or(1.0, |it| it.time_s);
    let mut figure = Figure::new(format!("Alignment: {N} locators in {end_s:.1} s"))
        .with_note(format!("The body's move is drawn {times}."))
        .with_row(body.views());
    for locator in 0..N {
        figure = figure.with_row([
            axes(examination, locator, end_s, "position", "mm", |it| {
                it.position
            }),
            axes(examination, locator, end_s, "speed", "mm/s", |it| it.speed),
        ]);
    }
    figure.with_row([distance_error(examination, end_s, bound_mm)])
}

/// The three axes of a locator over time.
fn axes<const N: usize>(
    examination: &Examination<N>,
    locator: usize,
    end_s: f64,
    quantity: &str,
    unit: &str,
    value: fn(&AxisState) -> f64,
) -> Plot {
    let moments = &examination.moments;
    let every = moments.len().div_ceil(CURVE).max(1);
    let time = Axis::new("time in s").over(0.0..=end_s);
    let name = Axis::new(format!("{quantity} in {unit}")).including(0.0);
    let chart = Plot::chart(time, name).with_title(format!("Locator {}: {quantity}", locator + 1));
    let letters = ["X", "Y", "Z"].into_iter().enumerate();
    letters.fold(chart, |chart, (axis, letter)| {
        let states = moments.iter().step_by(every).chain(moments.last());
        let points = states.filter_map(|moment| {
            let state = moment.states.get(locator)?.get(axis)?;
            Some([moment.time_s, value(state)])
        });
        chart.line(letter, Stroke::series(axis), points)
    })
}

fn distance_error<const N: usize>(examination: &Examination<N>, end_s: f64, bound_mm: f64) -> Plot {
    const UM_PER_MM: f64 = 1000.0;
    let moments = &examination.moments;
    // Of many moments the worst of each group.
    let groups = moments.chunks(moments.len().div_ceil(CURVE).max(1));
    let worst = groups.filter_map(|group| {
        let size = |moment: &&Moment<N>| moment.distance_error.abs();
        group.iter().max_by(|a, b| size(a).total_cmp(&size(b)))
    });
    let points = worst.map(|it| [it.time_s, it.distance_error * UM_PER_MM]);
    let bound = bound_mm * UM_PER_MM;
    let bounds = [bound, -bound].map(|bound| [[0.0, bound], [end_s, bound]]);
    let time = Axis::new("time in s").over(0.0..=end_s);
    Plot::chart(time, Axis::new("change in µm"))
        .with_title("Largest change of a distance between two locators")
        .lines("bound", Stroke::LIMIT, bounds)
        .line("simulated", Stroke::solid(AFTER, 0.9), points)
}

/// Outline and anchors, before and after a move that is exaggerated.
struct Body {
    outlines: [Vec<Point3<f64>>; 2],
    anchors: [Vec<Point3<f64>>; 2],
    /// The anchors at the poses between.
    via: Vec<Vec<Point3<f64>>>,
    factor: f64,
}

impl Body {
    fn new<const N: usize>(
        machine: &Machine,
        platform: &Platform<N>,
        ends: [Pose; 2],
        via: &[Pose],
    ) -> Self {
        let outline = machine.settings.outline();
        let anchors: Vec<_> = platform.locators().iter().map(|it| it.anchor).collect();
        let [from, to] = ends.map(isometry);
        let via: Vec<_> = via.iter().copied().map(isometry).collect();
        let placed = |points: &[Point3<f64>], pose: &Isometry3<f64>| -> Vec<Point3<f64>> {
            points.iter().map(|point| pose * point).collect()
        };
        let all = || outline.iter().chain(&anchors);
        let size = all().map(|it| it.coords.norm()).fold(0.0, f64::max);
        let turn_to = |to: &Isometry3<f64>| (to.rotation * from.rotation.inverse()).scaled_axis();
        let room = |to: &Isometry3<f64>| {
            let moves = all().map(|it| (to * it - from * it).norm());
            let max_move = moves.fold(0.0, f64::max);
            (MAX_MOVE * size / max_move).min(MAX_TURN_RAD / turn_to(to).norm())
        };
        let room = via.iter().chain([&to]).map(room);
        let factor = round_down(room.fold(f64::INFINITY, f64::min));
        // The same move, larger: the body stays rigid.
        let far = |to: &Isometry3<f64>| {
            Isometry3::from_parts(
                Translation3::from(
                    from.translation.vector
                        + factor * (to.translation.vector - from.translation.vector),
                ),
                UnitQuaternion::from_scaled_axis(factor * turn_to(to)) * from.rotation,
            )
        };
        let ends = [from, far(&to)];
        Self {
            outlines: ends.map(|pose| placed(&outline, &pose)),
            anchors: ends.map(|pose| placed(&anchors, &pose)),
            via: via
                .iter()
                .map(|pose| placed(&anchors, &far(pose)))
                .collect(),
            factor,
        }
    }

    fn views(&self) -> [Plot; 2] {
        let x = || Axis::new("x in mm");
        // From the front, a little from above: y goes away, z up.
        let tilt = Rotation3::from_axis_angle(&Vector3::x_axis(), -1.25);
        [
            self.view(Plot::map(x(), Axis::new("y in mm")), &Rotation3::identity())
                .with_title("From above"),
            self.view(Plot::map(x(), Axis::new("seen height in mm")), &tilt)
                .with_title("From the front, 18° from above"),
        ]
    }

    /// Turned for the eye.
    fn view(&self, plot: Plot, turn: &Rotation3<f64>) -> Plot {
        let seen = |points: &[Point3<f64>]| -> Vec<[f64; 2]> {
            let turned = points.iter().map(|point| turn * point);
            turned.map(|point| [point.x, point.y]).collect()
        };
        let closed = |points: &[Point3<f64>]| {
            let mut line = seen(points);
            line.extend(line.first().copied());
            line
        };
        let [before, after] = &self.outlines;
        let [held, moved] = self.anchors.each_ref().map(|it| seen(it));
        let via: Vec<_> = self.via.iter().map(|it| seen(it)).collect();
        let paths = held
            .iter()
            .zip(&moved)
            .enumerate()
            .map(|(anchor, (from, to))| {
                let between = via.iter().filter_map(move |it| it.get(anchor).copied());
                core::iter::once(*from).chain(between).chain([*to])
            });
        let plot = plot
            .line("before", Stroke::MACHINE, closed(before))
            .line("after", Stroke::solid(AFTER, 1.6), closed(after))
            .lines("", Stroke::RAPID, paths)
            .marks("", Mark::Dot, BEFORE, held.iter().copied())
            .marks("", Mark::Dot, BEFORE, via.iter().flatten().copied())
            .marks("locators", Mark::Dot, AFTER, moved);
        let names = (1..).zip(held);
        names.fold(plot, |plot, (number, at)| {
            plot.label(at, format!("{number}"))
        })
    }
}

/// The next of 1, 2, 5, 10, 20, ... that is not above a number; 1 below that and where nothing
/// moves.
fn round_down(max: f64) -> f64 {
    if !(max >= 1.0 && max.is_finite()) {
        return 1.0;
    }
    let decade = 10_f64.powf(max.log10().floor());
    let steps = [5.0, 2.0].into_iter();
    let step = steps.map(|step| step * decade).find(|step| *step <= max);
    step.unwrap_or(decade)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Locators;

    #[test]
    fn factors_are_round_and_never_below_one() {
        let factors = [0.3, 1.0, 1.9, 4.9, 5.0, 73.0, 1e3, f64::INFINITY, f64::NAN].map(round_down);
        let expected = [1.0, 1.0, 1.0, 2.0, 5.0, 50.0, 1e3, 1.0, 1.0];
        assert_eq!(factors.map(f64::to_bits), expected.map(f64::to_bits));
    }

    /// What is drawn larger is the move; distances on the body stay what they are.
    #[test]
    fn the_drawn_body_is_rigid() {
        let machine = Machine::parse(crate::PLATFORM).unwrap();
        let Locators::Three(platform) = &machine.locators else {
            panic!("three locators");
        };
        let from = [0.0, 0.0, 1200.0, 0.0, 0.0, 0.0];
        let to = [35.0, -20.0, 1240.0, 1.2, -0.8, 2.5];
        let body = Body::new(&machine, platform, [from, to], &[]);
        assert_eq!(body.factor.to_bits(), 5.0_f64.to_bits());
        let [before, after] = body.outlines.each_ref().map(|points| {
            let next = points.iter().cycle().skip(1);
            let lengths = points.iter().zip(next).map(|(a, b)| (b - a).norm());
            lengths.collect::<Vec<_>>()
        });
        let differs = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-9;
        assert!(!before.iter().zip(&after).any(differs));
        let still = Body::new(&machine, platform, [from, from], &[]);
        assert_eq!(still.factor.to_bits(), 1.0_f64.to_bits());
        // A pose between is seen as large as the last one would be.
        let back = Body::new(&machine, platform, [from, from], &[to]);
        assert_eq!(back.factor.to_bits(), body.factor.to_bits());
    }
}
