//! Paths: slopes, turns, and each refusal with its place.

use core::f64::consts::TAU;

use machine_kin::path_timing::{
    AxisLimits, Corner, Curve, FeedCeiling, Knot, LookAhead, Path, Promise, Row, Table, Verifier,
    segments_within,
};
use machine_kin::{
    Axis, CarriageSide, CoreXy, Elbow, FiveBar, HangingPlotter, LinearDelta, Machine, MachinePath,
    Number, PathError, Polar, Refusal, Scara,
};
use proptest::prelude::*;

use crate::common::{limits, within};

/// Step of finite differences in mm, and what they are off by.
const STEP: f64 = 1e-3;
const DIFFERENCES: f64 = 1e-6;

const OUTWARDS: [Elbow; 2] = [Elbow::Left, Elbow::Right];

fn five_bar() -> FiveBar {
    FiveBar::new(80.0, 100.0, 160.0).unwrap()
}

fn line<const N: usize>(from: [f64; N], to: [f64; N]) -> Curve<N> {
    Curve::line(from, to).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn slopes_are_derivatives(
        x in -40.0..40.0_f64, y in 130.0..200.0_f64, to_x in -40.0..40.0_f64, to_y in 130.0..200.0_f64,
        share in 0.1..0.9_f64,
    ) {
        prop_assume!((x - to_x).hypot(y - to_y) > 1.0);
        let path = five_bar().path(line([x, y], [to_x, to_y]), OUTWARDS).unwrap();
        let s = path.length() * share;
        let [before, here, after] = [s - STEP, s, s + STEP].map(|s| path.point(s).unwrap());
        let [_, slopes, second] = path.derivatives(s).unwrap();
        for axis in 0..2 {
            let slope = (after.position[axis] - before.position[axis]) / (2.0 * STEP);
            prop_assert!((slope - here.slope[axis]).abs() < DIFFERENCES);
            prop_assert!((slopes[axis] - here.slope[axis]).abs() < DIFFERENCES * DIFFERENCES);
            let bend = (after.slope[axis] - before.slope[axis]) / (2.0 * STEP);
            prop_assert!((bend - second[axis]).abs() < DIFFERENCES);
        }
    }

    /// What is said to be free of singular poses and edges is no more than what is.
    #[test]
    fn a_clearance_is_a_distance_that_is_proven(x in -150.0..150.0_f64, y in -150.0..150.0_f64) {
        prop_assume!(x.abs().max(y.abs()) > 0.1);
        let clearance = Polar::new(0.0..=300.0).clearance([x, y], CarriageSide::Front);
        // The middle is the only such place; a box reaches it at the largest coordinate.
        let true_clearance = x.abs().max(y.abs());
        prop_assert!(clearance <= true_clearance && clearance > 0.25 * true_clearance, "{clearance} {true_clearance}");
    }
}

#[test]
fn an_arm_counts_its_turns() {
    let polar = Polar::new(0.0..=100.0);
    let round = Curve::arc([50.0, 0.0], [0.0, 0.0], [0.0, 1.0], 2.75 * TAU).unwrap();
    let path = polar.path(round, CarriageSide::Front).unwrap();
    let [start, end] = [0.0, round.length()].map(|s| path.point(s).unwrap().position);
    assert!((end[0] - start[0] - 2.75 * TAU).abs() < 1e-9);
    // The next begins where this one ended, turns included.
    let next = polar
        .path_from(line(round.end(), [20.0, 60.0]), CarriageSide::Front, end)
        .unwrap();
    let begun = next.point(0.0).unwrap().position;
    assert!((begun[0] - end[0]).abs() < 1e-12 && (begun[1] - end[1]).abs() < 1e-12);
    let many = Curve::arc([50.0, 0.0], [0.0, 0.0], [0.0, 1.0], 9.0 * TAU).unwrap();
    assert!(matches!(
        polar.path(many, CarriageSide::Front),
        Err(PathError::Turns { .. })
    ));
}

/// The arc length at which a curve is refused.
fn refused<M: Machine<N>, const N: usize>(
    machine: &M,
    curve: Curve<N>,
    branch: M::Branch,
) -> (f64, String) {
    let error = machine.path(curve, branch).unwrap_err();
    let s = match error {
        PathError::Unreachable { s, .. }
        | PathError::BranchEnds { s, .. }
        | PathError::Singular { s, .. } => s,
        PathError::Limit { s: [s, _], .. } | PathError::Area { s: [s, _], .. } => s,
        _ => panic!("{error}"),
    };
    (s, error.to_string())
}

#[test]
fn what_cannot_be_followed_is_refused_with_its_place() {
    // Through the middle of a polar machine, 30 mm on.
    let (s, text) = refused(
        &Polar::new(-50.0..=50.0),
        line([30.0, 0.0], [-30.0, 0.0]),
        CarriageSide::Front,
    );
    assert!((s - 30.0).abs() < 1e-3, "{s}");
    assert!(
        text.ends_with("the branch ends where the tool is in the middle"),
        "{text}"
    );
    // The five-bar's right arm is straight at 260 mm from its motor.
    let (s, text) = refused(&five_bar(), line([0.0, 180.0], [0.0, 300.0]), OUTWARDS);
    assert!(
        (s - (260.0_f64.powi(2) - 1600.0).sqrt() + 180.0).abs() < 1e-2,
        "{s}"
    );
    assert!(
        text.contains("the branch ends where the left arm is too short or too long"),
        "{text}"
    );
    // Elbows that meet bring both forearms in line: singular, though both arms reach.
    let inwards = [Elbow::Right, Elbow::Left];
    let (s, text) = refused(&five_bar(), line([0.0, 200.0], [0.0, 20.0]), inwards);
    let [left, _] = five_bar().inverse([0.0, 200.0 - s], inwards).unwrap();
    assert!((100.0 * left.cos() - 40.0).abs() < 0.1, "{s}");
    assert!(text.ends_with("the machine is singular"), "{text}");
    // A cord that is too short, a carriage that is too high, a frame.
    let plotter = HangingPlotter::new(1200.0, 300.0..=1000.0).unwrap();
    let (s, text) = refused(&plotter, line([600.0, 300.0], [1000.0, 300.0]), ());
    // The right cord has its least length right below its winch, 300 mm.
    assert!((s - 353.939).abs() < 1e-3, "{s}");
    assert!(text.contains("cord goes to"), "{text}");
    let delta = LinearDelta::new(250.0, 110.0, 0.0..=400.0).unwrap();
    let (s, text) = refused(&delta, line([0.0, 0.0, 100.0], [0.0, 0.0, 300.0]), ());
    assert!(
        (s - (300.0 - (250.0_f64.powi(2) - 110.0_f64.powi(2)).sqrt())).abs() < 1e-5,
        "{s}"
    );
    assert!(text.contains("carriage 1 goes to 400"), "{text}");
    let frame = CoreXy::new(0.0..=300.0, 0.0..=200.0);
    let (s, text) = refused(&frame, line([150.0, 100.0], [150.0, 220.0]), ());
    assert!(
        (s - 100.0).abs() < 1e-5 && text.contains("coordinate 1 of the tool goes to"),
        "{s} {text}"
    );
    // Along an edge and to its end is no harm.
    assert!(frame.path(line([0.0, 0.0], [300.0, 0.0]), ()).is_ok());
    // A start that is out of reach says by how much.
    let scara = Scara::new(160.0, 140.0, 30.0).unwrap();
    let (s, text) = refused(
        &scara,
        line([310.0, 0.0, 0.0, 0.0], [200.0, 0.0, 0.0, 0.0]),
        Elbow::Left,
    );
    assert!(
        s == 0.0 && text.contains("(310, 0, 0, 0): the arm is too short or too long, by 9.8"),
        "{text}"
    );
}

#[test]
fn ranges_that_are_none_are_refused() {
    #[derive(Debug, Clone)]
    struct Slide;
    impl Machine<1> for Slide {
        type Branch = ();
        fn axes(&self) -> [Axis; 1] {
            [Axis::linear("slide", 0.0..=f64::NAN)]
        }
        fn inverse<T: Number>(&self, tool: [T; 1], (): ()) -> Result<[T; 1], Refusal> {
            Ok(tool)
        }
    }
    let error = Slide.path(line([1.0], [2.0]), ()).unwrap_err();
    assert_eq!(error.to_string(), "0..=NaN is no range of the slide");
}

/// A curve whose elbow comes close to the end of its range is within it. The cubics of 8 segments
/// pass it, so there are more.
#[test]
fn a_range_that_is_nearly_touched_takes_more_segments() {
    const MARGIN: f64 = 1e-7;
    let arm = Scara::new(132.0, 132.0, 30.0).unwrap();
    let curve = line([220.0, -40.0, 0.0, 0.0], [220.0, 45.0, 0.0, 0.0]);
    let path = arm.path(curve, Elbow::Right).unwrap();
    let [_, largest, ..] = path.point(40.0).unwrap().position;
    let rows = |machine: Scara| {
        let path = machine.path(curve, Elbow::Right).unwrap();
        let motor = AxisLimits {
            speed: 6.0,
            acceleration: 100.0,
            jerk: None,
        };
        let mut knots = vec![Knot::default(); 8000];
        let departure = MachinePath::departure;
        let table = Table::plan_within([path], [motor; 4], within(10.0), departure, &mut knots);
        table.unwrap().rows().count()
    };
    let any = f64::NEG_INFINITY..=f64::INFINITY;
    let elbow = 0.0..=largest + MARGIN;
    let close = arm.with_ranges([any.clone(), elbow, any.clone(), any]);
    let [free, close] = [arm, close].map(rows);
    assert!(close > free, "{close} {free}");
}

/// An arc that touches the frame is planned like a free one, with segments that are short at that
/// place alone.
#[test]
fn a_frame_that_is_touched_takes_few_more_segments() {
    const MOST_MORE: usize = 20;
    let curve = Curve::arc([250.0, 100.0], [150.0, 100.0], [0.0, 1.0], 3.0).unwrap();
    let belt = AxisLimits {
        speed: 300.0,
        acceleration: 4000.0,
        jerk: None,
    };
    let [free, touched] = [300.0, 200.0].map(|end| {
        let path = CoreXy::new(0.0..=300.0, 0.0..=end).path(curve, ()).unwrap();
        let mut knots = vec![Knot::default(); 200];
        let departure = MachinePath::departure;
        let table = Table::plan_within([path], [belt; 2], within(0.01), departure, &mut knots);
        table.unwrap().len()
    });
    assert!(
        touched > free && touched <= free + MOST_MORE,
        "{touched} {free}"
    );
}

/// Holds, feeds and streams keep the limits and the tolerance on every row, as the verifier sees
/// them.
fn runs<M: Machine<N>, const N: usize>(machine: &M, curves: [Curve<N>; 2], branch: M::Branch) {
    const TOLERANCE: f64 = 0.02;
    let limits = limits(machine);
    let first = machine.path(curves[0], branch).unwrap();
    let end = first.point(first.length()).unwrap().position;
    let paths = [first, machine.path_from(curves[1], branch, end).unwrap()];
    let departure = MachinePath::<M, N>::departure;
    let promise = Promise {
        limits,
        start_stop: [0.0; N],
        max_departure: TOLERANCE,
        max_slowness: f64::INFINITY,
        tool_feed: Some(1.0),
    };
    let verify = |rows: &[Row<[f64; N]>]| {
        let mut verifier = Verifier::new(promise);
        for row in rows {
            let path = |leg: usize| paths.get(leg).cloned();
            verifier.add(row, path, departure).unwrap();
        }
        assert!(rows.len() >= 5);
        let [.., last] = rows else { panic!("no rows") };
        assert!(last.is_at_rest() && last.leg == 1);
    };
    let mut knots = vec![Knot::default(); 2000];
    let accuracy = within(TOLERANCE);
    let table = Table::plan_within_at_any_feed(
        paths.iter().cloned(),
        limits,
        accuracy,
        departure,
        &mut knots,
    );
    let table = table.unwrap();
    let mut ceilings = vec![FeedCeiling::default(); table.len()];
    let mut playback = table.playback(1.0, &mut ceilings).unwrap();
    let mut rows: Vec<_> = playback.by_ref().take(4).collect();
    playback.stop();
    rows.extend(playback.by_ref());
    playback.set_feed(0.7).unwrap();
    rows.extend(playback);
    verify(&rows);
    let mut window = vec![Knot::default(); 100];
    let segments = |path: &MachinePath<M, N>| segments_within(path, 4, TOLERANCE, departure);
    let stream = LookAhead::new(paths.iter().cloned(), limits, segments, &mut window).unwrap();
    let rows: Vec<_> = stream.map(Result::unwrap).collect();
    verify(&rows);
}

#[test]
fn every_machine_runs_holds_and_streams() {
    let flat = [
        line([-40.0, 150.0], [30.0, 170.0]),
        line([30.0, 170.0], [10.0, 140.0]),
    ];
    runs(&five_bar(), flat, OUTWARDS);
    runs(&Polar::new(0.0..=200.0), flat, CarriageSide::Front);
    runs(&CoreXy::new(-50.0..=50.0, 100.0..=200.0), flat, ());
    let hung = [
        line([300.0, 500.0], [500.0, 600.0]),
        line([500.0, 600.0], [700.0, 500.0]),
    ];
    runs(
        &HangingPlotter::new(1200.0, 200.0..=1500.0).unwrap(),
        hung,
        (),
    );
    let room = [
        line([40.0, 30.0, 20.0], [-30.0, 50.0, 60.0]),
        line([-30.0, 50.0, 60.0], [-40.0, 0.0, 60.0]),
    ];
    runs(
        &LinearDelta::new(250.0, 110.0, 0.0..=450.0).unwrap(),
        room,
        (),
    );
    let turned = [
        line([100.0, 150.0, 0.0, 0.0], [-50.0, 180.0, 20.0, 30.0]),
        line([-50.0, 180.0, 20.0, 30.0], [-90.0, 120.0, 20.0, 0.0]),
    ];
    runs(
        &Scara::new(160.0, 140.0, 30.0).unwrap(),
        turned,
        Elbow::Right,
    );
}

/// A stop of the tool is one of the axes, which jump by what their motors start and stop with.
#[test]
fn a_stop_of_the_tool_stops_the_axes() {
    const JUMP: f64 = 0.2;
    let machine = five_bar();
    let [first, second] = [
        line([-40.0, 150.0], [0.0, 150.0]),
        line([0.0, 150.0], [40.0, 150.0]),
    ];
    let turn = line([0.0, 150.0], [0.0, 180.0]);
    let path = |curve| machine.path(curve, OUTWARDS).unwrap();
    let jumping = path(first).with_corner(Corner::Jump([JUMP; 2]));
    let stopped = path(first.with_corner(Corner::Stop));
    let passed_at = |paths: [MachinePath<FiveBar, 2>; 2]| {
        let mut knots = [Knot::default(); 100];
        let limits = limits(&machine);
        let table = Table::plan(paths, limits, |_| 20, &mut knots).unwrap();
        // The last of the first path's rows, and the first of the second's where axes jump.
        let rows = table.rows().filter(|row| row.leg == 0 || row.s <= 0.0);
        rows.skip(20).map(|row| row.velocity).collect::<Vec<_>>()
    };
    assert_ne!(passed_at([path(first), path(second)]), [[0.0; 2]]);
    assert_eq!(passed_at([stopped, path(second)]), [[0.0; 2]]);
    assert_eq!(passed_at([path(first), path(turn)]), [[0.0; 2]]);
    let velocities = passed_at([jumping, path(turn)]);
    let [before, after] = velocities[..] else {
        panic!("{velocities:?}")
    };
    let jump = [0, 1].map(|axis| (before[axis] - after[axis]).abs());
    assert!((jump[0].max(jump[1]) - JUMP).abs() < 1e-9, "{jump:?}");
}
