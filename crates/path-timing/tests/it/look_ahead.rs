//! Endless streams of paths in a window.

use alloc::collections::VecDeque;
use core::array;
use core::cell::{Cell, RefCell};

use path_timing::{
    AxisLimits, Corner, Curve, FeedCeiling, Knot, LookAhead, Path, PathFn, PathPoint, PlanError,
    Row, Smoothed, Table, Vertex,
};
use proptest::prelude::*;
use test_support::Random;

use crate::support::limits::check_limits;
use crate::support::machine::limits;
use crate::support::polyline::lines;

const LIMITS: [AxisLimits; 2] = [limits(2.0, 20.0, None), limits(300.0, 2000.0, None)];
const POINTS: [[f64; 2]; 6] = [
    [-100.0, 80.0],
    [0.0, 80.0],
    [50.0, 80.0],
    [90.0, 60.0],
    [150.0, 60.0],
    [150.0, 140.0],
];
const JUMP: [f64; 2] = [0.1, 20.0];
/// At which searches for a beginning stop, and some.
const CLOSE: f64 = 1e-4;

fn slots(count: usize) -> Vec<Knot<[f64; 2]>> {
    vec![Knot::default(); count]
}

#[test]
fn a_long_window_is_a_table() {
    for corner in [Corner::Stop, Corner::Jump(JUMP)] {
        for feed in [None, Some(60.0)] {
            let paths = lines(&POINTS, corner, feed);
            let mut knots = vec![Knot::default(); 1000];
            let table = Table::plan(&paths, LIMITS, |_| 20, &mut knots).unwrap();
            let table: Vec<_> = table.rows().collect();
            let mut window = slots(200);
            let motion = LookAhead::new(&paths, LIMITS, |_| Ok(20), &mut window).unwrap();
            let rows: Vec<_> = motion.map(Result::unwrap).collect();
            check_limits(&LIMITS, Some(&JUMP), &rows);
            let [time_s, least_s] = [&rows, &table].map(|rows| rows.last().unwrap().time_s);
            let ratio = time_s / least_s;
            // The knots of a table stand where it is slow.
            assert!((0.95..1.05).contains(&ratio), "{ratio}");
            assert_eq!(rows.len(), table.len());
        }
    }
}

/// Six segments of a bent curve, over 400 in a table: the worst takes 1.16 times as long.
const OVER_MANY_SEGMENTS: f64 = 1.2;

#[test]
fn few_segments_of_a_bent_curve_are_nearly_as_fast_as_many() {
    let axes = [limits(300.0, 3000.0, None); 2];
    let (mut knots, mut window) = (slots(401), slots(300));
    let mut random = Random::new(1);
    let (mut count, mut worst) = (0, 0.0_f64);
    for _ in 0..400 {
        let points = array::from_fn(|_| array::from_fn(|_| random.within(0.0, 20.0)));
        let Ok(curve) = Curve::<2>::bezier(points) else {
            continue; // with a cusp
        };
        let table = Table::plan([curve], axes, |_| 400, &mut knots).unwrap();
        let motion = LookAhead::new([curve], axes, |_| Ok(6), &mut window).unwrap();
        let ratio = motion.last().unwrap().unwrap().time_s / table.duration_s();
        assert!(ratio < OVER_MANY_SEGMENTS, "{points:?}: {ratio}");
        (count, worst) = (count + 1, worst.max(ratio));
    }
    println!("{count} curves, at worst {worst:.3} times as long");
}

#[test]
fn a_rest_is_a_hold_or_the_end() {
    let mut window = slots(200);
    let paths = lines(&POINTS, Corner::Stop, None);
    let mut motion = LookAhead::new(&paths, LIMITS, |_| Ok(20), &mut window).unwrap();
    for _ in 0..30 {
        motion.next_row().unwrap().unwrap();
        assert!(!motion.is_finished());
    }
    motion.stop();
    while motion.next_row().unwrap().is_some() {}
    assert!(motion.is_at_rest() && !motion.is_finished());
    motion.set_feed(1.0).unwrap();
    // At rest at each corner, and at the end.
    let (mut rests, mut ends) = (0, 0);
    while motion.next_row().unwrap().is_some() {
        rests += usize::from(motion.is_at_rest());
        ends += usize::from(motion.is_finished());
    }
    assert!(rests > 1 && ends == 1 && motion.is_finished());
}

#[test]
fn the_end_before_a_refused_path_is_an_end() {
    let mut window = slots(40);
    let there = || Curve::line([0.0, 0.0], [50.0, 0.0]).unwrap();
    let apart = [there(), there()];
    let mut motion = LookAhead::new(apart, LIMITS, |_| Ok(8), &mut window).unwrap();
    let refusals = (0..100).filter(|_| motion.next_row().is_err()).count();
    assert!(refusals == 1 && motion.is_finished());
}

/// A trapezoid at 100 mm/s and 1000 mm/s² over knots 1 mm apart brakes within 5 of them.
#[test]
fn a_window_shorter_than_the_braking_distance_costs_time_alone() {
    let line = |from: f64| {
        let point = move |s: f64| {
            Ok::<_, &str>(PathPoint {
                position: [from + s],
                slope: [1.0],
            })
        };
        PathFn::new(10.0, point).with_corner(Corner::Smooth)
    };
    let limits = [limits(100.0, 1000.0, None)];
    let mut before_s = f64::INFINITY;
    for (count, full_speed) in [(4, false), (5, false), (8, false), (12, true), (40, true)] {
        let paths = (0..50).map(|n| line(f64::from(n) * 10.0));
        let mut window = vec![Knot::default(); count];
        let motion = LookAhead::new(paths, limits, |_| Ok(10), &mut window).unwrap();
        let rows: Vec<_> = motion.map(Result::unwrap).collect();
        check_limits(&limits, None, &rows);
        let time_s = rows.last().unwrap().time_s;
        assert!(time_s <= before_s * (1.0 + CLOSE), "{count}: {time_s}");
        // 500 mm at 100 mm/s, and 0.1 s for the ramps.
        assert_eq!(time_s < 5.1 * 1.01, full_speed, "{count}: {time_s}");
        before_s = time_s;
        let last = rows.last().unwrap();
        assert!((last.position[0] - 500.0).abs() < f64::EPSILON && last.velocity[0] == 0.0);
    }
}

/// Each knot's place is asked for once, each path's start too, however long the stream is.
#[test]
fn a_stream_without_end_costs_the_same_for_each_knot() {
    let asked = Cell::new(0_u32);
    let line = |number: u32| {
        let asked = &asked;
        let point = move |s: f64| {
            asked.set(asked.get() + 1);
            let (x, slope) = if number.is_multiple_of(2) {
                (s, 1.0)
            } else {
                (5.0 - s, -1.0)
            };
            Ok::<_, &str>(PathPoint {
                position: [x, (f64::from(number) * 5.0 + s) * 0.01],
                slope: [slope, 0.01],
            })
        };
        PathFn::new(5.0, point).with_corner(Corner::Jump([1.0; 2]))
    };
    let mut window = slots(24);
    let limits = [limits(50.0, 500.0, None); 2];
    // Its ends are joined to the last bit.
    let paths = (0..).map(line);
    let motion = LookAhead::new(paths, limits, |_| Ok(8), &mut window).unwrap();
    let rows: Vec<_> = motion.take(90_000).map(Result::unwrap).collect();
    check_limits(&limits, Some(&[1.0 + CLOSE; 2]), &rows);
    // Eight knots, two rows at the corner.
    assert!(asked.get() < 90_100, "{}", asked.get());
}

#[test]
fn a_stream_that_pauses_rests_at_the_end_and_goes_on() {
    let paths = lines(&POINTS, Corner::Jump(JUMP), None);
    let queue = RefCell::new(VecDeque::from_iter(paths));
    let source = core::iter::from_fn(|| queue.borrow_mut().pop_front());
    let late = queue.borrow_mut().split_off(2);
    let mut window = slots(50);
    let mut motion = LookAhead::new(source, LIMITS, |_| Ok(10), &mut window).unwrap();
    assert!(motion.is_at_rest());
    let mut rows: Vec<_> = motion.by_ref().map(Result::unwrap).collect();
    // The first corner is none.
    assert_eq!(rows.len(), 1 + 2 * 10);
    assert!(motion.is_at_rest() && motion.next_row().unwrap().is_none());
    queue.borrow_mut().extend(late);
    rows.extend(motion.map(Result::unwrap));
    check_limits(&LIMITS, Some(&JUMP), &rows);
    assert!((rows.last().unwrap().position[1] - 150.0_f64.hypot(140.0)).abs() < 1e-12);
}

#[test]
fn a_refused_path_is_named_once_and_the_machine_stops_before_it() {
    let line = |n: u32| {
        let from = f64::from(n) * 10.0;
        let point = move |s: f64| {
            if from + s > 34.0 {
                return Err("out of reach");
            }
            Ok(PathPoint {
                position: [from + s],
                slope: [1.0],
            })
        };
        PathFn::new(10.0, point).with_corner(Corner::Smooth)
    };
    let limits = [limits(100.0, 1000.0, None)];
    let mut window = vec![Knot::default(); 16];
    let mut motion = LookAhead::new((0..).map(line), limits, |_| Ok(10), &mut window).unwrap();
    let (mut rows, mut errors) = (Vec::new(), Vec::new());
    while let Some(row) = motion.next_row().transpose() {
        match row {
            Ok(row) => rows.push(row),
            Err(error) => errors.push(error.to_string()),
        }
    }
    assert_eq!(errors, ["leg 3, at 5: out of reach"]);
    check_limits(&limits, None, &rows);
    let last = rows.last().unwrap();
    assert!((last.position[0] - 34.0).abs() < 1e-12 && last.velocity[0] == 0.0);
}

#[test]
fn what_cannot_be_planned_is_named() {
    let paths = || lines(&POINTS, Corner::Stop, None);
    let mut window = slots(20);
    let error = LookAhead::new(paths(), [limits(0.0, 1.0, None); 2], |_| Ok(8), &mut window);
    assert!(matches!(
        error.unwrap_err(),
        PlanError::Limit { axis: 0, .. }
    ));
    let error = LookAhead::new(paths(), LIMITS, |_| Ok(8), &mut window[..2]).unwrap_err();
    let (needed, available) = (4, 2);
    assert_eq!(error, PlanError::Memory { needed, available });
    let mut motion = LookAhead::new(paths(), LIMITS, |_| Ok(u32::MAX), &mut window).unwrap();
    assert!(matches!(
        motion.next_row(),
        Err(PlanError::TooFine { leg: 0, .. })
    ));
    assert!(motion.next_row().unwrap().is_none());
    for max in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let motion = LookAhead::new(paths(), LIMITS, |_| Ok(8), &mut window).unwrap();
        assert!(matches!(
            motion.with_max_feed(max),
            Err(PlanError::Feed { .. })
        ));
    }
    let motion = LookAhead::new(paths(), LIMITS, |_| Ok(8), &mut window).unwrap();
    let mut motion = motion.with_max_feed(1.5).unwrap();
    for feed in [1.6, -0.1, f64::NAN, 1e-310] {
        assert!(motion.set_feed(feed).is_err());
    }
    // The second line begins elsewhere.
    let gap = [
        Curve::line([0.0, 1.0], [1.0, 1.0]).unwrap(),
        Curve::line([1.0, 1.5], [2.0, 1.0]).unwrap(),
    ];
    let mut motion = LookAhead::new(gap, LIMITS, |_| Ok(8), &mut window).unwrap();
    let (leg, axis, by) = (1, 1, 0.5);
    assert_eq!(motion.next_row(), Err(PlanError::Gap { leg, axis, by }));
}

/// The tool at 60 mm/s, at half and twice of it where axes allow.
#[test]
fn the_feed_is_multiplied() {
    let paths = lines(
        &[[-100.0, 80.0], [0.0, 80.0], [100.0, 80.0]],
        Corner::Smooth,
        Some(60.0),
    );
    let speeds = |rows: &[Row<[f64; 2]>]| {
        let tool = |row: &Row<[f64; 2]>| row.velocity[1].hypot(row.velocity[0] * row.position[1]);
        rows.iter().map(tool).fold(0.0, f64::max)
    };
    for feed in [0.5, 1.0, 2.0] {
        let mut window = slots(40);
        let motion = LookAhead::new(&paths, LIMITS, |_| Ok(50), &mut window).unwrap();
        let mut motion = motion.with_max_feed(2.0).unwrap();
        motion.set_feed(feed).unwrap();
        let rows: Vec<_> = motion.map(Result::unwrap).collect();
        check_limits(&LIMITS, None, &rows);
        assert!((speeds(&rows) / (60.0 * feed) - 1.0).abs() < 1e-9);
        let time_s = rows.last().unwrap().time_s * 60.0 * feed / 200.0;
        assert!((1.0..1.15).contains(&time_s), "{time_s}");
    }
}

#[test]
fn a_hold_rests_on_the_path_and_goes_on() {
    let jump = [0.5, 100.0];
    let paths = lines(&POINTS, Corner::Jump(jump), Some(250.0));
    let count = {
        let mut window = slots(40);
        let motion = LookAhead::new(&paths, LIMITS, |_| Ok(20), &mut window).unwrap();
        motion.count()
    };
    for moving in 1..count {
        let mut window = slots(40);
        let mut motion = LookAhead::new(&paths, LIMITS, |_| Ok(20), &mut window).unwrap();
        let mut rows: Vec<_> = motion.by_ref().take(moving).map(Result::unwrap).collect();
        motion.stop();
        rows.extend(motion.by_ref().map(Result::unwrap));
        let rest = rows.last().unwrap();
        assert!(motion.is_at_rest() && rest.velocity.iter().all(|v| *v == 0.0));
        let stop_s = rest.time_s - rows[moving - 1].time_s;
        assert!(stop_s < 0.3, "{moving}: {stop_s}");
        motion.set_feed(1.0).unwrap();
        rows.extend(motion.map(Result::unwrap));
        check_limits(&LIMITS, Some(&jump), &rows);
        let [x, y] = POINTS[5];
        assert!((rows.last().unwrap().position[1] - x.hypot(y)).abs() < 1e-12);
    }
}

/// Blends are passed at speed, from the first row to the last.
#[test]
fn a_rounded_polyline_is_run_without_a_stop() {
    let corners = [[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [10.0, 60.0]];
    let points = (0..400).map(|n: usize| corners[n % 4]);
    let mut memory = [Vertex::default(); 8];
    let curves = Smoothed::new(points, 0.05, &mut memory).unwrap();
    let curves = curves.map(Result::unwrap);
    let mut window = slots(64);
    let limits = [limits(100.0, 1000.0, None); 2];
    let motion = LookAhead::new(curves, limits, |_| Ok(12), &mut window).unwrap();
    let rows: Vec<_> = motion.map(Result::unwrap).collect();
    check_limits(&limits, None, &rows);
    let inside = &rows[1..rows.len() - 1];
    assert!(
        inside
            .iter()
            .all(|row| row.velocity[0].hypot(row.velocity[1]) > 1.0)
    );
}

/// The sizes that the README states, on 64 bits.
#[cfg(target_pointer_width = "64")]
#[test]
fn memory_is_stated() {
    assert_eq!(
        (size_of::<Knot<[f64; 2]>>(), size_of::<FeedCeiling>()),
        (152, 16)
    );
    assert_eq!(size_of::<Knot<[f64; 3]>>(), 168);
    assert_eq!((size_of::<Vertex<2>>(), size_of::<Vertex<3>>()), (128, 152));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn limits_hold_in_any_window_at_any_feed(
        points in prop::collection::vec((-200.0..200.0_f64, 5.0..200.0_f64), 2..12),
        start_stop in prop::option::of((0.0..0.5, 0.0..80.0_f64)),
        feed in prop::option::of(20.0..500.0),
        overrides in prop::collection::vec((0.0..2.0_f64, 1..20_usize), 0..12),
        (segments, count) in (1..30_u32, 4..80_usize),
    ) {
        prop_assume!(points.windows(2).all(|pair| pair[0] != pair[1]));
        let points: Vec<_> = points.into_iter().map(|(x, y)| [x, y]).collect();
        let jump = start_stop.map(|(turn, slide)| [turn, slide]);
        let corner = jump.map_or(Corner::Smooth, Corner::Jump);
        let paths = lines(&points, corner, feed);
        let mut window = slots(count);
        let motion = LookAhead::new(&paths, LIMITS, |_| Ok(segments), &mut window).unwrap();
        let mut motion = motion.with_max_feed(2.0).unwrap();
        let (mut rows, mut is_refused) = (Vec::new(), false);
        for (wanted, count) in overrides.into_iter().chain([(1.0, usize::MAX)]) {
            motion.set_feed(if wanted < 0.3 { 0.0 } else { wanted }).unwrap();
            for row in motion.by_ref().take(count) {
                match row {
                    Err(PlanError::TooCoarse { .. }) => is_refused = true,
                    row => rows.push(row.unwrap()),
                }
            }
        }
        check_limits(&LIMITS, jump.as_ref(), &rows);
        prop_assert!(rows.windows(2).all(|pair| pair[1].time_s.is_finite()));
        prop_assume!(!is_refused);
        let end = paths.last().unwrap();
        let Ok(end) = end.point(end.length());
        let last = rows.last().unwrap();
        prop_assert_eq!(last.position.map(f64::to_bits), end.position.map(f64::to_bits));
        prop_assert!(motion.is_at_rest());
    }
}
