//! The loop closed on the stage's scales: motors that lose steps, slides that are pushed.

use proptest::prelude::*;

use crate::rig::{Rig, STAGE, TICK_HZ};

/// More steps than a line has.
const ALL: u32 = 1 << 20;
/// Steps that a slide stands still before its motor does: 100 counts and those of two blocks at 50
/// mm/s, of a row, of what is ahead of the pins, and of the way to rest.
const MOST_STALLED: i32 = 20 + 50 + 500 + 250 + 250;

/// Homed, and at (20, 50).
fn ready() -> Rig<2> {
    let mut rig = Rig::of(STAGE, TICK_HZ, [317, 55]);
    rig.pins.count_scales();
    assert_eq!(rig.ask("home"), "done, x 0.000 y 0.000 mm, steps 0 0");
    assert!(rig.ask("line 20 50").starts_with("ok, "));
    assert!(rig.answer().starts_with("done, "));
    rig.pins.forget();
    rig
}

#[track_caller]
fn run(rig: &mut Rig<2>, command: &str) {
    let answer = rig.ask(command);
    assert!(answer.starts_with("ok, "), "{command}: {answer}");
    let answer = rig.answer();
    assert!(answer.starts_with("done, "), "{command}: {answer}");
}

#[test]
fn a_loop_with_nothing_lost_changes_no_edge() {
    let commands = ["line 119 99", "ccw 119 19 0 -40", "jog x -118", "line 0 0"];
    let [open, closed] = [false, true].map(|are_counted| {
        let mut rig = Rig::of(STAGE, TICK_HZ, [317, 55]);
        if are_counted {
            rig.pins.count_scales();
        }
        assert!(rig.ask("home").starts_with("done, "));
        let edges = commands.map(|command| {
            rig.pins.forget();
            run(&mut rig, command);
            let begin = rig.pins.changes[0].0;
            let changes = rig.pins.changes.iter();
            changes
                .map(|&(ticks, levels)| (ticks - begin, levels))
                .collect::<Vec<_>>()
        });
        assert_eq!(rig.pins.since_switch(), [0, 0]);
        edges
    });
    assert!(open == closed);
}

#[test]
fn lost_steps_are_made_again_at_the_end() {
    let mut rig = ready();
    assert_eq!(
        rig.ask("scales"),
        "x 20.000 y 50.000 mm, counts 10000 25000, corrected 0 0 steps"
    );
    rig.pins.lose(0, 7);
    rig.pins.lose(1, 2);
    run(&mut rig, "line 60 20");
    assert_eq!(rig.pins.since_switch(), [6000, 2000]);
    assert_eq!(
        rig.ask("scales"),
        "x 60.000 y 20.000 mm, counts 30000 10000, corrected 7 2 steps"
    );
    rig.pins.assert_driver_times();
    // They count nowhere.
    assert_eq!(rig.ask("where"), "x 60.000 y 20.000 mm, steps 6000 2000");
    run(&mut rig, "line 20 50");
    assert_eq!(rig.pins.since_switch(), [2000, 5000]);
    assert_eq!(rig.panel().underruns(), 0);
}

#[test]
fn a_held_line_stands_where_it_should() {
    let mut rig = ready();
    rig.pins.lose(0, 5);
    assert!(rig.ask("line 100 50").starts_with("ok, "));
    rig.play_blocks(40);
    assert_eq!(rig.ask("hold"), "ok");
    assert!(rig.answer().starts_with("held, "));
    assert_eq!(rig.pins.since_switch(), rig.panel().steps());
    assert_eq!(rig.ask("resume"), "ok");
    assert_eq!(
        rig.answer(),
        "done, x 100.000 y 50.000 mm, steps 10000 5000"
    );
    assert_eq!(rig.pins.since_switch(), [10_000, 5000]);
}

#[test]
fn a_slide_that_was_pushed_goes_back_first() {
    let mut rig = ready();
    rig.pins.push(0, 12);
    assert_eq!(
        rig.ask("scales"),
        "x 20.120 y 50.000 mm, counts 10060 25000, corrected 0 0 steps"
    );
    run(&mut rig, "jog y 1");
    assert_eq!(rig.pins.since_switch(), [2000, 5100]);
}

#[test]
fn a_motor_that_stalls_stops_the_machine_until_it_is_homed() {
    let mut rig = ready();
    rig.pins.lose(0, ALL);
    assert!(rig.ask("line 120 50").starts_with("ok, "));
    let failed = rig.answer();
    let expected = "failed, home again: x is -";
    assert!(failed.starts_with(expected), "{failed}");
    assert!(failed.ends_with(": above the alarm at 350"), "{failed}");
    let stalled = rig.panel().steps()[0] - 2000;
    assert!(stalled < MOST_STALLED, "it stood for {stalled} steps");
    rig.pins.assert_slow_end();
    rig.pins.lose(0, 0);
    assert_eq!(rig.ask("line 20 50"), "refused: not homed");
    assert_eq!(rig.ask("home"), "done, x 0.000 y 0.000 mm, steps 0 0");
    run(&mut rig, "line 20 50");
    assert_eq!(rig.pins.since_switch(), [2000, 5000]);
}

#[test]
fn a_correction_that_does_not_help_is_told() {
    let mut rig = ready();
    rig.pins.push(0, 4);
    rig.pins.lose(0, ALL);
    assert!(rig.ask("jog y 1").starts_with("ok, "));
    assert_eq!(
        rig.answer(),
        "failed, home again: x is 4 steps off after 3 corrections"
    );
    assert_eq!(rig.pins.since_switch(), [2004, 5000]);
}

#[test]
fn scales_are_read_before_home_too() {
    let mut rig = Rig::of(STAGE, TICK_HZ, [317, 55]);
    assert_eq!(rig.ask("scales"), "refused: no scales");
    rig.pins.count_scales();
    let before = rig.ask("scales");
    rig.pins.push(1, -3);
    assert_eq!(before, "counts 1585 275");
    assert_eq!(rig.ask("scales"), "counts 1585 260");
    // An arm has none.
    let mut rig = Rig::homed();
    rig.pins.count_scales();
    assert_eq!(rig.ask("scales"), "refused: no scales");
}

/// What happens to an axis, in steps that the loop corrects.
#[derive(Clone, Copy, Debug)]
enum Mishap {
    Lost(u32),
    Pushed(i32),
}

/// A motion, whether it is held or stopped after so many blocks, and what happens to an axis.
#[derive(Clone, Debug)]
struct Leg {
    command: String,
    broken_off: Option<(usize, &'static str)>,
    mishap: (usize, Mishap),
}

fn legs() -> impl Strategy<Value = Vec<Leg>> {
    let line = (5..115_i32, 5..95_i32, 10..60_i32);
    let command = prop_oneof![
        3 => line.prop_map(|(x, y, feed)| format!("line {x}.3 {y}.7 {feed}")),
        1 => (0..2_usize, -4..5_i32).prop_map(|(axis, by)| format!("jog {} {by}.5", ["x", "y"][axis])),
    ];
    let broken_off = prop::option::of((1..60_usize, prop::sample::select(vec!["hold", "stop"])));
    let mishap = prop_oneof![
        (0..16_u32).prop_map(Mishap::Lost),
        (-15..16_i32).prop_map(Mishap::Pushed),
    ];
    let leg = (command, broken_off, (0..2_usize, mishap));
    let leg = leg.prop_map(|(command, broken_off, mishap)| Leg {
        command,
        broken_off,
        mishap,
    });
    prop::collection::vec(leg, 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever is lost or pushed, at each rest the slides are where the steps say.
    #[test]
    fn slides_end_where_they_should(legs in legs()) {
        let mut rig = ready();
        for leg in legs {
            match leg.mishap {
                (axis, Mishap::Lost(steps)) => rig.pins.lose(axis, steps),
                (axis, Mishap::Pushed(steps)) => rig.pins.push(axis, steps),
            }
            let begun = rig.ask(&leg.command);
            if begun.starts_with("refused: ") {
                // A jog out of the range, or a line to where it is.
                match leg.mishap {
                    (axis, Mishap::Lost(_)) => rig.pins.lose(axis, 0),
                    (axis, Mishap::Pushed(steps)) => rig.pins.push(axis, -steps),
                }
                continue;
            }
            prop_assert!(begun.starts_with("ok, "), "{begun}");
            let broken_off = leg.broken_off.filter(|&(blocks, _)| rig.plays_blocks(blocks));
            if let Some((_, word)) = broken_off {
                prop_assert_eq!(rig.ask(word), "ok");
            }
            let mut ended = rig.answer();
            if ended.starts_with("held, ") {
                prop_assert_eq!(rig.pins.since_switch(), rig.panel().steps());
                prop_assert_eq!(rig.ask("resume"), "ok");
                ended = rig.answer();
            }
            let is_rest = ended.starts_with("done, ") || ended.starts_with("stopped, ");
            prop_assert!(is_rest, "{}: {}", leg.command, ended);
            // Fewer steps than are to be lost.
            rig.pins.lose(leg.mishap.0, 0);
            prop_assert_eq!(rig.pins.since_switch(), rig.panel().steps());
        }
        prop_assert_eq!(rig.panel().underruns(), 0);
    }
}
