//! Paths that touch the end of a range, whose cubics pass it where they are long: planned as fast
//! as free ones, with few more segments.

use core::f64::consts::PI;

use path_timing::{
    Accuracy, AxisLimits, Cubic, Curve, Knot, LookAhead, Path, PathPoint, PlanError, Promise, Row,
    Span, Table, ToolLimits, Verifier, segments_within,
};
use thiserror::Error;

const RADIUS: f64 = 50.0;
const TOLERANCE: f64 = 0.01;
/// By which a cubic may pass the fence: rounding of a path that touches it.
const SLACK: f64 = 1e-9;
/// Segments that a touched fence may ask for: seven sizes on both sides, each twice.
const MOST_MORE: usize = 30;
/// What a table with other knots may take longer.
const SLOWER: f64 = 1.02;

/// A curve that may not go beyond a y.
#[derive(Debug, Clone, Copy)]
struct Fenced {
    curve: Curve<2>,
    fence: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("y goes to {0}")]
struct Beyond(f64);

impl Fenced {
    /// Half a circle that touches the fence.
    fn new(fence: f64) -> Self {
        let curve = Curve::arc([RADIUS, 0.0], [0.0, 0.0], [0.0, 1.0], PI).unwrap();
        Self { curve, fence }
    }

    fn departure(&self, span: &Span<[f64; 2]>) -> f64 {
        self.curve.departure(span)
    }
}

impl Path for Fenced {
    type Axes = [f64; 2];
    type Error = Beyond;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, Beyond> {
        let Ok(point) = self.curve.point(s);
        Ok(point)
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn check(&self, span: &Span<[f64; 2]>) -> Result<(), Beyond> {
        let [from, to] = &span.rows;
        let highest = Cubic::between(from, to).map(|cubic| cubic.extent()[1]);
        match highest.last() {
            Some(y) if y > self.fence + SLACK => Err(Beyond(y)),
            _ => Ok(()),
        }
    }

    fn is_too_coarse(&self, _: &Beyond) -> bool {
        true
    }
}

const fn axes(jerk: Option<f64>) -> [AxisLimits; 2] {
    [AxisLimits {
        speed: 200.0,
        acceleration: 2000.0,
        jerk,
    }; 2]
}

const ACCURACY: Accuracy = Accuracy {
    min_segments: 8,
    max_departure: TOLERANCE,
    max_time_ratio: 1.01,
};

/// The rows are what they promise, the fence among it. Their time, and how many they are.
fn verified(path: Fenced, rows: &[Row<[f64; 2]>], limits: [AxisLimits; 2]) -> (f64, usize) {
    let mut verifier = Verifier::new(Promise {
        limits,
        start_stop: [0.0; 2],
        max_departure: TOLERANCE,
        max_slowness: f64::INFINITY,
        tool_feed: Some(1.0),
    });
    for row in rows {
        verifier
            .add(row, |_| Some(path), Fenced::departure)
            .unwrap();
    }
    (rows.last().unwrap().time_s, rows.len())
}

type Planned = Result<Vec<Row<[f64; 2]>>, PlanError<Beyond>>;

fn table(path: Fenced, limits: [AxisLimits; 2], size: usize) -> Planned {
    let mut knots = vec![Knot::default(); size];
    let table = Table::plan_within([path], limits, ACCURACY, Fenced::departure, &mut knots)?;
    Ok(table.rows().collect())
}

fn table_at_any_feed(path: Fenced, limits: [AxisLimits; 2], size: usize) -> Planned {
    let mut knots = vec![Knot::default(); size];
    let departure = Fenced::departure;
    let table = Table::plan_within_at_any_feed([path], limits, ACCURACY, departure, &mut knots)?;
    Ok(table.rows().collect())
}

fn stream(path: Fenced, limits: [AxisLimits; 2], size: usize) -> Planned {
    let mut window = vec![Knot::default(); size];
    let segments = |path: &Fenced| segments_within(path, 64, TOLERANCE, Fenced::departure);
    LookAhead::new([path], limits, segments, &mut window)?.collect()
}

#[test]
fn a_fence_that_is_touched_takes_few_more_segments() {
    const SIZE: usize = 1000;
    for limits in [axes(None), axes(Some(40_000.0))] {
        for plan in [table, table_at_any_feed, stream] {
            let [(free_s, free), (touched_s, touched)] = [2.0 * RADIUS, RADIUS].map(|fence| {
                let path = Fenced::new(fence);
                verified(path, &plan(path, limits, SIZE).unwrap(), limits)
            });
            assert!(touched_s < free_s * SLOWER, "{touched_s} {free_s}");
            // What is free on other knots need not be fewer.
            assert!(
                touched > free / 2 && touched < free + MOST_MORE,
                "{touched} {free}"
            );
        }
    }
}

/// Where memory is short, the error says what is more likely to do, until it does.
#[test]
fn memory_for_a_fence_that_is_touched_is_asked_for() {
    let path = Fenced::new(RADIUS);
    let mut size = 12;
    let rows = loop {
        match table(path, axes(None), size) {
            Err(PlanError::Memory { needed, available }) => {
                assert!(needed > size && available == size, "{needed} {available}");
                size = needed;
            }
            planned => break planned.unwrap(),
        }
    };
    assert!(size < rows.len() * 2, "{size} {}", rows.len());
}

/// A fence that is passed is refused, whatever the number of knots.
#[test]
fn a_fence_that_is_passed_is_refused() {
    let path = Fenced::new(RADIUS - 0.1);
    let error = table(path, axes(None), 500).unwrap_err();
    assert!(matches!(error, PlanError::Memory { .. }), "{error}");
}
