//! Segments too long for their torques to be known.

use path_timing::{
    Curve, Dynamics, Friction, Knot, PlanError, Row, Span, TorqueCurve, TorqueLimits,
};

use super::streams::{end_s, streamed};
use super::{FREE, delta};

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
