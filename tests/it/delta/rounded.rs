//! Rounded corners from rest to rest: by the times of the steps alone, and with this test's own
//! geometry.

use std::fs;

use super::{Run, STEP_MM, THESIS, asked, distance, off_line, shipped};

/// Of the shipped machine.
const CORNER_MM: f64 = 1.0;
const RATE_DEG_S: f64 = 240.0;
const ACCELERATION_DEG_S2: f64 = 3000.0;
const ALONG_MM_S2: f64 = 3000.0;

/// Second differences of each motor's steps over `span_s` to both sides of every step, in deg/s².
fn accelerations(run: &Run, motor: usize, span_s: f64) -> impl Iterator<Item = f64> {
    let degrees = run.number("/rad_per_step").to_degrees();
    let at = move |time_s: f64| {
        let after = run.steps.partition_point(|(t, _)| *t <= time_s);
        run.steps[after.max(1) - 1].1[motor]
    };
    run.steps.iter().map(move |(t, steps)| {
        let difference = at(t + span_s) - 2 * steps[motor] + at(t - span_s);
        f64::from(difference).abs() * degrees / (span_s * span_s)
    })
}

#[test]
fn arms_keep_their_limits_and_corners_their_tolerance() {
    /// Long enough that four half steps are 150 deg/s².
    const SPAN_S: f64 = 0.008;
    for name in ["pick-and-place", "spiral"] {
        let file = shipped(&format!("inputs/{name}.txt"));
        let run = Run::of(&["--input", file.to_str().unwrap()], "");
        assert_eq!(run.report["motion"], "rounded");
        let degrees = run.number("/rad_per_step").to_degrees();
        let uncertainty = 2.0 * degrees / (SPAN_S * SPAN_S);
        for motor in 0..3 {
            let worst = accelerations(&run, motor, SPAN_S).fold(0.0, f64::max);
            assert!(worst < ACCELERATION_DEG_S2 + uncertainty, "{worst}");
            let number = |of: &str| run.number(&format!("/motors/{motor}/{of}"));
            let proven =
                |of: &str| number(&format!("{of}/value")) - number(&format!("{of}/uncertainty"));
            assert!(proven("max_speed_deg_s") < RATE_DEG_S);
            let acceleration = proven("max_acceleration_deg_s2");
            assert!(
                (1000.0..ACCELERATION_DEG_S2).contains(&acceleration),
                "{acceleration}"
            );
            // From rest with the first step: 1.37 sqrt(a).
            let start = 1.37 * (ACCELERATION_DEG_S2 * degrees).sqrt();
            assert!(number("max_start_speed_deg_s/value") < start * 1.01);
            assert!(number("lost_steps") < 0.5);
            // Without ramps the same motor is asked for far more.
            let trains = |of: &str| run.number(&format!("/trains/motors/{motor}/{of}"));
            assert!(trains("max_start_speed_deg_s/value") > 5.0 * start);
            assert!(trains("max_lag_full_steps") > 2.0 * number("max_lag_full_steps"));
        }
        let asked = asked(&fs::read_to_string(&file).unwrap(), &run.answers);
        let mut corners = vec![run.place(&THESIS, [0; 3])];
        corners.extend(asked.iter().map(|(to, _)| *to));
        let (mut worst, mut line) = (0_f64, 0);
        for (_, steps) in &run.steps {
            let place = run.place(&THESIS, *steps);
            let off = |line: usize| match corners.get(line..line + 2) {
                Some(ends) => off_line(place, ends[0], ends[1]),
                None => f64::INFINITY,
            };
            // A line back is on the one before.
            if off(line + 1) <= off(line) && distance(place, corners[line + 1]) < 10.0 {
                line += 1;
            }
            worst = worst.max(off(line).min(off(line + 1)));
        }
        assert!(worst < CORNER_MM + STEP_MM, "{name}: {worst} mm");
        assert!(
            (worst - run.number("/max_path_error_mm")).abs() < 0.01,
            "{worst}"
        );
        assert!(run.number("/departure_bound_mm") <= 0.01);
        // A turn back is met, and so is the end.
        let (to, steps) = asked.last().unwrap();
        assert_eq!(run.steps.last().unwrap().1, *steps);
        assert!(distance(run.place(&THESIS, *steps), *to) < STEP_MM);
        let slower = run.number("/duration_s") / run.number("/trains/duration_s");
        assert!((1.0..1.1).contains(&slower), "{slower}");
    }
}

/// A line long enough for its feed is a trapezoid: L / v + v / a.
#[test]
fn a_line_from_rest_to_rest_takes_as_long_as_its_trapezoid() {
    let run = Run::of(
        &["--input", "-"],
        "0 0 -250\n60 0 -250 100\n-60 0 -250 100\n",
    );
    let duration_s = run.number("/duration_s");
    let [down, across, back] = [250.0 - 195.737, 60.0, 120.0];
    let feed = 100.0;
    // The corner is rounded, the turn back is a stop.
    let wanted = (down + across + back) / feed + 2.0 * feed / ALONG_MM_S2;
    assert!(
        (duration_s / wanted - 1.0).abs() < 0.02,
        "{duration_s} s, not {wanted}"
    );
}

/// What is refused is not in the path, and a place that is asked for twice is one.
#[test]
fn lines_that_go_nowhere_change_nothing() {
    let plain = Run::of(&["--input", "-"], "0 0 -250\n40 0 -250\n");
    let more = Run::of(
        &["--input", "-"],
        "0 0 -250\n0 0 -250\nhello\n0 900 0\n40 0 -250\n40 0 -250\n",
    );
    assert_eq!(plain.steps, more.steps);
    assert_eq!(
        (&more.report["moves"], &more.report["refused"]),
        (&4.into(), &2.into())
    );
    let nowhere = Run::of(&["--input", "-"], "hello\n");
    assert_eq!(nowhere.steps.len(), 1);
}

/// Points closer together than the tolerance, and there and back: a curve passes many lines, and no
/// place of it is farther from them than the tolerance.
#[test]
fn a_curve_is_measured_from_all_lines_that_it_passes() {
    const CORNER_MM: f64 = 1.0;
    let near: String = (0..200_i32)
        .map(|n| {
            let [x, y] = [n * 37 % 11, n * 53 % 7].map(|of| 10.0 + 0.05 * f64::from(of));
            format!("{x:.2} {y:.2} -280 {}\n", 20 + n % 3 * 60)
        })
        .collect();
    let spikes = "50 0 -280\n0 0 -280\n50 30 -280\n25 0 -280\n50 0 -280\n".repeat(5);
    for text in [near, spikes] {
        let run = Run::of(&["--input", "-"], &format!("0 0 -280 150\n{text}"));
        let worst = run.number("/max_path_error_mm");
        assert!(worst <= CORNER_MM + STEP_MM, "{worst} mm");
    }
}
