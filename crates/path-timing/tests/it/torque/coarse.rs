//! Segments too long for their torques to be known.

use delta_kin::{DeltaMasses, DeltaPath};
use path_timing::{
    Accuracy, Corner, Curve, Dynamics, Friction, Knot, PlanError, Row, Span, ToolLimits,
    TorqueCurve, TorqueLimits,
};
use scara_kin::{ArmPath, Elbow};
use test_support::{Random, setting};

use super::streams::{end_s, streamed};
use super::{FREE, WITHIN, arm, constant, delta, limits, stepper};
use crate::support::polyline::{smoothed, within};

/// What is known of a segment from rest to rest was not known at each pair of speeds: tables were
/// refused, and streams rested at its knots.
#[test]
fn coarse_segments_of_a_delta_are_halved() {
    let (delta, limits) = delta();
    let curve = Curve::line([-60.0, 20.0, -280.0], [60.0, -10.0, -250.0]).unwrap();
    let path = delta.path(curve).unwrap();
    let mut knots = vec![Knot::default(); 401];
    let mut planned = |segments: u32| {
        let table = limits.plan([path], [FREE; 3], |_| segments, &mut knots);
        table.unwrap().duration_s()
    };
    let fine_s = planned(400);
    for segments in 3..24 {
        let table_s = planned(segments);
        let stream_s = end_s(&streamed(&limits, &[path], segments, 128, &[]));
        println!(
            "{segments}: {:.3} {:.3}",
            table_s / fine_s,
            stream_s / fine_s
        );
        assert!(table_s < fine_s * COARSER && stream_s < fine_s * COARSER);
    }
}

/// A segment whose torques could not be bounded was left none of them for good: up to 6.3 times
/// the time of fine ones.
#[test]
fn few_segments_of_a_smooth_path_are_not_slow() {
    let (delta, _) = delta();
    let masses = DeltaMasses {
        arm_kg_m2: 4e-3,
        arm_kg_m: 0.018,
        rods_kg: 0.1,
        platform_kg: 1.0,
        payload_kg: 1.4,
        ..DeltaMasses::default()
    };
    let limits = TorqueLimits {
        dynamics: delta.dynamics(1e-3, masses).unwrap(),
        motors: [TorqueCurve::constant(10.0, 10.0).unwrap(); 3],
    };
    let mut random = Random::new(setting("SEED", 2));
    let mut knots = vec![Knot::default(); 20_000];
    let turns = [
        [[6, 8, -248], [5, 10, -246], [11, -1, -246], [0, 11, -242]],
        [
            [-10, -11, -233],
            [-8, -19, -236],
            [0, -18, -231],
            [-12, -30, -231],
        ],
    ];
    let turns = turns.map(|places| places.map(|place| place.map(f64::from)));
    let random = (0..setting("PATHS", 10)).map(|_| {
        let mut place = [0.0, 0.0, -240.0];
        [(); 4].map(|()| {
            place = place.map(|at| at + random.within(-12.0, 12.0));
            place
        })
    });
    for places in turns.into_iter().chain(random) {
        let curves = smoothed(&places, 0.05);
        let paths = curves.iter().map(|curve| delta.path(*curve).unwrap());
        let departure = |path: &DeltaPath, span: &Span<_>| path.departure(span);
        let coarse = limits.plan_within(
            paths.clone(),
            [FREE; 3],
            within(1, 0.04),
            departure,
            &mut knots,
        );
        let coarse_s = coarse.unwrap().duration_s();
        let fine = limits.plan(paths, [FREE; 3], |_| 200, &mut knots);
        let ratio = coarse_s / fine.unwrap().duration_s();
        assert!(ratio <= SLOW, "{ratio} on {places:?}");
    }
}

/// What the longest segments that are accepted cost: up to 1.37 on 3,000 paths.
const SLOW: f64 = 1.6;

/// What few segments cost at most, as a part of the time.
const COARSER: f64 = 1.05;

/// Masses of 1 whose torques are known on segments with a rest alone.
struct Unforeseen;

impl Dynamics for Unforeseen {
    type Axes = [f64; 2];

    fn torques(&self, _: &[f64; 2], _: &[f64; 2], acceleration: &[f64; 2]) -> [f64; 2] {
        *acceleration
    }

    fn friction(&self) -> [Friction; 2] {
        [Friction::default(); 2]
    }

    fn bend(&self, span: &Span<[f64; 2]>) -> [f64; 2] {
        let rests = span.rows.iter().any(Row::is_at_rest);
        [if rests { 0.0 } else { f64::INFINITY }; 2]
    }
}

#[test]
fn torques_that_stay_unknown_are_refused_with_their_place() {
    let motors = [TorqueCurve::constant(10.0, 30.0).unwrap(); 2];
    let limits = TorqueLimits {
        dynamics: Unforeseen,
        motors,
    };
    let line = Curve::line([0.0, 0.0], [3.0, 4.0]).unwrap();
    let mut knots = [Knot::default(); 20];
    let refused = limits.plan([line], [FREE; 2], |_| 10, &mut knots);
    // The first segment begins at rest.
    let Some(PlanError::TooCoarse { leg: 0, s }) = refused.as_ref().err() else {
        panic!("{refused:?}");
    };
    assert!(*s > 0.0 && *s < 1.0, "{s}");
}

/// Two lines in a row, with feeds.
fn lines(places: [[f64; 2]; 3], feeds: [f64; 2]) -> Option<[ArmPath; 2]> {
    let [from, via, to] = places;
    let path = |[from, to]: [[f64; 2]; 2], feed| {
        let tool = ToolLimits {
            feed,
            acceleration: None,
        };
        let curve = Curve::line(from, to).ok()?.with_tool(tool);
        let path = arm().path(curve, Elbow::Right).ok()?;
        Some(path.with_corner(Corner::Smooth))
    };
    Some([path([from, via], feeds[0])?, path([via, to], feeds[1])?])
}

/// On one segment a line cannot go fast that has to be slow at its end.
#[test]
fn a_line_that_one_segment_makes_slow_is_refused() {
    let limits = limits(1.0, constant());
    let places = [[200.0, 300.0], [230.0, 300.0], [250.0, 300.0]];
    let lines = lines(places, [1000.0, 10.0]).unwrap();
    let mut knots = [Knot::default(); 100];
    let mut planned = |segments| {
        let table = limits.plan(lines, [FREE; 2], |_| segments, &mut knots);
        table.map(|table| table.duration_s())
    };
    let refused = planned(1);
    assert!(
        matches!(refused, Err(PlanError::TooCoarse { leg: 0, .. })),
        "{refused:?}"
    );
    let two_s = planned(2).unwrap();
    assert!(two_s <= planned(40).unwrap() * 3.0, "{two_s}");
}

/// Few segments, and what is asked for of their time.
#[test]
fn times_are_within_their_ratio() {
    let mut random = Random::new(setting("SEED", 5));
    let mut knots = vec![Knot::default(); 8000];
    let mut rows = 0;
    for _ in 0..setting("PATHS", 20) {
        let mut place = || [random.within(-300.0, 300.0), random.within(120.0, 450.0)];
        let places = [place(), place(), place()];
        let feeds = [(); 2].map(|()| random.size(1.0, 4.0));
        let Some(lines) = lines(places, feeds) else {
            continue;
        };
        // A corner of two lines is a stop.
        let lines = lines.map(|line| line.with_corner(Corner::Stop));
        for motors in [constant(), stepper()] {
            let limits = limits(1.0, motors);
            let fine = limits.plan(lines, [FREE; 2], |_| 400, &mut knots);
            let fine_s = fine.unwrap().duration_s();
            for (min_segments, max_time_ratio) in [(1, 1.3), (2, 1.05), (4, 1.02), (7, 1.01)] {
                let accuracy = Accuracy {
                    min_segments,
                    max_departure: 1.0,
                    max_time_ratio,
                };
                let departure = |path: &ArmPath, span: &Span<_>| path.departure(span);
                let table = limits.plan_within(lines, [FREE; 2], accuracy, departure, &mut knots);
                let table = table.unwrap();
                let ratio = table.duration_s() / fine_s;
                assert!(
                    ratio <= max_time_ratio,
                    "{ratio} for {accuracy:?}, {lines:?}"
                );
                let mut used = table.spans().map(|span| limits.utilisation(&span));
                assert!(used.all(|used| used <= WITHIN));
                rows += table.rows().count();
            }
        }
    }
    println!("{rows} rows");
}
