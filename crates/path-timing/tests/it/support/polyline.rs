//! Lines of a polar arm through points, with corners.

use core::convert::Infallible;
use core::f64::consts::TAU;
use core::fmt::Debug;

use path_timing::{Accuracy, Corner, Curve, Path, PathFn, Smoothed, ToolLimits, Vertex};
use proptest::prelude::*;

use crate::support::machine::Line;

/// Lines through all points, with the same corner between them, a stop at the end, and a feed.
pub(crate) fn lines<'a>(
    points: &'a [[f64; 2]],
    corner: Corner<[f64; 2]>,
    feed: Option<f64>,
) -> Vec<impl Path<Axes = [f64; 2], Error = Infallible> + Clone + Debug + use<'a>> {
    let line = |ends: &[[f64; 2]]| {
        let line = Line {
            from: ends[0],
            to: ends[1],
        };
        let path = PathFn::new(line.length(), move |s| line.point(s)).with_corner(corner);
        match feed {
            Some(feed) => path.with_tool(ToolLimits {
                feed,
                acceleration: None,
            }),
            None => path,
        }
    };
    let mut lines: Vec<_> = points.windows(2).map(line).collect();
    if let Some(last) = lines.pop() {
        lines.push(last.with_corner(Corner::Stop));
    }
    lines
}

/// A departure, and any time.
pub(crate) const fn within(min_segments: u32, max_departure: f64) -> Accuracy {
    Accuracy {
        min_segments,
        max_departure,
        max_time_ratio: f64::INFINITY,
    }
}

/// The curves of a smoothed polyline.
pub(crate) fn smoothed<const D: usize>(points: &[[f64; D]], tolerance: f64) -> Vec<Curve<D>> {
    let mut memory = [Vertex::default(); 32];
    let curves = Smoothed::new(points.iter().copied(), tolerance, &mut memory);
    curves.unwrap().collect::<Result<_, _>>().unwrap()
}

/// Points of a polyline whose sides are not too short.
pub(crate) fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let point = prop::array::uniform2(-100.0..100.0_f64);
    prop::collection::vec(point, 3..7).prop_filter("sides", |points| {
        points.windows(2).all(|pair| {
            let [from, to] = pair else { unreachable!() };
            (to[0] - from[0]).hypot(to[1] - from[1]) > 1.0
        })
    })
}

/// A circle of 40 mm as points with three decimals.
pub(crate) fn circle(step_mm: f64) -> Vec<[f64; 2]> {
    let count = (TAU * 40.0 / step_mm).round();
    let mut points = Vec::new();
    let mut number = 0.0;
    while number <= count {
        let (sin, cos) = (TAU * number / count).sin_cos();
        points.push([cos, sin].map(|x| (x * 40_000.0).round() / 1000.0));
        number += 1.0;
    }
    points
}
