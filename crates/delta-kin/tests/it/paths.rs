//! Curves as paths of the arms: the platform on the cubics that run, limits, refusals, pick and
//! place.

use core::f64::consts::FRAC_PI_2;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{Arm, ArmRange, Delta, DeltaPath, DeltaPathError, InverseError, ZAxis};
use path_timing::{
    Accuracy, AxisLimits, Corner, Cubic, Curve, Knot, Path, PlanError, Row, Span, Table, ToolLimits,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;

use crate::common::thesis::thesis;

/// Of places of a machine of 400 mm.
const ROUNDING: f64 = 1e-11;

/// Step of finite differences in mm, and what they are off by.
const STEP: f64 = 1e-4;
const DIFFERENCES: f64 = 1e-7;

/// Of what is computed anew from rounded rows.
const MARGIN: f64 = 1.0 + 1e-9;

const ARM: AxisLimits = AxisLimits {
    speed: 6.0,
    acceleration: 100.0,
    jerk: None,
};

const FEED: ToolLimits = ToolLimits {
    feed: 400.0,
    acceleration: Some(8000.0),
};

fn line(from: [f64; 3], to: [f64; 3]) -> Curve<3> {
    Curve::line(from, to).unwrap()
}

fn any_curve() -> impl Strategy<Value = Curve<3>> {
    let point = || [-130.0..130.0_f64, -130.0..130.0_f64, -340.0..-180.0_f64];
    prop_oneof![
        (point(), point()).prop_map(|(from, to)| line(from, to)),
        (point(), point(), point(), 0.1..5.0_f64)
            .prop_map(|(start, centre, way, angle)| Curve::arc(start, centre, way, angle).unwrap()),
        [point(), point(), point(), point()]
            .prop_filter_map("a cusp", |points| Curve::bezier(points).ok()),
    ]
}

/// The most by which a rod is out of the plane of its arm.
fn swivel(delta: &Delta, point: Point3<f64>) -> f64 {
    let sides = delta.arms().map(|arm| {
        let (sin, cos) = arm.azimuth.sin_cos();
        ((point.y * cos - point.x * sin) / arm.lower).abs().asin()
    });
    sides.into_iter().fold(0.0, f64::max)
}

/// The speeds at the ends of a segment.
const fn speeds(ratio: f64, is_rising: bool) -> [f64; 2] {
    if is_rising {
        [ratio, 1.0]
    } else {
        [1.0, ratio]
    }
}

/// A segment of a path between two shares of it.
fn span_of(path: &DeltaPath, shares: [f64; 2], [w0, w1]: [f64; 2]) -> Span<[f64; 3]> {
    let [from, to] = shares.map(|share| share * path.length());
    let duration_s = 2.0 * (to - from) / (w0 + w1);
    let row = |s: f64, speed: f64| {
        let point = path.point(s).unwrap();
        Row {
            time_s: 0.0,
            duration_s,
            position: point.position,
            velocity: point.slope.map(|slope| slope * speed),
            leg: 0,
            s,
        }
    };
    Span {
        s: [from, to],
        rows: [row(from, w0), row(to, w1)],
    }
}

fn cubics(span: &Span<[f64; 3]>) -> [Cubic; 3] {
    let [from, to] = &span.rows;
    let mut cubics = Cubic::between(from, to);
    [(); 3].map(|()| cubics.next().unwrap())
}

/// How far the platform is from the curve at most on a segment, at 1000 places.
fn measured(delta: &Delta, curve: &Curve<3>, span: &Span<[f64; 3]>) -> f64 {
    let (cubics, s) = (cubics(span), span.s);
    let places = (0..=1000).map(|number| {
        let share = f64::from(number) / 1000.0;
        let angles = Vector3::from(cubics.map(|cubic| cubic.position(share)));
        let platform = delta.forward(angles).unwrap();
        let mut at = s[0] + (s[1] - s[0]) * share;
        let mut off = Vector3::zeros();
        for _ in 0..4 {
            let there = curve.at(at);
            off = platform - Point3::from(there.point);
            at = (at + off.dot(&Vector3::from(there.tangent))).clamp(0.0, curve.length());
        }
        off.norm()
    });
    places.fold(0.0, f64::max)
}

/// Some accuracy whatever the time.
fn within(max_departure: f64) -> Accuracy {
    Accuracy {
        min_segments: 4,
        max_departure,
        max_time_ratio: f64::INFINITY,
    }
}

/// Random curves within a tolerance: the platform keeps it, limits are kept by the extremes of the
/// cubics, and the bound is at most three times what is measured.
#[test]
fn the_platform_keeps_the_tolerance_and_the_bound_is_near() {
    const TOLERANCE: f64 = 0.01;
    let machines = [thesis(), thesis().with_zero(FRAC_PI_2).unwrap()];
    let mut ratios = Vec::new();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut knots = vec![Knot::default(); 5000];
    for number in 0..60 {
        let curve = any_curve().new_tree(&mut runner).unwrap().current();
        let delta = &machines[number % 2];
        let Ok(path) = delta.path(curve.with_tool(FEED)) else {
            continue;
        };
        let departure = DeltaPath::departure;
        let table = Table::plan_within([path], [ARM; 3], within(TOLERANCE), departure, &mut knots);
        let (mut bound, mut worst) = (0.0_f64, 0.0_f64);
        for span in table.unwrap().spans() {
            for cubic in cubics(&span) {
                assert!(cubic.peak_speed() <= ARM.speed * MARGIN);
                let [a0, a1] = cubic.accelerations();
                assert!(a0.abs().max(a1.abs()) <= ARM.acceleration * MARGIN);
            }
            path.check(&span).unwrap();
            let off = measured(delta, path.curve(), &span);
            let most = path.departure(&span);
            assert!(off <= most, "{off} {most}");
            (bound, worst) = (bound.max(most), worst.max(off));
        }
        assert!(bound <= TOLERANCE);
        ratios.push(bound / worst);
    }
    ratios.sort_by(f64::total_cmp);
    let of = |share: usize| ratios[(ratios.len() - 1) * share / 100];
    println!(
        "bound over measured on {} paths: median {:.2}, 90 % {:.2}, most {:.2}",
        ratios.len(),
        of(50),
        of(90),
        of(100)
    );
    assert!(ratios.len() >= 20 && of(100) <= 3.0, "{ratios:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Whatever the speeds at the ends of a segment, as after a change of the feed or a hold: the
    /// bound holds.
    #[test]
    fn the_bound_holds_for_any_speeds(
        curve in any_curve(),
        from in 0.0..0.95_f64,
        share in 0.001..0.3_f64,
        ratio in 0.0..1.0_f64,
        is_rising: bool,
    ) {
        let delta = thesis().with_z(ZAxis::Up);
        let Ok(path) = delta.path(curve) else { return Ok(()) };
        let span = span_of(&path, [from, (from + share).min(1.0)], speeds(ratio, is_rising));
        let bound = path.departure(&span);
        if bound.is_finite() {
            prop_assert!(measured(&delta, &curve, &span) <= bound + ROUNDING);
        }
        // Short segments can be told.
        let is_short = share * curve.length() < 2.0;
        prop_assert!(bound.is_finite() || !is_short || bound > 1.0);
    }

    /// A segment that may be run takes no wrist farther beside its arm than the ball joints let it,
    /// where they let it go a little farther than the curve does.
    #[test]
    fn ball_joints_are_kept_all_along_a_segment(
        curve in any_curve(),
        from in 0.0..0.95_f64,
        share in 0.001..1.0_f64,
        ratio in 0.0..1.0_f64,
        is_rising: bool,
        more in (-5.0..-1.5_f64).prop_map(|power| 10.0_f64.powf(power)),
    ) {
        let free = thesis().with_z(ZAxis::Up);
        let Ok(path) = free.path(curve) else { return Ok(()) };
        let swivels = (0..=200).map(|number| {
            let point = curve.at(curve.length() * f64::from(number) / 200.0).point;
            swivel(&free, point.into())
        });
        let delta = free.with_ball_joints(swivels.fold(more, f64::max) + more).unwrap();
        let span = span_of(&path, [from, (from + share).min(1.0)], speeds(ratio, is_rising));
        let Ok(path) = delta.path(curve) else { return Ok(()) };
        if path.check(&span).is_err() {
            return Ok(());
        }
        let cubics = cubics(&span);
        for number in 0..=200 {
            let angles = cubics.map(|cubic| cubic.position(f64::from(number) / 200.0));
            let platform = free.forward(angles).unwrap();
            let found = delta.inverse(platform);
            prop_assert!(found.is_ok(), "{found:?}");
            prop_assert!((found.unwrap() - Vector3::from(angles)).norm() < 1e-9);
        }
    }

    /// The arms bring the platform to the curve, and the slopes are theirs.
    #[test]
    fn slopes_are_derivatives(curve in any_curve()) {
        let delta = thesis();
        let Ok(path) = delta.path(curve) else { return Ok(()) };
        for number in 0..20 {
            let s = curve.length() * (f64::from(number) + 0.5) / 20.0;
            let point = path.point(s).unwrap();
            let platform = delta.forward(point.position).unwrap();
            prop_assert!((platform - Point3::from(curve.at(s).point)).norm() < 1e-9);
            if point.slope.iter().all(|slope| slope.abs() < 0.03) {
                let [before, after] = [s - STEP, s + STEP].map(|s| path.point(s).unwrap().position);
                for arm in 0..3 {
                    let slope = (after[arm] - before[arm]) / (2.0 * STEP);
                    prop_assert!((slope - point.slope[arm]).abs() < DIFFERENCES);
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_followed_is_refused_with_its_place() {
    let delta = thesis();
    // Over the edge: the first place without clearance.
    let out = delta.path(line([0.0, 0.0, -250.0], [400.0, 0.0, -250.0]));
    let Err(DeltaPathError::Edge { s, point, .. }) = out else {
        panic!("{out:?}")
    };
    assert!((point.x - s).abs() < ROUNDING && delta.clearance(point) < 1e-3);
    assert!(delta.is_reachable(point));
    let error = delta
        .path(line([400.0, 0.0, -250.0], [0.0, 0.0, -250.0]))
        .unwrap_err();
    let DeltaPathError::Unreachable { s, reason, .. } = error else {
        panic!("{error}")
    };
    assert!(s <= 0.0 && matches!(reason, InverseError::TooFar { .. }));
    assert!(
        error
            .to_string()
            .starts_with("at 0 of the curve, (400, 0, -250): out of reach")
    );
    // A joint range, met on the way.
    let at = |x: f64| Point3::new(x, 0.0, -250.0);
    let angle = delta.inverse(at(60.0)).unwrap()[0];
    let range = ArmRange::new(angle - 4.0, angle).unwrap();
    let limited = delta.with_range(range);
    let stopped = limited.path(line([0.0, 0.0, -250.0], [100.0, 0.0, -250.0]));
    let Err(DeltaPathError::Edge { s, .. }) = stopped else {
        panic!("{stopped:?}")
    };
    assert!(s < 60.0 + 1e-3, "{s}");
    // A segment too long to tell, and one on which a range is passed.
    let path = limited
        .path(line([0.0, 0.0, -250.0], [10.0, 0.0, -250.0]))
        .unwrap();
    let long = turning([angle - 0.01, angle - 3.0]);
    assert!(path.departure(&long).is_infinite());
    assert_eq!(path.check(&long), Ok(()));
    let Err(DeltaPathError::Range { s, arm, .. }) = path.check(&turning([angle - 0.01; 2])) else {
        panic!()
    };
    assert_eq!((s, arm), ([0.0, 10.0], Arm::First));
    let free = limited.with_ball_joints(0.6).unwrap();
    let path = free.path(line([0.0, 0.0, -250.0], [10.0, 0.0, -250.0]));
    assert!(matches!(
        path.unwrap().check(&long),
        Err(DeltaPathError::TooCoarse { .. })
    ));
    let mut knots = [Knot::default(); 9];
    let path = limited.path(line([0.0, 0.0, -250.0], [10.0, 0.0, -250.0]));
    let departure = DeltaPath::departure;
    let table = Table::plan_within(path, [ARM; 3], within(1e-6), departure, &mut knots);
    assert!(matches!(table, Err(PlanError::Memory { .. })));
}

/// All arms from one angle to another in a second, at 0.1 rad/s forth and back at the ends.
fn turning(angles: [f64; 2]) -> Span<[f64; 3]> {
    let row = |angle: f64, speed: f64| Row {
        time_s: 0.0,
        duration_s: 1.0,
        position: [angle; 3],
        velocity: [speed; 3],
        leg: 0,
        s: 0.0,
    };
    let [from, to] = angles;
    Span {
        s: [0.0, 10.0],
        rows: [row(from, 0.1), row(to, -0.1)],
    }
}

/// Cubics of a coarse table go further than the path, beyond what arms and ball joints let them.
#[test]
fn planners_refuse_segments_that_pass_a_limit() {
    // Round the axis: each arm goes down and up, and its rods swivel to one side and the other.
    let circle = Curve::arc(
        [100.0, 0.0, -250.0],
        [0.0, 0.0, -250.0],
        [0.0, 1.0, 0.0],
        6.0,
    )
    .unwrap();
    let free = thesis();
    let path = free.path(circle).unwrap();
    let places = (0..=6000).map(|number| circle.length() * f64::from(number) / 6000.0);
    let angle = |s: f64| path.point(s).unwrap().position[0];
    let highest = places.clone().map(angle).fold(f64::MIN, f64::max);
    // Half a millimetre beyond where the platform is farthest beside an arm's plane.
    let swivel = (100.5_f64 / 243.0).asin();
    let range = ArmRange::new(-1.5, highest + 2e-3).unwrap();
    let machines = [
        free.with_range(range),
        free.with_ball_joints(swivel).unwrap(),
    ];
    let mut knots = vec![Knot::default(); 500];
    for delta in machines {
        let path = delta.path(circle).unwrap();
        let (mut refused, mut accepted) = (0, 0);
        for segments in [2, 3, 4, 5, 6, 8, 12, 20, 40, 80, 160, 320] {
            match Table::plan([path], [ARM; 3], |_| segments, &mut knots) {
                Ok(table) => {
                    accepted += 1;
                    for span in table.spans() {
                        let cubics = cubics(&span);
                        for number in 0..=50 {
                            let share = f64::from(number) / 50.0;
                            let angles = cubics.map(|cubic| cubic.position(share));
                            let platform = delta.forward(angles).unwrap();
                            let found = delta.inverse(platform).unwrap();
                            assert!((found - Vector3::from(angles)).norm() < 1e-9);
                        }
                    }
                }
                Err(PlanError::Path { reason, .. }) => {
                    assert!(matches!(
                        reason,
                        DeltaPathError::Range { .. }
                            | DeltaPathError::BallJoint { .. }
                            | DeltaPathError::TooCoarse { .. }
                    ));
                    refused += 1;
                }
                Err(PlanError::TooCoarse { .. }) => {}
                Err(error) => panic!("{error}"),
            }
        }
        println!("{refused} refused, {accepted} accepted");
        assert!(refused > 0 && accepted > 2, "{refused} {accepted}");
    }
}

/// Up, over, down in one go: the machine rests at both ends only.
#[test]
fn pick_and_place_does_not_stop_on_the_way() {
    let delta = thesis();
    let (from, to) = ([80.0, 0.0, -300.0], [-60.0, 40.0, -290.0]);
    let moves = delta
        .pick_and_place(from, to, -270.0, 3.0, Some(FEED))
        .unwrap();
    for pair in moves.windows(2) {
        let [end, start] = [pair[0].curve().end(), pair[1].curve().start()];
        assert_eq!(end.map(f64::to_bits), start.map(f64::to_bits));
    }
    let mut knots = vec![Knot::default(); 500];
    let departure = DeltaPath::departure;
    let table = Table::plan_within(moves, [ARM; 3], within(0.02), departure, &mut knots).unwrap();
    let duration_s = table.duration_s();
    let rows: Vec<_> = table.rows().collect();
    let rests = |row: &&Row<[f64; 3]>| row.velocity.iter().all(|speed| speed.abs() <= 0.0);
    assert_eq!(rows.iter().filter(rests).count(), 2);
    // With a stop at each corner it takes longer.
    let corners = [from, [80.0, 0.0, -270.0], [-60.0, 40.0, -270.0], to];
    let mut stopping_s = 0.0;
    for ends in corners.windows(2) {
        let path = delta.path(line(ends[0], ends[1]).with_tool(FEED)).unwrap();
        let table = Table::plan_within([path], [ARM; 3], within(0.02), departure, &mut knots);
        stopping_s += table.unwrap().duration_s();
    }
    println!("{duration_s} s, with stops {stopping_s} s");
    assert!(duration_s < 0.95 * stopping_s);
    // A huge tolerance still leaves three lines.
    let wide = delta.pick_and_place(from, to, -270.0, 1e3, None).unwrap();
    assert!(wide.iter().all(|path| path.length() > 1.0));
    let above = delta.pick_and_place(from, [80.0, 0.0, -310.0], -270.0, 3.0, None);
    assert!(matches!(above, Err(DeltaPathError::Curve(_))));
}

#[test]
fn a_curve_longer_than_any_in_the_workspace_is_no_endless_walk() {
    let error = thesis().path(line([0.0, 0.0, -250.0], [1e9, 0.0, -250.0]));
    assert_eq!(
        error.unwrap_err().to_string(),
        "the curve is 1e9 long, within the workspace at most 42300"
    );
}

/// A stop of the platform is one of the arms, which jump by what their motors start and stop with.
#[test]
fn a_stop_of_the_platform_stops_the_arms() {
    const JUMP: f64 = 0.3;
    let [first, second] = [
        line([-50.0, 0.0, -280.0], [0.0, 0.0, -280.0]),
        line([0.0, 0.0, -280.0], [50.0, 0.0, -280.0]),
    ];
    let turn = line([0.0, 0.0, -280.0], [0.0, 50.0, -280.0]);
    let path = |curve| thesis().path(curve).unwrap();
    let jumping = path(first).with_corner(Corner::Jump([JUMP; 3]));
    let stopped = path(first.with_corner(Corner::Stop));
    let passed_at = |paths: [DeltaPath; 2]| {
        let mut knots = [Knot::default(); 100];
        let table = Table::plan(paths, [ARM; 3], |_| 20, &mut knots).unwrap();
        // The last of the first path's rows, and the first of the second's where arms jump.
        let rows = table.rows().filter(|row| row.leg == 0 || row.s <= 0.0);
        rows.skip(20).map(|row| row.velocity).collect::<Vec<_>>()
    };
    assert_ne!(passed_at([path(first), path(second)]), [[0.0; 3]]);
    assert_eq!(passed_at([stopped, path(second)]), [[0.0; 3]]);
    assert_eq!(passed_at([path(first), path(turn)]), [[0.0; 3]]);
    let velocities = passed_at([jumping, path(turn)]);
    let [before, after] = velocities[..] else {
        panic!("{velocities:?}")
    };
    let jump =
        (before.into_iter().zip(after)).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!((jump - JUMP).abs() < 1e-9, "{jump}");
}
