//! Departures within a tolerance at any feeds, by the bound of curves, measured on the cubics.

use core::f64::consts::PI;

use path_timing::{
    AxisLimits, Cubic, Curve, FeedCeiling, Knot, LookAhead, PlanError, Row, Span, Table,
    segments_within,
};
use proptest::prelude::*;

use crate::support::polyline::{smoothed, within};

const RADIUS: f64 = 50.0;
const TOLERANCE: f64 = 0.01;
/// Of a bound that is computed and a distance that is measured.
const ROUNDING: f64 = 1e-12;
/// Places at which a cubic is measured.
const PLACES: u32 = 40;

const fn limits(speed: f64, acceleration: f64, jerk: Option<f64>) -> AxisLimits {
    AxisLimits {
        speed,
        acceleration,
        jerk,
    }
}

fn half_circle() -> Curve<2> {
    Curve::arc([RADIUS, 0.0], [0.0, 0.0], [0.0, 1.0], PI).unwrap()
}

/// The largest distance from the circle along all cubics.
fn measured(rows: &[Row<[f64; 2]>]) -> f64 {
    let mut worst = 0.0_f64;
    for pair in rows.windows(2) {
        let cubics: Vec<_> = Cubic::between(&pair[0], &pair[1]).collect();
        for place in 0..=PLACES {
            let fraction = f64::from(place) / f64::from(PLACES);
            let [x, y] = [0, 1].map(|axis: usize| cubics[axis].position(fraction));
            worst = worst.max((x.hypot(y) - RADIUS).abs());
        }
    }
    worst
}

/// Rows under feeds that hold for some rows each, to the end.
fn run(table: &Table<'_, [f64; 2]>, feeds: &[(f64, usize)]) -> Vec<Row<[f64; 2]>> {
    let mut ahead = vec![FeedCeiling::default(); table.len()];
    let mut run = table.playback(1.5, &mut ahead).unwrap();
    let mut rows = Vec::new();
    for (feed, count) in feeds {
        run.set_feed(if *feed < 0.4 { 0.0 } else { *feed }).unwrap();
        rows.extend(run.by_ref().take(*count));
    }
    run.set_feed(1.0).unwrap();
    rows.extend(run.by_ref());
    assert!(run.is_finished());
    rows
}

/// Of a polyline that is passed without a stop, and of one with a stop at each corner.
#[test]
fn a_table_keeps_its_departure_where_it_does_not_stop() {
    let corners = [[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [10.0, 60.0]];
    let curves = smoothed(&corners, 0.05);
    let mut knots = vec![Knot::default(); 4000];
    for jerk in [None, Some(20_000.0)] {
        let limits = [limits(100.0, 1000.0, jerk); 2];
        let bound = |curve: &&Curve<2>, span: &_| curve.departure(span);
        let table = Table::plan_within(&curves, limits, within(2, 1e-4), bound, &mut knots);
        let table = table.unwrap();
        for span in table.spans() {
            assert!(bound(&&curves[span.rows[1].leg], &span) <= 1e-4);
        }
        let inside = table.rows().skip(1).take(table.len() - 2);
        let slowest = inside.fold(f64::MAX, |least, row| {
            least.min(row.velocity[0].hypot(row.velocity[1]))
        });
        assert!(slowest > 1.0, "{slowest}");
    }
}

/// A hold in a table for a constant feed departs by more; in one for any feed it does not.
#[test]
fn a_hold_stays_on_the_path_if_it_is_planned_for() {
    let limits = [limits(200.0, 2000.0, None); 2];
    let feeds = |count| [(1.0, count), (0.0, 1000)];
    let mut knots = vec![Knot::default(); 2000];
    let table = Table::plan_within(
        [half_circle()],
        limits,
        within(2, TOLERANCE),
        Curve::departure,
        &mut knots,
    );
    let table = table.unwrap();
    let few = table.len();
    let worst = (1..few).map(|count| measured(&run(&table, &feeds(count))));
    assert!(worst.fold(0.0, f64::max) > 2.0 * TOLERANCE);
    let table = Table::plan_within_at_any_feed(
        [half_circle()],
        limits,
        within(2, TOLERANCE),
        Curve::departure,
        &mut knots,
    );
    let table = table.unwrap();
    let worst = (1..table.len()).map(|count| measured(&run(&table, &feeds(count))));
    let worst = worst.fold(0.0, f64::max);
    println!(
        "{few} rows at a constant feed, {} at any; {worst:.5} of {TOLERANCE}",
        table.len()
    );
    // What it allows for, a start without a step of the acceleration, departs 4 times as far.
    assert!(worst <= TOLERANCE && worst > TOLERANCE / 5.0, "{worst}");
    assert!(table.len() < 12 * few);
}

/// Circles without end, each half of it another path.
#[test]
fn a_stream_keeps_its_departure_at_any_feed() {
    let mut start = [RADIUS, 0.0];
    let halves = (0..40).map(move |_| {
        let [x, y] = start;
        let half = Curve::arc(start, [0.0, 0.0], [-y, x], PI).unwrap();
        start = half.end();
        half
    });
    let segments = |curve: &Curve<2>| segments_within(curve, 2, TOLERANCE, Curve::departure);
    let mut window = [Knot::default(); 100];
    let limits = [limits(200.0, 2000.0, None); 2];
    let mut motion = LookAhead::new(halves, limits, segments, &mut window).unwrap();
    let mut rows = Vec::new();
    for (feed, count) in [
        (1.0, 37),
        (0.0, 100),
        (0.5, 60),
        (1.0, 80),
        (0.0, 100),
        (1.0, 200),
    ] {
        motion.set_feed(feed).unwrap();
        rows.extend(motion.by_ref().take(count).map(Result::unwrap));
    }
    let worst = measured(&rows);
    // Most of it is room for a hold at the last knot of a path.
    assert!(
        worst <= TOLERANCE + ROUNDING && worst > TOLERANCE / 20.0,
        "{worst}"
    );
}

/// A departure that more segments do not always make smaller: what is enough for some corners at the
/// ends, and too few for others, need not be kept with what is enough for those.
#[test]
fn segments_keep_a_departure_that_falls_unevenly() {
    let line = Curve::line([0.0; 2], [100.0, 0.0]).unwrap();
    let (allowed, limits) = (8.0, [limits(200.0, 2000.0, None); 2]);
    for phase in 0..200 {
        let departure = |_: &Curve<2>, span: &Span<[f64; 2]>| {
            let [from, to] = span.s;
            (to - from) * (1.0 + 0.9 * ((from + to) * 7.0 + f64::from(phase)).sin())
        };
        let segments = |line: &Curve<2>| segments_within(line, 2, allowed, departure);
        let mut window = [Knot::default(); 100];
        let mut motion = LookAhead::new([line], limits, segments, &mut window).unwrap();
        let mut from = 0.0;
        for row in motion.by_ref().map(Result::unwrap).skip(1) {
            let to = row.s;
            let span = Span {
                s: [from, to],
                rows: [row; 2],
            };
            assert!(
                departure(&line, &span) <= allowed,
                "{phase}: {from} to {to}"
            );
            from = to;
        }
    }
}

#[test]
fn what_no_number_of_segments_keeps_is_named() {
    for allowed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = segments_within(&half_circle(), 2, allowed, Curve::departure).unwrap_err();
        assert!(matches!(error, PlanError::Allowed { .. }));
    }
    let error = segments_within(&half_circle(), 2, 1e-3, |_, _| f64::NAN).unwrap_err();
    assert_eq!(
        error,
        PlanError::TooFine {
            leg: 0,
            max: 1 << 20
        }
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn departures_hold_under_any_feeds(
        feeds in prop::collection::vec((0.0..1.5_f64, 1..30_usize), 1..12),
        jerk in prop::option::of(5e3..1e5_f64), speed in 50.0..500.0_f64,
    ) {
        let limits = [limits(speed, 2000.0, jerk); 2];
        let mut knots = vec![Knot::default(); 4000];
        let table = Table::plan_within_at_any_feed(
            [half_circle()], limits, within(7, TOLERANCE), Curve::departure, &mut knots,
        );
        let table = table.unwrap().at_speed(0.9).unwrap();
        let worst = measured(&run(&table, &feeds));
        prop_assert!(worst <= TOLERANCE, "{worst}");
    }
}
