//! Curves as paths of the joints: the tool on the cubics that run, limits, the disc.

mod corners;
mod refusals;
mod single;

use core::cell::RefCell;
use core::f64::consts::{FRAC_PI_2, PI, TAU};

use path_timing::{
    Accuracy, AxisLimits, Cubic, Curve, Knot, Path, Row, Smoothed, Span, Table, ToolLimits, Vertex,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use scara_kin::nalgebra::{Isometry2, Point2, Vector2};
use scara_kin::{Arm, ArmPath, ArmPathError, DiscPath, Elbow, Joint, JointRange, Joints, Limits};

use crate::common::engraver;

/// Of joints and places of an arm of 264 mm, after some turns.
const ROUNDING: f64 = 1e-11;

/// Step of finite differences in mm, and what they are off by.
const STEP: f64 = 1e-4;
const DIFFERENCES: f64 = 1e-7;

/// Of what is computed anew from rounded rows.
const MARGIN: f64 = 1.0 + 1e-9;

const JOINT: AxisLimits = AxisLimits {
    speed: 3.0,
    acceleration: 30.0,
    jerk: None,
};

const FEED: ToolLimits = ToolLimits {
    feed: 100.0,
    acceleration: Some(1500.0),
};

fn line(from: [f64; 2], to: [f64; 2]) -> Curve<2> {
    Curve::line(from, to).unwrap()
}

/// Curves of all kinds, some of which an arm of 264 mm reaches.
fn any_curve() -> impl Strategy<Value = Curve<2>> {
    let coordinate = || prop::array::uniform2(-250.0..250.0_f64);
    prop_oneof![
        (coordinate(), coordinate()).prop_map(|(from, to)| line(from, to)),
        (coordinate(), coordinate(), coordinate(), 0.1..5.0_f64)
            .prop_filter_map("no arc", |(start, centre, way, angle)| {
                Curve::arc(start, centre, way, angle).ok()
            }),
        prop::array::uniform4(coordinate())
            .prop_filter_map("a cusp", |points| Curve::bezier(points).ok()),
    ]
}

/// How far the tool is from the curve at most on a segment, at 1000 places.
fn departure(arm: &Arm, curve: &Curve<2>, s: [f64; 2], cubics: [Cubic; 2]) -> f64 {
    let places = (0..=1000).map(|number| {
        let share = f64::from(number) / 1000.0;
        let [shoulder, elbow] = cubics.map(|cubic| cubic.position(share));
        let tool = arm.forward(Joints::new(shoulder, elbow));
        let mut at = s[0] + (s[1] - s[0]) * share;
        let mut off = Vector2::zeros();
        for _ in 0..5 {
            let there = curve.at(at);
            off = tool - Point2::from(there.point);
            at = (at + off.dot(&Vector2::from(there.tangent))).clamp(0.0, curve.length());
        }
        off.norm()
    });
    places.fold(0.0, f64::max)
}

fn cubics(span: &Span<[f64; 2]>) -> [Cubic; 2] {
    let [from, to] = &span.rows;
    let mut cubics = Cubic::between(from, to);
    [(); 2].map(|()| cubics.next().unwrap())
}

/// Some accuracy whatever the time.
fn within(max_departure: f64) -> Accuracy {
    Accuracy {
        min_segments: 8,
        max_departure,
        max_time_ratio: f64::INFINITY,
    }
}

/// The bound of a table, and what is measured on it; all limits are kept.
fn check(table: &Table<'_, [f64; 2]>, path: &ArmPath, arm: &Arm) -> [f64; 2] {
    table.spans().fold([0.0, 0.0], |[bound, measured], span| {
        let cubics = cubics(&span);
        for cubic in cubics {
            assert!(cubic.peak_speed() <= JOINT.speed * MARGIN);
            let [a0, a1] = cubic.accelerations();
            assert!(a0.abs().max(a1.abs()) <= JOINT.acceleration * MARGIN);
        }
        path.check(&span).unwrap();
        let off = departure(arm, path.curve(), span.s, cubics);
        let most = path.departure(&span);
        assert!(off <= most, "{off} {most}");
        [most.max(bound), off.max(measured)]
    })
}

/// Random curves within a tolerance: the tool keeps it, and the bound is at most three times what
/// is measured.
#[test]
fn the_tool_keeps_the_tolerance_and_the_bound_is_near() {
    const TOLERANCE: f64 = 0.01;
    let arms = [
        engraver(),
        Arm::new(150.0, 110.0)
            .unwrap()
            .with_base(Isometry2::new(Vector2::new(20.0, -30.0), 2.0))
            .unwrap(),
    ];
    let ratios = RefCell::new(Vec::new());
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut knots = vec![Knot::default(); 20_000];
    for number in 0..60 {
        let curve = any_curve().new_tree(&mut runner).unwrap().current();
        let arm = &arms[number % 2];
        let Ok(path) = arm.path(curve.with_tool(FEED), Elbow::Right) else {
            continue;
        };
        let table = Table::plan_within(
            [path],
            [JOINT; 2],
            within(TOLERANCE),
            ArmPath::departure,
            &mut knots,
        )
        .unwrap();
        let [bound, measured] = check(&table, &path, arm);
        assert!(bound <= TOLERANCE);
        ratios.borrow_mut().push(bound / measured);
    }
    let mut ratios = ratios.into_inner();
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

/// 0.5 mm past the base, and to a thousandth of a mm from the rim: slower, not refused.
#[test]
fn singularities_that_can_be_passed_are_passed() {
    let arm = engraver();
    let mut knots = vec![Knot::default(); 4000];
    for (from, to, duration_s) in [
        ([-200.0, 0.5], [200.0, 0.5], 4.0..6.0),
        ([0.0, 150.0], [263.999, 0.0], 3.0..6.0),
        ([100.0, -260.0], [100.0, 200.0], 0.0..0.0),
    ] {
        let Ok(path) = arm.path(line(from, to).with_tool(FEED), Elbow::Left) else {
            assert!(duration_s.is_empty());
            continue;
        };
        let table = Table::plan_within(
            [path],
            [JOINT; 2],
            within(0.05),
            ArmPath::departure,
            &mut knots,
        )
        .unwrap();
        let [bound, _] = check(&table, &path, &arm);
        assert!(bound <= 0.05);
        println!("{} rows, {} s", table.len(), table.duration_s());
        assert!(
            duration_s.contains(&table.duration_s()),
            "{}",
            table.duration_s()
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever the speeds at the ends of a segment, as after a change of the feed or a hold: the
    /// bound holds.
    #[test]
    fn the_bound_holds_for_any_speeds(
        curve in any_curve(),
        from in 0.0..0.95_f64,
        share in 0.001..0.1_f64,
        ratio in 0.0..1.0_f64,
        is_rising: bool,
    ) {
        let arm = engraver();
        let Ok(path) = arm.path(curve, Elbow::Left) else { return Ok(()) };
        let s = [from, (from + share).min(1.0)].map(|share| share * curve.length());
        let speeds = if is_rising { [ratio, 1.0] } else { [1.0, ratio] };
        let duration_s = 2.0 * (s[1] - s[0]) / (speeds[0] + speeds[1]);
        let row = |end: usize| {
            let point = path.point(s[end]).unwrap();
            Row {
                time_s: 0.0,
                duration_s,
                position: point.position,
                velocity: point.slope.map(|slope| slope * speeds[end]),
                leg: 0,
                s: s[end],
            }
        };
        let span = Span { s, rows: [row(0), row(1)] };
        let measured = departure(&arm, &curve, s, cubics(&span));
        prop_assert!(measured <= path.departure(&span) + ROUNDING);
    }

    /// Ranges that end just beyond what the joints do on a path, or just before it.
    #[test]
    fn joint_ranges_are_kept_all_along_a_path(
        curve in any_curve(),
        joint in prop_oneof![Just(Joint::Shoulder), Just(Joint::Elbow)],
        by in prop_oneof![Just(1e-6), Just(1e-3)],
        is_lower: bool,
    ) {
        let arm = engraver();
        let Ok(path) = arm.path(curve, Elbow::Right) else { return Ok(()) };
        let angle = |s: f64| {
            let Joints { shoulder, elbow } = path.joints(s).unwrap();
            if joint == Joint::Elbow { elbow } else { shoulder }
        };
        let sign = if is_lower { -1.0 } else { 1.0 };
        let place = |number: u32| curve.length() * f64::from(number) / 4000.0;
        let farthest = (0..=4000).map(place).max_by(|a, b| (sign * angle(*a)).total_cmp(&(sign * angle(*b))));
        let mut farthest = farthest.unwrap();
        let mut step = place(1);
        while step > 1e-7 {
            for near in [farthest - step, farthest + step] {
                let near = near.clamp(0.0, curve.length());
                if sign * angle(near) > sign * angle(farthest) {
                    farthest = near;
                }
            }
            step *= 0.7;
        }
        let end = angle(farthest);
        let start = path.joints(0.0).unwrap();
        let other = (0..=4000).map(|number| sign * angle(place(number))).fold(f64::MAX, f64::min);
        // Wide enough for the path, too narrow for it a turn further.
        let width = sign * end - other + 0.1;
        prop_assume!(width < 6.0);
        let refused = |end: f64| {
            let range = if is_lower { JointRange::new(end, end + width) } else { JointRange::new(end - width, end) };
            let mut limits = Limits::unlimited();
            *match joint {
                Joint::Shoulder => &mut limits.shoulder,
                Joint::Elbow => &mut limits.elbow,
            } = range.unwrap();
            arm.with_limits(limits).path_from(curve, Elbow::Right, start).err()
        };
        prop_assert_eq!(refused(end + sign * by), None);
        prop_assert!(refused(end - sign * by).is_some());
    }

    /// The joints bring the tool to the curve, go on without a jump, and the slopes are theirs.
    #[test]
    fn joints_are_continuous_and_slopes_their_derivatives(curve in any_curve(), tool_angle in -9.0..9.0_f64) {
        let arm = engraver().with_base(Isometry2::new(Vector2::new(1.0, 2.0), -2.5)).unwrap();
        let Ok(path) = arm.path(curve, Elbow::Right) else { return Ok(()) };
        let disc = path.with_disc(tool_angle).unwrap();
        let start = disc.point(0.0).unwrap().position;
        prop_assert!((start[2] - tool_angle).abs() <= PI + ROUNDING);
        let mut last = start;
        for number in 0..=400 {
            let s = curve.length() * f64::from(number) / 400.0;
            let point = disc.point(s).unwrap();
            let [shoulder, elbow, tool_angle] = point.position;
            let at = curve.at(s);
            let tool = arm.forward(Joints::new(shoulder, elbow));
            prop_assert!((tool - Point2::from(at.point)).norm() < ROUNDING);
            let along = tool_angle + shoulder + elbow - 2.5 - at.tangent[1].atan2(at.tangent[0]);
            prop_assert!((along / TAU - (along / TAU).round()).abs() < ROUNDING);
            for (now, before) in point.position.iter().zip(last) {
                prop_assert!((now - before).abs() < PI, "{s}: {now} {before}");
            }
            last = point.position;
            // Where joints are not too fast for differences.
            if number % 20 == 10 && point.slope.iter().all(|slope| slope.abs() < 0.05) {
                let [before, after] = [s - STEP, s + STEP].map(|s| disc.point(s).unwrap().position);
                for axis in 0..3 {
                    let slope = (after[axis] - before[axis]) / (2.0 * STEP);
                    prop_assert!((slope - point.slope[axis]).abs() < DIFFERENCES);
                }
            }
        }
    }
}

/// Behind the base the shoulder goes on over a half turn, and round the base over whole ones.
#[test]
fn the_shoulder_counts_its_turns() {
    let arm = engraver();
    let round = Curve::arc([200.0, 0.0], [0.0, 0.0], [0.0, 1.0], 3.0 * TAU).unwrap();
    let path = arm.path(round, Elbow::Right).unwrap();
    let [start, end] = [0.0, round.length()].map(|s| path.joints(s).unwrap());
    assert!((end.shoulder - start.shoulder - 3.0 * TAU).abs() < 1e-9);
    // The next curve begins where this one ended, turns included.
    let on = Curve::line(round.end(), [150.0, 50.0]).unwrap();
    let next = arm.path_from(on, Elbow::Right, end).unwrap();
    assert_eq!(next.joints(0.0).unwrap(), end);
    let many = Curve::arc([200.0, 0.0], [0.0, 0.0], [0.0, 1.0], 9.0 * TAU).unwrap();
    assert!(matches!(
        arm.path(many, Elbow::Right),
        Err(ArmPathError::Turns { .. })
    ));
}

/// A disc that turns slowly: a smoothed corner is passed slower, the lines are not.
#[test]
fn a_corner_that_the_disc_cannot_follow_slows_all_down() {
    let arm = engraver();
    let corners = [[100.0, 100.0], [160.0, 100.0], [160.0, 160.0]];
    let mut memory = [Vertex::default(); 8];
    let curves = Smoothed::new(corners, 0.5, &mut memory).unwrap();
    let curves: Vec<_> = curves.map(Result::unwrap).collect();
    let (mut joints, mut tool_angle) = (arm.inverse_elbow(corners[0], Elbow::Left).unwrap(), 0.0);
    let paths: Vec<_> = curves
        .iter()
        .map(|curve| {
            let path = arm
                .path_from(curve.with_tool(FEED), Elbow::Left, joints)
                .unwrap();
            let disc = path.with_disc(tool_angle).unwrap();
            joints = path.joints(curve.length()).unwrap();
            [.., tool_angle] = disc.point(curve.length()).unwrap().position;
            disc
        })
        .collect();
    let mut knots = vec![Knot::default(); 2000];
    let mut duration_s = |speed| {
        let slow = AxisLimits { speed, ..JOINT };
        let limits = [JOINT, JOINT, slow];
        let times = [0..1, 1..3, 3..4].map(|part| {
            let table = Table::plan_within(
                paths[part].iter().copied(),
                limits,
                within(0.01),
                DiscPath::departure,
                &mut knots,
            );
            table.unwrap().duration_s()
        });
        // They join to the last bit, and the corner is run without a stop.
        let table = Table::plan(paths.iter(), limits, |_| 8, &mut knots).unwrap();
        let rows = table.rows();
        assert_eq!(
            rows.filter(|row| row.velocity.iter().all(|speed| speed.abs() <= 0.0))
                .count(),
            2
        );
        times
    };
    let ([first, corner, last], [slow_first, slow_corner, slow_last]) =
        (duration_s(30.0), duration_s(0.5));
    assert!(slow_corner > FRAC_PI_2 / 0.5 && slow_corner > 5.0 * corner);
    assert!(slow_first < 2.0 * first && slow_last < 2.0 * last);
    let path = arm.path(curves[0], Elbow::Left).unwrap();
    assert!(matches!(
        path.with_disc(f64::NAN),
        Err(ArmPathError::Disc { .. })
    ));
}

/// Next to a cusp the curvature grows without bound: the disc's angle is found all the same, or
/// refused.
#[test]
fn a_disc_goes_past_a_cusp() {
    let arm = engraver();
    for off in [0.1, 1e-3, 1e-6, 1e-9, 1e-12] {
        let points = [
            [60.0, 100.0],
            [100.0, 140.0],
            [60.0 - off, 140.0],
            [100.0, 100.0],
        ];
        let Ok(curve) = Curve::bezier(points) else {
            continue;
        };
        let path = arm.path(curve, Elbow::Right).unwrap();
        let tangent = path.with_disc(0.0);
        assert!(tangent.is_ok() || off < 1e-2, "{off}");
    }
}
