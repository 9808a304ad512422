//! The Delta: its three arms, and the platform by what the pins have made.

use board_machine::State;

use crate::rig::{DELTA, Rig, TICK_HZ};

/// Homed, and below, where the platform can go to all sides.
fn ready() -> Rig<3> {
    let mut rig = Rig::of(DELTA, TICK_HZ, [-150, -60, -3]);
    assert_eq!(rig.ask("line 0 0 -250"), "refused: not homed");
    let answer = rig.ask("home");
    assert_eq!(
        answer,
        "done, x 0.000 y 0.000 z -195.737 mm, arm1 90.000 arm2 90.000 arm3 90.000 degrees, \
         steps 4000 4000 4000"
    );
    assert_eq!(rig.pins.since_switch(), [0; 3]);
    rig.pins.forget();
    assert!(rig.ask("line 0 0 -250").starts_with("ok, 54.263 mm in "));
    assert!(rig.answer().starts_with("done, x 0.0"), "{:?}", rig.log());
    rig
}

#[test]
fn lines_stay_on_the_line_and_end_on_their_steps() {
    let mut rig = ready();
    for to in [
        [90.0, -40.0, -260.0],
        [90.0, -40.0, -290.0],
        [-70.0, 40.0, -260.0],
    ] {
        rig.pins.forget();
        let from = rig.pins.tool();
        let [x, y, z] = to;
        let answer = rig.ask(&format!("line {x} {y} {z} 250"));
        assert!(answer.starts_with("ok, "), "{answer}");
        assert!(rig.answer().starts_with("done, "), "{:?}", rig.log());
        rig.pins.assert_on_line(from, to, DELTA.tolerance_mm);
        rig.pins.assert_driver_times();
        assert_eq!(rig.pins.steps, rig.panel().steps());
        let end = rig.pins.tool();
        let off = end.iter().zip(to).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < DELTA.tolerance_mm, "{end:?}");
    }
    assert_eq!(rig.panel().underruns(), 0);
}

#[test]
fn a_held_line_goes_on_and_a_stopped_one_is_over() {
    let mut rig = ready();
    let from = rig.pins.tool();
    rig.pins.forget();
    assert!(rig.ask("line 90 -40 -260").starts_with("ok, "));
    rig.play_blocks(8);
    assert_eq!(rig.ask("hold"), "ok");
    assert!(rig.answer().starts_with("held, "), "{:?}", rig.log());
    rig.pins.assert_slow_end();
    assert_eq!(rig.ask("resume"), "ok");
    assert!(rig.answer().starts_with("done, x 90.0"), "{:?}", rig.log());
    rig.pins
        .assert_on_line(from, [90.0, -40.0, -260.0], DELTA.tolerance_mm);
    assert!(rig.ask("line -70 40 -260").starts_with("ok, "));
    rig.play_blocks(8);
    assert_eq!(rig.ask("stop"), "ok");
    assert!(rig.answer().starts_with("stopped, "), "{:?}", rig.log());
    assert_eq!(rig.panel().state(), State::Ready);
    rig.pins.assert_slow_end();
    assert_eq!(rig.pins.steps, rig.panel().steps());
}

#[test]
fn a_jog_turns_one_arm() {
    let mut rig = ready();
    let [first, second, third] = rig.pins.steps;
    assert!(rig.ask("jog arm2 -9").starts_with("ok, in "));
    assert!(rig.answer().starts_with("done, "));
    assert_eq!(rig.pins.steps, [first, second - 400, third]);
    let answer = rig.ask("jog arm2 90");
    assert!(answer.starts_with("refused: arm2 at 147."), "{answer}");
}

#[test]
fn what_cannot_be_done_is_refused_with_where() {
    let mut rig = ready();
    rig.pins.forget();
    for (command, message) in [
        ("line 0 0 -400", "refused: after "),
        ("line 300 0 -250", "refused: after "),
        ("line 0 0 -140", "refused: after "),
        ("jog arm1 -200", "refused: arm1 at -1"),
    ] {
        let answer = rig.ask(command);
        assert!(answer.starts_with(message), "{command}: {answer}");
    }
    assert!(rig.pins.made.is_empty());
    assert_eq!(rig.ask("machine"), "delta");
    assert_eq!(
        rig.ask("limits"),
        "radii 42.0 and 18.0, arms 120.0 and 243.0 mm, arm1 -20.0 to 120.0 degrees, 180 /s, 1500 /s2, \
         arm2 -20.0 to 120.0 degrees, 180 /s, 1500 /s2, \
         arm3 -20.0 to 120.0 degrees, 180 /s, 1500 /s2"
    );
}
