//! Ramps of the stage, by the times of its steps alone.

use super::run::{Run, STEP_MM};
use super::shipped;

/// Of an axis, in mm/s²; and by what it may change its speed at once, in mm/s.
const ACCELERATION_MM_S2: f64 = 500.0;
const JUMP_MM_S: f64 = 5.0;
/// Between the three places of a second difference.
const SPAN_S: f64 = 0.04;
/// What steps are off their places on the programmed motion: 1 off the curve, half along it.
const DEVIATION_MM: f64 = 1.5 * STEP_MM;

/// The largest second difference of the steps of an axis, in mm/s².
fn acceleration(path: &[(f64, [f64; 2])], axis: usize) -> f64 {
    let at = |time_s: f64| match path.partition_point(|(t, _)| *t <= time_s) {
        0 => 0.0,
        after => path[after - 1].1[axis],
    };
    let differences = path.iter().map(|(t, _)| {
        let [before, now, after] = [t - SPAN_S, *t, t + SPAN_S].map(at);
        (after - 2.0 * now + before).abs() / (SPAN_S * SPAN_S)
    });
    differences.fold(0.0, f64::max)
}

#[test]
fn motors_follow_by_every_rule_and_stall_without_ramps() {
    let uncertainty = 4.0 * DEVIATION_MM / (SPAN_S * SPAN_S);
    let most = ACCELERATION_MM_S2 + JUMP_MM_S / SPAN_S + uncertainty;
    let runs = [
        ("test", "nearest"),
        ("rosette", "published"),
        ("link", "bresenham"),
    ];
    for (drawing, rule) in runs {
        let file = shipped(drawing);
        let run = Run::of(&["--gcode", file.to_str().unwrap(), "--rule", rule]);
        assert_eq!(run.report["profile"], "trapezoidal");
        let path = run.path();
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let worst = acceleration(&path, axis);
            assert!(worst < most, "{drawing}, {rule}: {worst} mm/s²");
            let number = |of: &str| run.number(&format!("/motors/{name}/{of}"));
            assert!(number("lost_steps") < 0.5);
            assert!(number("max_lag_full_steps") < 1.5);
            let [value, uncertainty] =
                ["value", "uncertainty"].map(|of| number(&format!("max_acceleration_mm_s2/{of}")));
            let proven = value - uncertainty;
            // Over shorter spans the jump is more; not every drawing needs all of the limit.
            assert!(
                (0.7..1.5).contains(&(proven / ACCELERATION_MM_S2)),
                "{proven}"
            );
        }
        // What it costs.
        let slower = run.number("/duration_s") / run.number("/constant_speed/duration_s");
        assert!((1.0..1.02).contains(&slower), "{drawing}: {slower}");
        let lost = |of: &str| run.number(&format!("/constant_speed/{of}/lost_steps"));
        assert!(lost("x") + lost("y") > 1000.0, "{drawing}, {rule}");
    }
}

/// The feed from the first step to the last, as before.
#[test]
fn without_ramps_the_speed_is_that_of_the_feed() {
    let run = Run::of_text("G1 X30 Y40 F1200", &["--profile", "constant"]);
    let path = run.path();
    // 50 mm at 20 mm/s.
    assert!((path.last().unwrap().0 - 2.5).abs() < 1e-3);
    let tenth = path.len() / 10;
    let gone = |at: usize| path[at].1[0].hypot(path[at].1[1]);
    for at in (0..path.len() - tenth).step_by(tenth) {
        let speed = (gone(at + tenth) - gone(at)) / (path[at + tenth].0 - path[at].0);
        assert!((speed / 20.0 - 1.0).abs() < 0.01, "{speed} mm/s");
    }
    assert!(acceleration(&path, 0) > 5.0 * ACCELERATION_MM_S2 / 10.0);
    let same = |of: &str| run.report["motors"][of] == run.report["constant_speed"][of];
    assert!(same("x") && same("y"));
}

/// Tangent arcs and lines go on at full speed; a sharp corner does not.
#[test]
fn corners_slow_down_by_their_angle() {
    let slowest = |gcode: &str, around: [f64; 2]| {
        let run = Run::of_text(gcode, &[]);
        let path = run.path();
        let near = path
            .iter()
            .enumerate()
            .filter(|(_, (_, at))| (at[0] - around[0]).hypot(at[1] - around[1]) < 0.05);
        let speeds = near.map(|(k, (t, at))| {
            let (before, from) = path[k - 8];
            (at[0] - from[0]).hypot(at[1] - from[1]) / (t - before)
        });
        speeds.fold(f64::INFINITY, f64::min)
    };
    let smooth = slowest("G1 X20 F1200\nG3 X30 Y10 J10\nG1 Y30", [20.0, 0.0]);
    assert!(smooth > 15.0, "{smooth} mm/s");
    let right = slowest("G1 X20 F1200\nG1 Y20", [20.0, 0.0]);
    assert!((3.0..10.0).contains(&right), "{right} mm/s");
    let back = slowest("G1 X20 F1200\nG1 X10", [20.0, 0.0]);
    assert!(back < right, "{back} mm/s");
}

/// The speed of an axis is a limit as well: what the stage accepts, its motors follow.
#[test]
fn no_feed_makes_the_motors_lose_steps() {
    for (text, slower) in [
        ("G1 F6000 X90\nG1 X0\n", 2),
        (
            "G1 F9000 X80 Y40\nG3 X30 Y40 I-25 J0 F9000\nG1 X0 Y0 F3000\n",
            2,
        ),
        ("G1 F3600 X90\nG1 X0\n", 0),
    ] {
        let run = Run::of_text(text, &[]);
        assert_eq!(run.report["slower_motions"], slower, "{text}");
        let lost = ["x", "y"].map(|of| run.number(&format!("/motors/{of}/lost_steps")));
        assert!(lost.iter().all(|steps| steps.abs() < 0.5), "{text}");
        // At the feed from the first step on, as published, they stall.
        let constant = Run::of_text(text, &["--profile", "constant"]);
        assert!(constant.number("/motors/x/lost_steps") > 0.5);
    }
}
