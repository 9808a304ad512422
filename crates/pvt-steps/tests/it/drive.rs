//! From paths to steps in one call: as its parts do it one by one.

use core::f64::consts::TAU;

use path_timing::{
    AxisLimits, Corner, Curve, Knot, LookAhead, PlanError, Smoothed, ToolLimits, Vertex,
    segments_within,
};
use pvt_steps::{
    Direction, Drive, DriveError, PvtQuantiser, PvtSteps, Rate, ScaleError, Step, StepDirTiming,
    StepScale,
};
use scara_kin::{Arm, ArmPath, Elbow};

const LIMITS: AxisLimits = AxisLimits {
    speed: 100.0,
    acceleration: 2000.0,
    jerk: None,
};
const STEPS_PER_MM: f64 = 80.0;
const TOLERANCE_MM: f64 = 0.01;

fn rate() -> Rate {
    Rate::from_hz(1_000_000).unwrap()
}

fn drive() -> Drive<2> {
    Drive::new([LIMITS; 2], [STEPS_PER_MM; 2], rate()).unwrap()
}

/// A line, and an arc that it goes on to.
fn curves() -> [Curve<2>; 2] {
    [
        Curve::line([0.0, 0.0], [40.0, 0.0]).unwrap(),
        Curve::arc([40.0, 0.0], [40.0, 10.0], [1.0, 0.0], 4.0).unwrap(),
    ]
}

fn steps(drive: &mut Drive<2>) -> Vec<Step> {
    let steps = drive.along(curves(), TOLERANCE_MM, Curve::departure);
    steps.map(Result::unwrap).collect()
}

/// Where steps from 0 lead.
fn end(steps: &[Step]) -> [i32; 2] {
    steps.iter().fold([0; 2], |mut at, step| {
        at[step.axis] += match step.direction {
            Direction::Positive => 1,
            Direction::Negative => -1,
        };
        at
    })
}

const DEFAULT: usize = 64;

#[test]
fn it_is_its_parts_one_after_the_other() {
    let mut window = [Knot::default(); DEFAULT];
    let segments = |curve: &Curve<2>| segments_within(curve, 64, TOLERANCE_MM, Curve::departure);
    let mut rows = LookAhead::new(curves(), [LIMITS; 2], segments, &mut window).unwrap();
    let first = rows.next().unwrap().unwrap();
    let scale = StepScale::new(STEPS_PER_MM).unwrap();
    let mut quantiser = PvtQuantiser::new(rate(), [scale; 2], first.position).unwrap();
    let timing = StepDirTiming::DRV8825.min_intervals(rate());
    let mut edges = PvtSteps::new(quantiser.knots(), timing);
    let mut wanted = Vec::new();
    for row in rows.map(Result::unwrap) {
        let row = quantiser.row(row.time_s, row.position, row.velocity);
        edges.push(&row.unwrap()).unwrap();
        wanted.extend(&mut edges);
    }
    let found = steps(&mut drive());
    assert!(found.len() > 5000 && found == wanted);
}

/// Ends where the path ends, from tick 0 each time; back again too.
#[test]
fn it_goes_there_and_back() {
    let mut drive = drive();
    let there = steps(&mut drive);
    let [x, y] = curves()[1].end().map(|mm| mm * STEPS_PER_MM);
    let [found_x, found_y] = end(&there).map(f64::from);
    assert!((found_x - x).abs() <= 0.5 && (found_y - y).abs() <= 0.5);
    let [x, y] = curves()[1].end();
    let home = Curve::line([x, y], [0.0, 0.0]).unwrap();
    let back = drive.along([home], TOLERANCE_MM, Curve::departure);
    let back: Vec<_> = back.map(Result::unwrap).collect();
    assert!(back[0].ticks < there[there.len() - 1].ticks);
    assert_eq!(end(&back), end(&there).map(|steps| -steps));
}

/// The corner says by how much the velocities may jump, and turn round.
#[test]
fn corners_with_jumps_are_passed() {
    let points = [[0.0, 0.0], [10.0, 1.0], [4.0, 3.0], [4.0, -2.0], [9.0, 0.0]];
    let lines = |corner| {
        let line = |ends: &[[f64; 2]]| Curve::line(ends[0], ends[1]).unwrap().with_corner(corner);
        points.windows(2).map(line).collect::<Vec<_>>()
    };
    let last = |corner| {
        let mut drive = drive();
        let steps = drive.along(lines(corner), TOLERANCE_MM, Curve::departure);
        let steps: Vec<_> = steps.map(Result::unwrap).collect();
        assert_eq!(end(&steps), [720, 0]);
        steps[steps.len() - 1].ticks
    };
    let [jumps, stops] = [Corner::Jump([5.0; 2]), Corner::Stop].map(last);
    assert!(jumps < stops, "{jumps} {stops}");
}

/// 40 mm at 0.02 mm/s last 2,000 s, a row of them far more than 2^32 ticks.
#[test]
fn a_slow_line_has_rows_of_any_time() {
    const FEED: f64 = 0.02;
    let rate = Rate::from_hz(72_000_000).unwrap();
    let mut drive = Drive::new([LIMITS; 2], [STEPS_PER_MM; 2], rate).unwrap();
    let tool = ToolLimits {
        feed: FEED,
        acceleration: None,
    };
    let [line, arc] = curves().map(|curve| curve.with_tool(tool));
    let all_s = (line.length() + arc.length()) / FEED;
    let steps = drive.along([line, arc], TOLERANCE_MM, Curve::departure);
    let steps: Vec<_> = steps.map(Result::unwrap).collect();
    let seconds = |ticks: u64| f64::from(u32::try_from(ticks >> 8).unwrap()) * 256.0 / 72e6;
    let last_s = seconds(steps[steps.len() - 1].ticks);
    assert!((last_s / all_s - 1.0).abs() < 1e-3, "{last_s} {all_s}");
    // Gone along evenly, whatever the parts: from the first steps to the end of the line.
    for pair in steps[100..3200].windows(2) {
        let gap_s = seconds(pair[1].ticks - pair[0].ticks);
        assert!((gap_s * FEED * STEPS_PER_MM - 1.0).abs() < 1e-4, "{gap_s}");
    }
}

/// More knots in sight are never slower, fewer brake earlier.
#[test]
fn a_wider_window_is_no_slower() {
    let last = |steps: Vec<Step>| steps[steps.len() - 1].ticks;
    let few = {
        let mut drive = drive().with_knots::<6>();
        let steps = drive.along(curves(), TOLERANCE_MM, Curve::departure);
        steps.map(Result::unwrap).collect()
    };
    let (few, many) = (last(few), last(steps(&mut drive())));
    assert!(many < few, "{many} {few}");
}

const JOINT: AxisLimits = AxisLimits {
    speed: 3.0,
    acceleration: 30.0,
    jerk: None,
};

/// The ticks that an arm takes along curves on the plane.
fn of_the_arm(
    curves: impl IntoIterator<Item = Curve<2>>,
    tolerance_mm: f64,
    joint: AxisLimits,
) -> f64 {
    let arm = Arm::new(132.0, 132.0).unwrap();
    let mut drive = Drive::new([joint; 2], [32_000.0 / TAU; 2], rate()).unwrap();
    let paths = curves
        .into_iter()
        .map(|curve| arm.path(curve, Elbow::Right).unwrap());
    let steps = drive.along(paths, tolerance_mm, ArmPath::departure);
    let last = steps.map(Result::unwrap).last().unwrap();
    f64::from(u32::try_from(last.ticks).unwrap())
}

/// A larger tolerance takes fewer segments, but never so few that the line takes longer.
#[test]
fn a_larger_tolerance_costs_no_time() {
    const MAX_RATIO: f64 = 1.01;
    let lines = [
        [[-80.0, 100.0], [80.0, 100.0]],
        [[200.0, 20.0], [-40.0, 230.0]],
        [[0.0, 60.0], [0.0, 200.0]],
        [[100.0, 100.0], [110.0, 102.0]],
    ];
    for [from, to] in lines {
        let ticks =
            |tolerance_mm| of_the_arm([Curve::line(from, to).unwrap()], tolerance_mm, JOINT);
        let least = ticks(0.01);
        for tolerance_mm in [0.1, 1.0] {
            let ratio = ticks(tolerance_mm) / least;
            assert!(
                ratio <= MAX_RATIO,
                "{from:?} {to:?} {tolerance_mm}: {ratio}"
            );
        }
    }
}

/// Hairpins are passed next to rest: the paths beside them need segments to be fast between.
#[test]
fn a_larger_tolerance_costs_no_time_beside_hairpins() {
    const MAX_RATIO: f64 = 1.01;
    let hairpins = [
        (
            [[128.53, -25.48], [125.98, -28.05], [125.53, -25.48]],
            7.12,
            27.7,
        ),
        (
            [[145.43, -11.63], [142.49, -6.16], [135.92, -8.01]],
            6.48,
            22.1,
        ),
        (
            [[152.99, -33.56], [150.62, -31.27], [153.86, -30.65]],
            4.94,
            17.9,
        ),
    ];
    for (points, speed, acceleration) in hairpins {
        let joint = AxisLimits {
            speed,
            acceleration,
            jerk: None,
        };
        let mut vertices = [Vertex::default(); 24];
        let smoothed = Smoothed::new(points, 0.1, &mut vertices).unwrap();
        let curves: Vec<_> = smoothed.map(Result::unwrap).collect();
        let ticks = |tolerance_mm| of_the_arm(curves.iter().copied(), tolerance_mm, joint);
        let ratio = ticks(0.05) / ticks(0.002);
        assert!(ratio <= MAX_RATIO, "{points:?}: {ratio}");
    }
}

/// A quarter of a circle as 628 points of three decimals: the window sees as far as along an arc,
/// nearly so under jerk.
#[test]
fn dense_points_are_as_fast_as_the_arc() {
    let radius_mm = 40.0;
    let points = (0..=628).map(|n| {
        let (sin, cos) = (TAU / 4.0 * f64::from(n) / 628.0).sin_cos();
        [cos, sin].map(|x| (1000.0 * (100.0 + radius_mm * x)).round() / 1000.0)
    });
    let mut vertices = [Vertex::default(); 24];
    let smoothed = Smoothed::new(points, TOLERANCE_MM, &mut vertices).unwrap();
    let smoothed: Vec<_> = smoothed.map(Result::unwrap).collect();
    let [start, centre] = [[100.0 + radius_mm, 100.0], [100.0, 100.0]];
    let arc = Curve::arc(start, centre, [0.0, 1.0], TAU / 4.0).unwrap();
    for (jerk, max_ratio) in [(None, 1.03), (Some(1200.0), 1.1)] {
        let joint = AxisLimits { jerk, ..JOINT };
        let found = of_the_arm(smoothed.iter().copied(), TOLERANCE_MM, joint);
        let ratio = found / of_the_arm([arc], TOLERANCE_MM, joint);
        assert!(ratio <= max_ratio, "{jerk:?}: {ratio}");
    }
}

/// A tool that may not speed up as its axes can brakes on a longer way, of which the window has to
/// see all: short lines one behind the other take the time of the whole, v/a + L/v.
#[test]
fn the_window_sees_the_way_that_a_tool_brakes_on() {
    const TOOL: ToolLimits = ToolLimits {
        feed: 60.0,
        acceleration: Some(100.0),
    };
    let lines = (0..30).map(|n| {
        let x = 4.0 * f64::from(n);
        let line = Curve::line([x, 0.0], [x + 4.0, 0.0]).unwrap();
        line.with_corner(Corner::Smooth).with_tool(TOOL)
    });
    let mut drive = drive();
    let steps = drive.along(lines, TOLERANCE_MM, Curve::departure);
    let last = steps.last().unwrap().unwrap();
    let shortest_s = 60.0 / 100.0 + 120.0 / 60.0;
    let ticks = f64::from(u32::try_from(last.ticks).unwrap());
    let ratio = ticks * 1e-6 / shortest_s;
    assert!((0.99..1.03).contains(&ratio), "{ratio}");
}

/// From rest the acceleration comes in time: two segments of each line would make it jump, and
/// take a tenth less time than the limit of jerk allows.
#[test]
fn short_lines_with_stops_heed_jerk() {
    const MIN_RATIO: f64 = 0.95;
    let corners = (0..10_u32).map(|n| [100.0 + f64::from(n), 100.0 + f64::from(n % 2)]);
    let corners: Vec<_> = corners.collect();
    let lines = corners
        .windows(2)
        .map(|pair| Curve::line(pair[0], pair[1]).unwrap());
    let lines: Vec<_> = lines.collect();
    let joint = AxisLimits {
        jerk: Some(1200.0),
        ..JOINT
    };
    let found = of_the_arm(lines.iter().copied(), TOLERANCE_MM, joint);
    // In as many segments as a small tolerance asks for.
    let fine = of_the_arm(lines, 1e-6, joint);
    let ratio = found / fine;
    assert!((MIN_RATIO..1.01).contains(&ratio), "{ratio}");
}

/// Corners 2 mm apart, rounded within 0.05 mm: as fast as in 64 segments each.
#[test]
fn a_turn_has_as_many_segments_as_it_needs() {
    const MAX_RATIO: f64 = 1.01;
    let points = (0..20_u32).map(|n| [2 * n.div_ceil(2), 2 * (n / 2)].map(f64::from));
    let mut vertices = [Vertex::default(); 24];
    let smoothed = Smoothed::new(points, 0.05, &mut vertices).unwrap();
    let curves: Vec<_> = smoothed.map(Result::unwrap).collect();
    let mut window = [Knot::default(); 1024];
    let segments = |_: &Curve<2>| Ok(64);
    let rows = LookAhead::new(curves.clone(), [LIMITS; 2], segments, &mut window).unwrap();
    let least_s = rows.map(|row| row.unwrap().time_s).last().unwrap();
    let mut drive = drive();
    let steps = drive.along(curves, 0.05, Curve::departure);
    let last = steps.map(Result::unwrap).last().unwrap();
    let found_s = f64::from(u32::try_from(last.ticks).unwrap()) / f64::from(rate().numerator());
    let ratio = found_s / least_s;
    assert!((0.99..MAX_RATIO).contains(&ratio), "{ratio}");
}

#[test]
fn what_is_wrong_is_named_in_place_of_a_step() {
    let refused = Drive::new([LIMITS; 2], [80.0, 0.0], rate()).unwrap_err();
    let error = ScaleError::Scale {
        steps_per_unit: 0.0,
    };
    assert_eq!(refused, DriveError::Scale { axis: 1, error });
    assert!(refused.to_string().starts_with("axis 1: 0 steps per unit"));
    let slow = AxisLimits {
        speed: f64::NAN,
        ..LIMITS
    };
    let mut drive = Drive::new([LIMITS, slow], [80.0; 2], rate()).unwrap();
    let mut steps = drive.along(curves(), TOLERANCE_MM, Curve::departure);
    let error = steps.next().unwrap().unwrap_err();
    assert!(
        matches!(error, DriveError::Plan(PlanError::Limit { axis: 1, .. })),
        "{error}"
    );
    assert!(steps.next().is_none());
    // More steps than there are numbers.
    let mut drive = Drive::new([LIMITS; 2], [1e13; 2], rate()).unwrap();
    let mut all = drive.along(curves(), TOLERANCE_MM, Curve::departure);
    let error = all.next().unwrap().unwrap_err();
    assert!(matches!(error, DriveError::Knot(_)), "{error}");
}

/// With motors that could turn faster than their drivers take steps.
#[test]
fn no_axis_is_faster_than_its_driver() {
    let fast = AxisLimits {
        speed: 1e6,
        acceleration: 1e5,
        jerk: None,
    };
    let mut drive = Drive::new([fast; 2], [STEPS_PER_MM; 2], rate()).unwrap();
    let steps = steps(&mut drive);
    let timing = StepDirTiming::DRV8825.min_intervals(rate());
    let mut last = [None; 2];
    let mut closest = u64::MAX;
    for step in &steps {
        if let Some(before) = last[step.axis].replace(step.ticks) {
            closest = closest.min(step.ticks - before);
        }
    }
    assert!(closest >= timing.step_ticks, "{closest}");
    assert!(closest <= timing.step_ticks + 4, "{closest}: it is as fast");
}
