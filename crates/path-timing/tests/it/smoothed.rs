//! Smoothed polylines: within the tolerance both ways, without a step of direction, and as fast as
//! the curve that the points were taken from.

use core::f64::consts::TAU;

use path_timing::{
    AxisLimits, Curve, CurveError, Knot, LookAhead, Smoothed, Table, ToolLimits, Vertex, Waypoint,
};
use proptest::prelude::*;

use crate::support::polyline::{circle, smoothed};
use crate::support::vectors::{bits, dot, norm, sub};

/// Of some products of coordinates up to 1000, and of directions.
const ROUNDING: f64 = 1e-9;

/// What chords of a 24th of a hump cut off of it, as a part of its departure: |D| h / 8 · 24²
/// of |D| h / 6.
const CHORDS: f64 = 6.0 / (8.0 * 24.0 * 24.0);

/// The distance of a point from a line between two others.
fn distance<const D: usize>(point: [f64; D], from: [f64; D], to: [f64; D]) -> f64 {
    let edge = sub(to, from);
    let length = dot(edge, edge);
    let part = if length > 0.0 {
        (dot(sub(point, from), edge) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    norm(sub(
        point,
        core::array::from_fn(|i| from[i] + edge[i] * part),
    ))
}

/// The most by which places on the curves are off a polyline, and its points off the places.
fn off<const D: usize>(curves: &[Curve<D>], points: &[[f64; D]]) -> f64 {
    const PLACES: u32 = 24;
    let places: Vec<_> = curves
        .iter()
        .flat_map(|curve| {
            (0..=PLACES).map(|n| curve.at(curve.length() * f64::from(n) / f64::from(PLACES)))
        })
        .map(|at| at.point)
        .collect();
    let from_polyline = places.iter().map(|place| {
        let edges = points
            .windows(2)
            .map(|edge| distance(*place, edge[0], edge[1]));
        edges.fold(f64::INFINITY, f64::min)
    });
    let from_places = points.iter().map(|point| {
        let chords = places
            .windows(2)
            .map(|pair| distance(*point, pair[0], pair[1]));
        chords.fold(f64::INFINITY, f64::min)
    });
    from_polyline.chain(from_places).fold(0.0, f64::max)
}

/// Whether the curves join to the last bit and have the same direction there, but for stops.
fn check_joined<const D: usize>(curves: &[Curve<D>], stops: usize) {
    let steps = curves.windows(2).filter(|pair| {
        assert_eq!(bits(pair[0].end()), bits(pair[1].start()));
        let (before, after) = (pair[0].at(pair[0].length()), pair[1].at(0.0));
        norm(sub(before.tangent, after.tangent)) > ROUNDING
    });
    assert_eq!(steps.count(), stops);
}

/// Corners of all angles: a line, two cubics, a line; all of the tolerance but a thirty-second is
/// used, and the curvature is continuous.
#[test]
fn a_corner_alone_is_two_cubics() {
    const TOLERANCE: f64 = 0.1;
    for turn in 3..=169 {
        let (sin, cos) = f64::from(turn).to_radians().sin_cos();
        let points = [[0.0, 0.0], [20.0, 0.0], [20.0 + 20.0 * cos, 20.0 * sin]];
        let curves = smoothed(&points, TOLERANCE);
        assert_eq!(curves.len(), 4, "{turn} deg");
        check_joined(&curves, 0);
        for pair in curves.windows(2) {
            let (before, after) = (pair[0].at(pair[0].length()), pair[1].at(0.0));
            let scale = 1.0 + norm(before.curvature);
            assert!(norm(sub(before.curvature, after.curvature)) < ROUNDING * scale);
        }
        let off = off(&curves, &points);
        assert!(
            off <= TOLERANCE && off > 0.96 * TOLERANCE,
            "{turn} deg: {off}"
        );
    }
}

/// Eight densities, three tolerances, with the largest time over the arc's for each: 5 mm apart the
/// polygon has corners of 7 deg, which 0.01 mm do not round.
#[test]
fn circles_of_points_take_the_time_of_the_arc() {
    const TOOL: ToolLimits = ToolLimits {
        feed: 300.0,
        acceleration: None,
    };
    const AXIS: AxisLimits = AxisLimits {
        speed: 1000.0,
        acceleration: 3000.0,
        jerk: None,
    };
    const LARGEST: [(f64, [f64; 3]); 8] = [
        (0.05, [1.002; 3]),
        (0.1, [1.002; 3]),
        (0.2, [1.002; 3]),
        (0.3, [1.002; 3]),
        (0.5, [1.002; 3]),
        (1.0, [1.002; 3]),
        (2.0, [1.03, 1.002, 1.002]),
        (5.0, [2.05, 1.6, 1.15]),
    ];
    let arc = Curve::arc([40.0, 0.0], [0.0, 0.0], [0.0, 1.0], TAU).unwrap();
    let mut knots = vec![Knot::default(); 500];
    let table = Table::plan([arc.with_tool(TOOL)], [AXIS; 2], |_| 400, &mut knots).unwrap();
    let best_s = table.duration_s();
    for (step_mm, largest) in LARGEST {
        let points = circle(step_mm);
        for (tolerance, largest) in [0.01, 0.02, 0.05].into_iter().zip(largest) {
            let mut memory = [Vertex::default(); 24];
            let waypoints = points.iter().map(|point| Waypoint {
                point: *point,
                tool: Some(TOOL),
            });
            let mut curves = Smoothed::new(waypoints, tolerance, &mut memory).unwrap();
            let list: Vec<_> = curves.by_ref().map(Result::unwrap).collect();
            let departure = curves.departure();
            let worst = list.iter().map(|curve| {
                let [first, last] = curve.between().unwrap();
                let near = first.saturating_sub(20)..(last + 20).min(points.len());
                let places = (0..8).map(|n| curve.at(curve.length() * f64::from(n) / 8.0).point);
                let distances = places.map(|place| {
                    let edges = points[near.clone()].windows(2);
                    let each = edges.map(|edge| distance(place, edge[0], edge[1]));
                    each.fold(f64::INFINITY, f64::min)
                });
                distances.fold(0.0, f64::max)
            });
            let worst = worst.fold(0.0, f64::max);
            assert!(worst <= departure && departure <= tolerance);
            let mut window = [Knot::default(); 128];
            // Half a millimetre a segment: what changes of speed take.
            let segments = |curve: &Curve<2>| {
                let halves = (1..20_u32).find(|count| f64::from(*count) > curve.length() * 2.0);
                Ok(halves.unwrap())
            };
            let rows = LookAhead::new(list, [AXIS; 2], segments, &mut window).unwrap();
            let rows: Vec<_> = rows.map(Result::unwrap).collect();
            let ratio = rows.last().unwrap().time_s / best_s;
            println!(
                "{step_mm} mm within {tolerance}: {ratio:.4} of the arc's time, {} rows for {} points, {worst:.4} off",
                rows.len(),
                points.len(),
            );
            assert!(ratio < largest, "{step_mm} mm within {tolerance}: {ratio}");
        }
    }
}

/// Points at the same place, and a rounding apart, have no part in it.
#[test]
fn points_that_coincide_are_one() {
    let plain = [[0.0, 0.0], [20.0, 0.0], [30.0, 10.0], [40.0, 10.0]];
    let mut shaken = Vec::new();
    for [x, y] in plain {
        let wobble = [[0.0, 0.0], [1e-9, 0.0], [-1e-9, 1e-9], [0.0, 0.0]];
        shaken.extend(wobble.map(|[dx, dy]| [x + dx, y + dy]));
    }
    let (curves, plain_curves) = (smoothed(&shaken, 0.01), smoothed(&plain, 0.01));
    assert_eq!(curves.len(), plain_curves.len());
    check_joined(&curves, 0);
    assert_eq!(bits(curves.last().unwrap().end()), bits(plain[3]));
    let length = |curves: &[Curve<2>]| curves.iter().map(Curve::length).sum::<f64>();
    assert!((length(&curves) - length(&plain_curves)).abs() < 0.01);
    assert!(off(&curves, &shaken) <= 0.01);
    assert!(smoothed(&[[1.0, 1.0]], 0.1).is_empty());
    assert!(smoothed(&[[1.0, 1.0]; 3], 0.1).is_empty());
    assert!(smoothed::<2>(&[], 0.1).is_empty());
}

/// A last point beside the one before by what rounding makes of it: it was refused as a curve that
/// has no direction.
#[test]
fn a_last_point_beside_the_one_before_is_the_end() {
    for tolerance in [0.0, 1e-12, 0.01] {
        for last in [[10.0, 20.0 + 1e-14], [10.0 - 2e-15, 20.0], [10.0, 20.0]] {
            let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 20.0], last];
            let curves = smoothed(&points, tolerance);
            check_joined(&curves, if tolerance < 0.01 { 1 } else { 0 });
            let curve = curves.last().unwrap();
            assert_eq!(bits(curve.end()), bits(last));
        }
    }
}

/// Straight back is a stop; so are turns above what is asked for, and all with no tolerance.
#[test]
fn sharp_corners_are_stops() {
    let spike = [[0.0, 0.0], [20.0, 0.0], [10.0, 0.0], [10.0, 20.0]];
    let curves = smoothed(&spike, 0.1);
    check_joined(&curves, 1);
    assert_eq!(bits(curves[0].end()), bits(spike[1]));
    let mut memory = [Vertex::default(); 8];
    let curves = Smoothed::new(spike, 0.1, &mut memory).unwrap();
    let curves: Result<Vec<_>, _> = curves.with_stops_above(1.0).collect();
    check_joined(&curves.unwrap(), 2);
    let curves = smoothed(&spike, 0.0);
    assert_eq!(curves.len(), 3);
    check_joined(&curves, 2);
    assert!(off(&curves, &spike) < ROUNDING);
}

/// Each curve has the tool of its move, from the point on where it begins; and knows its points.
#[test]
fn feeds_change_at_their_points() {
    let feeds = [10.0, 10.0, 30.0, 20.0, 20.0];
    let points = (0..6_u32).map(|n| [f64::from(n), f64::from(n % 2) * 0.2]);
    let waypoints = points
        .zip([10.0].into_iter().chain(feeds))
        .map(|(point, feed)| Waypoint {
            point,
            tool: Some(ToolLimits {
                feed,
                acceleration: None,
            }),
        });
    let mut memory = [Vertex::default(); 8];
    let curves = Smoothed::new(waypoints, 0.05, &mut memory).unwrap();
    let (mut edges, mut before) = (0, 0.0);
    for curve in curves {
        let curve = curve.unwrap();
        let [first, last] = curve.between().unwrap();
        let feed = curve.tool().unwrap().feed;
        for edge in &feeds[first..last] {
            let faster = curve.speed_error();
            let given = feed * (1.0 + faster);
            assert!((edge / given - 1.0).abs() < ROUNDING && faster < 0.01);
        }
        assert!(first < last && last >= edges);
        (edges, before) = (last, before + curve.length());
    }
    assert_eq!(edges, 5);
    assert!((before - 5.0 * 1.04_f64.sqrt()).abs() < ROUNDING);
}

/// Where the feed changes on the way straight on, and at vertices whose humps end in one another.
#[test]
fn every_change_of_feed_is_passed() {
    let straight = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [5.0, 0.0]];
    let stairs = [[0.0, 0.0], [0.0, -0.2], [-0.2, -0.2], [-0.2, -0.4]];
    for (points, tolerance) in [(straight, 0.0), (straight, 0.01), (stairs, 1.0)] {
        let feeds = [10.0, 30.0, 10.0, 20.0];
        let waypoints = points.into_iter().zip(feeds).map(|(point, feed)| Waypoint {
            point,
            tool: Some(ToolLimits {
                feed,
                acceleration: None,
            }),
        });
        let mut memory = [Vertex::default(); 6];
        let curves = Smoothed::new(waypoints, tolerance, &mut memory).unwrap();
        let curves: Vec<_> = curves.map(Result::unwrap).collect();
        // The last edge of the stairs is a curve and the line that it ends with.
        let passed = curves.iter().map(|curve| curve.between().unwrap());
        let mut passed: Vec<_> = passed.collect();
        passed.dedup();
        assert_eq!(passed, [[0, 1], [1, 2], [2, 3]]);
        check_joined(&curves, 0);
        assert_eq!(bits(curves.last().unwrap().end()), bits(points[3]));
    }
}

/// What is not a number ends the polyline: the points before are done.
#[test]
fn errors_come_after_what_is_good() {
    let points = [
        [0.0, 0.0],
        [1.0, 0.0],
        [2.0, 1.0],
        [f64::NAN, 0.0],
        [5.0, 5.0],
    ];
    let mut memory = [Vertex::default(); 8];
    let mut curves = Smoothed::new(points, 0.1, &mut memory).unwrap();
    let good: Vec<_> = curves.by_ref().map_while(Result::ok).collect();
    assert_eq!(bits(good.last().unwrap().end()), bits(points[2]));
    assert!(curves.next().is_none());
    let mut curves = Smoothed::new(points, 0.1, &mut memory).unwrap();
    let all: Vec<_> = curves.by_ref().collect();
    assert_eq!(all.last(), Some(&Err(CurveError::NotFinite)));
    for tolerance in [-1.0, f64::NAN, f64::INFINITY, 1e-60] {
        let refused = Smoothed::new(points, tolerance, &mut memory).map(|_| ());
        assert!(matches!(refused, Err(CurveError::Tolerance { .. })));
    }
    let refused = Smoothed::new(points, 0.1, &mut memory[..5]).map(|_| ());
    assert!(matches!(
        refused,
        Err(CurveError::Memory {
            needed: 6,
            available: 5
        })
    ));
}

/// Memory that is full where a wide hump is decided: those behind it are not so narrow that it
/// still reaches where they are over.
#[test]
fn a_wide_hump_is_not_lost_where_memory_ends() {
    let points = [
        ([0.0, 0.0], 30.0),
        ([2.66, -2.29], 30.0),
        ([2.66, -2.08], 20.0),
        ([2.64, -2.05], 30.0),
        ([2.62, -2.03], 10.0),
        ([-2.72, -2.03], 30.0),
        ([-2.72, -1.96], 10.0),
        ([-2.89, -1.82], 30.0),
    ];
    let waypoints = points.map(|(point, feed)| Waypoint {
        point,
        tool: Some(ToolLimits {
            feed,
            acceleration: None,
        }),
    });
    check_kept(&waypoints, 2.011_654_649_908_407, 7);
}

/// Points of a random walk: turns of all angles, steps of all lengths.
fn walk() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let step = (-4.0..1.5_f64, -3.0..3.0_f64, -1.0..1.0_f64);
    prop::collection::vec(step, 1..60).prop_map(|steps| {
        let (mut at, mut heading) = ([0.0; 3], 0.0_f64);
        let mut points = vec![at];
        for (length, turn, rise) in steps {
            heading += turn.powi(3) / 9.0;
            let length = 10.0_f64.powf(length);
            let step = [heading.cos(), heading.sin(), rise].map(|x| x * length);
            at = core::array::from_fn(|i| at[i] + step[i]);
            points.push(at);
        }
        points
    })
}

/// Points of a program with few decimals: many coincide, lines go straight back, and each may have
/// a feed of its own.
fn grid() -> impl Strategy<Value = Vec<Waypoint<2>>> {
    let step = prop_oneof![
        (-3..=3_i32, -3..=3_i32),
        (-1..=1_i32, Just(0)),
        (-600..=600_i32, -500..=500_i32),
    ];
    let feed = prop_oneof![4 => Just(30.0), 1 => Just(10.0), 1 => Just(20.0)];
    let steps = prop::collection::vec((step, feed), 1..60);
    (steps, 0..4_i32).prop_map(|(steps, decimals)| {
        let unit = 10.0_f64.powi(decimals);
        let mut at = [0, 0];
        let mut points = vec![[0.0, 0.0].into()];
        for ((dx, dy), feed) in steps {
            at = [at[0] + dx, at[1] + dy];
            points.push(Waypoint {
                point: at.map(|x| f64::from(x) / unit),
                tool: Some(ToolLimits {
                    feed,
                    acceleration: None,
                }),
            });
        }
        points
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// In any memory: ends exact, joined, within the tolerance both ways, and the bound is kept.
    #[test]
    fn any_polyline_is_kept_within_its_tolerance(
        points in walk(), tolerance in -4.0..0.5_f64, memory in 6..40_usize,
    ) {
        let points: Vec<_> = points.into_iter().map(Waypoint::from).collect();
        check_kept(&points, 10.0_f64.powf(tolerance), memory);
    }

    /// So are points that coincide and lines that go back, with other feeds on the way.
    #[test]
    fn any_points_on_a_grid_are_kept_within_their_tolerance(
        points in grid(), tolerance in prop_oneof![Just(0.0), (-4.0..0.5_f64).prop_map(|x| 10.0_f64.powf(x))],
        memory in 6..40_usize,
    ) {
        check_kept(&points, tolerance, memory);
    }
}

fn check_kept<const D: usize>(waypoints: &[Waypoint<D>], tolerance: f64, memory: usize) {
    let points: Vec<_> = waypoints.iter().map(|waypoint| waypoint.point).collect();
    let mut memory = vec![Vertex::default(); memory];
    let mut curves = Smoothed::new(waypoints.iter().copied(), tolerance, &mut memory).unwrap();
    let list: Result<Vec<Curve<D>>, _> = curves.by_ref().collect();
    let list = list.unwrap();
    let departure = curves.departure();
    let last = *points.last().unwrap();
    assert!(
        departure <= tolerance * (1.0 + ROUNDING),
        "{departure} of {tolerance}"
    );
    let Some(end) = list.last() else {
        let far = points.iter().map(|point| norm(sub(*point, points[0])));
        assert!(far.fold(0.0, f64::max) <= tolerance);
        return;
    };
    assert_eq!(bits(list[0].start()), bits(points[0]));
    assert_eq!(bits(end.end()), bits(last));
    for pair in list.windows(2) {
        assert_eq!(bits(pair[0].end()), bits(pair[1].start()));
    }
    let off = off(&list, &points);
    let most = departure * (1.0 + CHORDS) + ROUNDING;
    assert!(off <= most, "{off} of {departure}");
    for curve in &list {
        assert!(curve.speed_error() < 0.25, "{}", curve.speed_error());
    }
}
