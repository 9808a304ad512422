//! Timed steps of the stage, judged by their times alone.

use super::run::{Run, STEP_MM};
use super::{DRAWINGS, shipped};

/// Of an axis, in mm/s²; and by what it may change its speed at once, in mm/s.
const ACCELERATION_MM_S2: f64 = 500.0;
const JUMP_MM_S: f64 = 5.0;
/// Between the three places of a second difference.
const SPAN_S: f64 = 0.04;
/// What steps are off their places on the programmed motion: 1 off the curve, half along it.
const DEVIATION_MM: f64 = 1.5 * STEP_MM;

/// Half a step of each axis, and what the cubics of the axes leave the curves.
const HALF_STEPS_MM: f64 = STEP_MM * core::f64::consts::FRAC_1_SQRT_2 + 0.001;

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
fn motors_follow_timed_steps_and_stall_at_the_feed_throughout() {
    let uncertainty = 4.0 * DEVIATION_MM / (SPAN_S * SPAN_S);
    let most = ACCELERATION_MM_S2 + JUMP_MM_S / SPAN_S + uncertainty;
    for drawing in DRAWINGS {
        let file = shipped(drawing);
        let run = Run::of(&["--gcode", file.to_str().unwrap()]);
        assert_eq!(run.report["stepping"], "timed");
        let path = run.path();
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let worst = acceleration(&path, axis);
            assert!(worst < most, "{drawing}: {worst} mm/s²");
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
        let slower = run.number("/duration_s") / run.number("/at_feed/duration_s");
        assert!((1.0..1.02).contains(&slower), "{drawing}: {slower}");
        let lost = |of: &str| run.number(&format!("/at_feed/{of}/lost_steps"));
        assert!(lost("x") + lost("y") > 1000.0, "{drawing}");
    }
}

/// The feed from the first step to the last, as before.
#[test]
fn at_the_feed_throughout_the_speed_is_that_of_the_feed() {
    let run = Run::of_text("G1 X30 Y40 F1200", &["--steps", "nearest"]);
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
    let same = |of: &str| run.report["motors"][of] == run.report["at_feed"][of];
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
        let constant = Run::of_text(text, &["--steps", "nearest"]);
        assert!(constant.number("/motors/x/lost_steps") > 0.5);
    }
}

/// A circle as a slicer writes it, in chords with three decimals.
fn chords(count: u32) -> String {
    let point = |n: u32| {
        let angle = core::f64::consts::TAU * f64::from(n) / f64::from(count);
        [50.0 + 20.0 * angle.cos(), 50.0 + 20.0 * angle.sin()]
    };
    let lines = (1..=count).map(|n| {
        let [x, y] = point(n);
        format!("G1 X{x:.3} Y{y:.3} F3000\n")
    });
    format!("G0 X70 Y50\n{}", lines.collect::<String>())
}

/// Chords take the time of the arc, and stay within the tolerance.
#[test]
fn lines_are_passed_like_the_curve_that_they_stand_for() {
    let duration_s = |text: &str, options: &[&str]| {
        let run = Run::of_text(text, options);
        let [used, allowed] = ["/smoothed_bound_mm", "/tolerance_mm"].map(|of| run.number(of));
        assert!(used <= allowed, "{used} of {allowed}");
        let worst = run.number("/max_deviation_mm");
        let most = allowed + HALF_STEPS_MM;
        assert!(worst <= most, "{worst} mm, {options:?}");
        assert_eq!(run.number("/lost_steps").to_bits(), 0);
        run.number("/duration_s")
    };
    let arc = duration_s("G0 X70 Y50\nG3 I-20 F3000\n", &[]);
    for (count, slower) in [(1000, 1.01), (250, 1.01), (63, 1.02)] {
        let taken = duration_s(&chords(count), &[]) / arc;
        assert!(taken < slower, "{count} chords: {taken}");
    }
    // Corners of 30 degrees: 0.01 mm give about the speed by which the motors may jump, more gives
    // more.
    let [corners, narrow, wide] =
        ["0", "0.01", "0.2"].map(|mm| duration_s(&chords(12), &["--tolerance", mm]));
    assert!(
        narrow < 1.02 * corners && wide < 0.9 * narrow,
        "{corners} {narrow} {wide} s"
    );
}

/// Programs round both ends of their arcs: each ends where it is programmed to, however many there
/// are.
#[test]
fn arcs_whose_ends_are_rounded_do_not_drift() {
    let mut text = String::from("G0 X60 Y50\n");
    for turn in 0..40 {
        let (out, back) = (f64::from(turn % 7) * 0.001, f64::from(turn % 5) * 0.001);
        text += &format!("G3 X{:.3} Y50 I-10.003 F1800\n", 40.0 - out);
        text += &format!("G3 X{:.3} Y50 I9.997 F1800\n", 60.0 + back);
    }
    let run = Run::of_text(&text, &[]);
    assert!(run.number("/max_deviation_mm") < 0.03);
    assert!(run.number("/closing_error_mm") < STEP_MM);
}

/// Points of few decimals: many are the same, lines go straight back, each has a feed of its own.
#[test]
fn points_on_a_grid_are_passed_to_the_last() {
    let mut state = 1_u64;
    let mut random = |below: i64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        i64::try_from(state >> 33).unwrap() % below
    };
    for (decimals, tolerance) in [(1, "0"), (2, "0.01"), (3, "0.05"), (2, "0.3")] {
        let unit = 10_f64.powi(decimals);
        let (mut text, mut at) = (String::from("G0 X60 Y50\n"), [0_i32; 2]);
        for _ in 0..60 {
            at = at.map(|x| x + i32::try_from(random(7) - 3).unwrap());
            let [x, y] = at.map(f64::from);
            let feed = [30, 300, 3000][usize::try_from(random(3)).unwrap()];
            text += &format!("G1 X{} Y{} F{feed}\n", 60.0 + x / unit, 50.0 + y / unit);
        }
        let run = Run::of_text(&text, &["--tolerance", tolerance]);
        let most = run.number("/tolerance_mm") + HALF_STEPS_MM;
        let worst = run.number("/max_deviation_mm");
        assert!(worst <= most, "{decimals} decimals: {worst} mm");
        assert!(run.number("/closing_error_mm") < HALF_STEPS_MM);
        assert_eq!(run.number("/lost_steps").to_bits(), 0);
    }
}
