//! The pictures: the staircase of the wheel, and the motion of the body.

use std::io::Write;

use anyhow::Result;
use nalgebra::{Point3, Rotation3, Vector3};
use plotters::prelude::*;
use pose2pulse::handwheel::{SAMPLE, Settings};
use pose2pulse::pose_pt::Platform;

use crate::chart::{Area, COLOURS, INK, colour, curve, failed, frame, legend, range, stairs};
use crate::drives::{Examination, Moment};
use crate::table::positions;
use crate::world::Jog;

/// Points of a curve, at most: twice the width of the picture.
const CURVE: usize = 2000;
/// Locators whose axes all find room in a legend.
const NAMED: usize = 4;
const BEFORE: RGBColor = RGBColor(150, 150, 150);

/// Wheel counts, and the speeds they become.
pub(crate) fn jog(jog: &Jog, settings: &Settings, mut out: impl Write) -> Result<()> {
    // A wheel turned so little that no axis is told to move is shown all the same.
    let turned = jog.samples.iter().filter(|(_, counts)| *counts != 0);
    let mut moments: Vec<_> = jog.told.iter().map(|(t, _)| *t).collect();
    if moments.is_empty() {
        moments.extend(turned.map(|(t, _)| *t));
    }
    let start = moments.first().copied().unwrap_or_default();
    let end = moments.last().copied().unwrap_or_default();
    let span = start - 0.4..end + 0.6;
    let inside = |t: f64| span.contains(&t);
    // Counts of a sample belong to the time before its end.
    let sample_s = SAMPLE.as_secs_f64();
    let counts: Vec<_> = jog.samples.iter().filter(|(t, _)| inside(*t)).collect();
    let turned: Vec<_> = counts
        .iter()
        .map(|(t, n)| (t - sample_s, f64::from(*n)))
        .collect();
    let level = f64::from(settings.wheel.max()) / f64::from(2 * u32::from(settings.wheel.bins()));
    let quantised = |n: i32| f64::from(settings.wheel.level(n)) * level;
    let binned: Vec<_> = counts
        .iter()
        .map(|(t, n)| (t - sample_s, quantised(*n)))
        .collect();
    let told = &jog.told;
    let done: Vec<_> = jog
        .done
        .iter()
        .copied()
        .filter(|(t, _)| inside(*t))
        .collect();

    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (1000, 720)).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (upper, lower) = root.split_vertically(360);
        let time = "time / s";
        let values = turned.iter().map(|(_, n)| *n);
        let mut chart = frame(
            &upper,
            "Wheel: counts in 200 ms, and the bin they fall into",
            (time, span.clone()),
            ("counts per sample", range(values)),
        )?;
        curve(
            &mut chart,
            "counted",
            BEFORE.stroke_width(2),
            stairs(&turned),
        )?;
        curve(
            &mut chart,
            "quantised f(n)",
            colour(0).stroke_width(2),
            stairs(&binned),
        )?;
        legend(&mut chart, SeriesLabelPosition::UpperRight)?;

        let speeds = told.iter().chain(&done).map(|(_, speed)| *speed);
        let axis = ["X", "Y", "Z"].get(jog.axis).copied().unwrap_or_default();
        let mut chart = frame(
            &lower,
            &format!("Locator {}, axis {axis}: speed", jog.locator + 1),
            (time, span.clone()),
            ("speed / (mm/s)", range(speeds)),
        )?;
        curve(
            &mut chart,
            "told by the panel",
            colour(0).stroke_width(2),
            stairs(told),
        )?;
        curve(&mut chart, "axis", colour(1).stroke_width(2), done)?;
        legend(&mut chart, SeriesLabelPosition::UpperRight)?;
        root.present().map_err(failed)?;
    }
    Ok(out.write_all(svg.as_bytes())?)
}

/// Axis positions and speeds, strain, and the body before and after.
pub(crate) fn align<const N: usize>(
    examination: &Examination<N>,
    platform: &Platform<N>,
    bound_mm: f64,
    body: &[Vec<Point3<f64>>; 2],
    mut out: impl Write,
) -> Result<()> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (1000, 1500)).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (positions, rest) = root.split_vertically(350);
        let (speeds, rest) = rest.split_vertically(350);
        let (strain, views) = rest.split_vertically(270);
        axes(&positions, examination, Quantity::Position)?;
        axes(&speeds, examination, Quantity::Speed)?;
        strain_chart(&strain, examination, bound_mm)?;
        let (above, beside) = views.split_horizontally(500);
        let anchors = body_anchors(examination, platform);
        view(
            &above,
            "From above",
            ["x / mm", "y / mm"],
            &Rotation3::identity(),
            body,
            &anchors,
        )?;
        // From the front, a little from above: y goes away, z up.
        let tilt = Rotation3::from_axis_angle(&Vector3::x_axis(), -1.25);
        view(
            &beside,
            "From the front, 18 deg from above",
            ["x / mm", "height in the picture / mm"],
            &tilt,
            body,
            &anchors,
        )?;
        root.present().map_err(failed)?;
    }
    Ok(out.write_all(svg.as_bytes())?)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Position,
    Speed,
}

/// All axes of all locators in one frame.
fn axes<const N: usize>(
    area: &Area<'_>,
    examination: &Examination<N>,
    quantity: Quantity,
) -> Result<()> {
    let moments = &examination.moments;
    let every = moments.len().div_ceil(CURVE).max(1);
    let of = |locator: usize, axis: usize| -> Vec<(f64, f64)> {
        let states = moments.iter().step_by(every).chain(moments.last());
        states
            .filter_map(|moment| {
                let state = moment.states.get(locator)?.get(axis)?;
                Some(match quantity {
                    Quantity::Position => (moment.time_s, state.position),
                    Quantity::Speed => (moment.time_s, state.speed),
                })
            })
            .collect()
    };
    let all: Vec<_> = (0..N)
        .flat_map(|locator| (0..3).map(move |axis| (locator, axis)))
        .map(|(locator, axis)| (locator, axis, of(locator, axis)))
        .collect();
    let (title, name) = match quantity {
        Quantity::Position => ("Axis positions", "position / mm"),
        Quantity::Speed => ("Axis speeds", "speed / (mm/s)"),
    };
    let values = all.iter().flat_map(|(_, _, points)| points).map(|it| it.1);
    let end = moments.last().map_or(1.0, |moment| moment.time_s);
    // Room for the legend on the right.
    let mut chart = frame(
        area,
        title,
        ("time / s", 0.0..end * 1.16),
        (name, range(values)),
    )?;
    for (locator, axis, points) in all {
        let letter = ["X", "Y", "Z"].get(axis).copied().unwrap_or_default();
        // A colour for each locator, a shade for each axis.
        let shade = 1.0 - 0.3 * [0.0, 1.0, 2.0].get(axis).copied().unwrap_or_default();
        let style = colour(locator).mix(shade).stroke_width(2);
        let number = locator + 1;
        let name = match axis {
            _ if N <= NAMED => format!("{number}{letter}"),
            0 => format!("{number} X Y Z"),
            _ => String::new(),
        };
        curve(&mut chart, &name, style, points)?;
    }
    legend(&mut chart, SeriesLabelPosition::MiddleRight)
}

fn strain_chart<const N: usize>(
    area: &Area<'_>,
    examination: &Examination<N>,
    bound_mm: f64,
) -> Result<()> {
    const UM: f64 = 1000.0;
    let moments = &examination.moments;
    // Of many moments the worst of each group.
    let groups = moments.chunks(moments.len().div_ceil(CURVE).max(1));
    let worst = groups.filter_map(|group| {
        let size = |moment: &&Moment<N>| moment.strain.abs();
        group.iter().max_by(|a, b| size(a).total_cmp(&size(b)))
    });
    let points: Vec<_> = worst.map(|it| (it.time_s, it.strain * UM)).collect();
    let end = moments.last().map_or(1.0, |moment| moment.time_s);
    let bound = bound_mm * UM;
    let values = points.iter().map(|it| it.1).chain([0.0, -bound, bound]);
    let mut chart = frame(
        area,
        "Strain: worst change of a distance between two locators",
        ("time / s", 0.0..end * 1.16),
        ("change / um", range(values)),
    )?;
    for (name, bound) in [("bound", bound), ("", -bound)] {
        let line = [(0.0, bound), (end, bound)];
        curve(&mut chart, name, COLOURS[1].stroke_width(1), line)?;
    }
    curve(&mut chart, "strain", colour(0).stroke_width(1), points)?;
    legend(&mut chart, SeriesLabelPosition::MiddleRight)
}

/// Where the locators hold the body at both ends of the motion.
fn body_anchors<const N: usize>(
    examination: &Examination<N>,
    platform: &Platform<N>,
) -> [Vec<Point3<f64>>; 2] {
    let moments = &examination.moments;
    [moments.first(), moments.last()].map(|moment| {
        let axes = moment.map(|moment| positions(&moment.states));
        axes.map_or(Vec::new(), |axes| {
            platform.locator_positions(&axes).to_vec()
        })
    })
}

/// The body before and after, turned for the eye.
fn view(
    area: &Area<'_>,
    title: &str,
    [x, y]: [&str; 2],
    turn: &Rotation3<f64>,
    body: &[Vec<Point3<f64>>; 2],
    anchors: &[Vec<Point3<f64>>; 2],
) -> Result<()> {
    let seen = |points: &[Point3<f64>]| -> Vec<(f64, f64)> {
        let turned = points.iter().map(|point| turn * point);
        turned.map(|point| (point.x, point.y)).collect()
    };
    let all: Vec<_> = body.iter().chain(anchors).flat_map(|it| seen(it)).collect();
    let (xs, ys) = (
        range(all.iter().map(|it| it.0)),
        range(all.iter().map(|it| it.1)),
    );
    let (xs, ys) = same_scale(area, xs, ys);
    let mut chart = frame(area, title, (x, xs), (y, ys))?;
    let looks = [("before", BEFORE), ("after", colour(0))];
    for (((name, colour), outline), anchors) in looks.into_iter().zip(body).zip(anchors) {
        let mut closed = seen(outline);
        closed.extend(closed.first().copied());
        curve(&mut chart, name, colour.stroke_width(2), closed)?;
        let dots = seen(anchors).into_iter();
        chart
            .draw_series(dots.map(|it| Circle::new(it, 5, colour.filled())))
            .map_err(failed)?;
    }
    for (number, place) in (1..).zip(anchors.first().map_or(Vec::new(), |it| seen(it))) {
        let style = ("sans-serif", 14).into_font().color(&INK);
        let name = Text::new(format!("locator {number}"), (12, 8), style);
        let text = EmptyElement::at(place) + name;
        chart.draw_series([text]).map_err(failed)?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// Widens one of two ranges until a millimetre is as long in both.
fn same_scale(
    area: &Area<'_>,
    x: core::ops::Range<f64>,
    y: core::ops::Range<f64>,
) -> (core::ops::Range<f64>, core::ops::Range<f64>) {
    // What frames leave of an area for the drawing.
    const BESIDE: f64 = 110.0;
    const ABOVE: f64 = 95.0;
    let (width, height) = area.dim_in_pixel();
    let (width, height) = (f64::from(width) - BESIDE, f64::from(height) - ABOVE);
    let scale = ((x.end - x.start) / width).max((y.end - y.start) / height);
    let around = |range: core::ops::Range<f64>, pixels: f64| {
        let (middle, half) = (f64::midpoint(range.start, range.end), scale * pixels / 2.0);
        middle - half..middle + half
    };
    (around(x, width), around(y, height))
}
