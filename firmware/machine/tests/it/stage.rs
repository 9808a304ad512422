//! The stage: lines and arcs, by what the pins have made.

use crate::rig::{Rig, STAGE, TICK_HZ};

/// Homed, and at (20, 50).
fn ready() -> Rig<2> {
    let mut rig = Rig::of(STAGE, TICK_HZ, [317, 55]);
    assert_eq!(rig.ask("line 20 50"), "refused: not homed");
    assert_eq!(rig.ask("home"), "done, x 0.000 y 0.000 mm, steps 0 0");
    assert_eq!(rig.pins.since_switch(), [0; 2]);
    assert!(rig.ask("line 20 50").starts_with("ok, 53.852 mm in "));
    assert_eq!(rig.answer(), "done, x 20.000 y 50.000 mm, steps 2000 5000");
    rig.pins.forget();
    rig
}

#[test]
fn lines_stay_on_the_line_and_keep_their_feed() {
    let mut rig = ready();
    let from = rig.pins.tool();
    let answer = rig.ask("line 100 80 20");
    // 85.44 mm at 20 mm/s, and the ramps.
    assert!(answer.starts_with("ok, 85.440 mm in 4.3"), "{answer}");
    assert_eq!(
        rig.answer(),
        "done, x 100.000 y 80.000 mm, steps 10000 8000"
    );
    rig.pins
        .assert_on_line(from, [100.0, 80.0], STAGE.tolerance_mm);
    rig.pins.assert_driver_times();
    assert_eq!(rig.panel().underruns(), 0);
}

#[test]
fn arcs_stay_on_the_circle_and_end_where_they_should() {
    let mut rig = ready();
    let cases = [
        // All round about (60, 50), both ways.
        ("ccw 20 50 40 0", [60.0, 50.0], 40.0, 251.327),
        ("cw 20 50 40 0 50", [60.0, 50.0], 40.0, 251.327),
        // Half round, a quarter on, and three quarters back.
        ("ccw 100 50 40 0", [60.0, 50.0], 40.0, 125.664),
        ("ccw 60 90 -40 0", [60.0, 50.0], 40.0, 62.832),
        ("ccw 100 50 0 -40", [60.0, 50.0], 40.0, 188.496),
        ("cw 60 10 -40 0", [60.0, 50.0], 40.0, 62.832),
    ];
    for (command, centre, radius, length) in cases {
        rig.pins.forget();
        let answer = rig.ask(command);
        assert!(
            answer.starts_with(&format!("ok, {length:.3} mm in ")),
            "{command}: {answer}"
        );
        let done = rig.answer();
        let end: Vec<_> = command.split(' ').skip(1).take(2).collect();
        let there = format!("done, x {}.000 y {}.000 mm", end[0], end[1]);
        assert!(done.starts_with(&there), "{command}: {done}");
        rig.pins
            .assert_on_circle(centre, radius, STAGE.tolerance_mm);
        rig.pins.assert_driver_times();
    }
    assert_eq!(rig.panel().underruns(), 0);
}

#[test]
fn a_held_arc_goes_on_and_a_stopped_one_is_over() {
    let mut rig = ready();
    assert!(rig.ask("cw 20 50 40 0").starts_with("ok, "));
    rig.play_blocks(20);
    assert_eq!(rig.ask("hold"), "ok");
    assert!(rig.answer().starts_with("held, "), "{:?}", rig.log());
    rig.pins.assert_slow_end();
    assert_eq!(rig.ask("resume"), "ok");
    assert_eq!(rig.answer(), "done, x 20.000 y 50.000 mm, steps 2000 5000");
    assert!(rig.ask("ccw 20 50 40 0").starts_with("ok, "));
    rig.play_blocks(20);
    assert_eq!(rig.ask("stop"), "ok");
    assert!(rig.answer().starts_with("stopped, "), "{:?}", rig.log());
    // While it brakes it may leave the arc by a little more.
    let tolerance_mm = STAGE.tolerance_mm + 0.005;
    rig.pins.assert_on_circle([60.0, 50.0], 40.0, tolerance_mm);
    assert_eq!(rig.pins.steps, rig.panel().steps());
}

#[test]
fn what_cannot_be_done_is_refused_with_where() {
    let mut rig = ready();
    for (command, message) in [
        (
            "cw 40 50 10.02 0",
            "refused: the end is 0.0400 mm off the circle, 0.0100 are allowed",
        ),
        (
            "cw 20 50 0 0",
            "refused: a curve of the length 0 has no direction",
        ),
        (
            "jog x -20.5",
            "refused: x at -0.500 mm, not within 0.000 to 120.000",
        ),
    ] {
        assert_eq!(rig.ask(command), message, "{command}");
    }
    for (command, where_to) in [
        ("line 130 50", " mm x is beyond 0.000 to 120.000 mm by "),
        ("line 20 -0.5", " mm y is beyond 0.000 to 100.000 mm by "),
    ] {
        let answer = rig.ask(command);
        assert!(answer.starts_with("refused: after "), "{command}: {answer}");
        assert!(answer.contains(where_to), "{command}: {answer}");
    }
    // The ends are within, what is between is not.
    let answer = rig.ask("ccw 20 60 0 5");
    assert!(answer.starts_with("ok, "), "{answer}");
    assert!(rig.answer().starts_with("done, "));
    let answer = rig.ask("cw 20 40 0 -10");
    assert!(answer.starts_with("ok, "), "{answer}");
    assert!(rig.answer().starts_with("done, "));
    let answer = rig.ask("cw 20 60 10 10");
    assert!(answer.starts_with("ok, "), "{answer}");
    assert!(rig.answer().starts_with("done, "));
    rig.pins.forget();
    let answer = rig.ask("cw 20 20 100 -20");
    assert!(answer.contains(" is beyond "), "{answer}");
    assert!(rig.pins.made.is_empty());
    assert_eq!(rig.ask("machine"), "stage");
    assert_eq!(
        rig.ask("limits"),
        "x 0.0 to 120.0 mm, 50 /s, 500 /s2, y 0.0 to 100.0 mm, 50 /s, 500 /s2"
    );
}
