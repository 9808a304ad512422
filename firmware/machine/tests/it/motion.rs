//! The machine as a board runs it: telegrams in and out, blocks played tick by tick, switches that
//! close where they are. What comes out of the pins is compared with paths, not with the planner.

use board_machine::State;

use crate::rig::{HOME_STEPS, Rig, START_STEPS, STEPS_PER_TURN, forward, joints_of};

/// Each joint is within half a step of the path: at most so far from the line is the tool, both
/// links in a row, and the tolerance of the settings on top.
const TOOL_TOLERANCE_MM: f64 = 0.05 + 0.75 * 264.0 * std::f64::consts::TAU / STEPS_PER_TURN;

fn steps_at(joints: [f64; 2]) -> [i32; 2] {
    joints.map(|angle| (angle / std::f64::consts::TAU * STEPS_PER_TURN).round() as i32)
}

#[test]
fn home_is_where_the_switches_close() {
    let mut rig = Rig::new([317, 55]);
    assert_eq!(rig.ask("line 100 100"), "refused: not homed");
    assert!(rig.ask("home").starts_with("done, "), "{:?}", rig.log());
    assert_eq!(rig.panel().state(), State::Ready);
    assert_eq!(rig.panel().steps(), HOME_STEPS);
    // The last step of each joint has closed its switch.
    assert_eq!(rig.pins.since_switch(), [0, 0]);
    // Again, from there.
    assert!(rig.ask("home").starts_with("done, "));
    assert_eq!(rig.pins.since_switch(), [0, 0]);
}

#[test]
fn a_switch_that_is_not_there() {
    let mut rig = Rig::new([100, 1_000_000]);
    let answer = rig.ask("home");
    assert_eq!(
        answer,
        "failed: elbow: the switch has not closed within 16000 steps"
    );
    assert_eq!(rig.ask("line 100 100"), "refused: not homed");
}

#[test]
fn a_line_ends_on_its_step_and_stays_on_the_line() {
    let mut rig = Rig::homed();
    let to = [60.0, 150.0];
    let start = forward(rig.pins.joints());
    assert!(rig.ask("line 60 150").starts_with("ok, "));
    assert!(rig.answer().starts_with("done, x 60.0"), "{:?}", rig.log());
    assert_eq!(rig.panel().steps(), steps_at(joints_of(to)));
    assert_eq!(rig.pins.steps, rig.panel().steps());
    assert_eq!(rig.panel().underruns(), 0);
    rig.pins.assert_on_line(start, to, TOOL_TOLERANCE_MM);
    rig.pins.assert_driver_times();
}

#[test]
fn the_end_of_a_motion_is_told_though_an_answer_is_still_under_way() {
    let mut rig = Rig::homed();
    rig.submit_unheard("jog elbow 1");
    assert_eq!(rig.panel().state(), State::Ready);
    assert!(rig.answer().starts_with("ok, in "), "{:?}", rig.log());
    assert!(rig.answer().starts_with("done, "), "{:?}", rig.log());
}

#[test]
fn a_held_line_goes_on_and_ends_exactly() {
    let mut rig = Rig::homed();
    let to = [60.0, 150.0];
    let start = forward(rig.pins.joints());
    for (blocks, feed) in [(5, 100), (20, 40), (33, 100)] {
        rig.ask(&format!("feed {feed}"));
        assert!(rig.ask("line 60 150").starts_with("ok, "));
        rig.play_blocks(blocks);
        assert_eq!(rig.ask("hold"), "ok");
        let held = rig.answer();
        assert!(held.starts_with("held, "), "{held}");
        assert_eq!(rig.panel().state(), State::Held);
        assert_ne!(
            rig.panel().steps(),
            steps_at(joints_of(to)),
            "held too late"
        );
        assert_eq!(rig.ask("line 0 100"), "refused: held");
        rig.pins.assert_slow_end();
        assert_eq!(rig.ask("resume"), "ok");
        assert!(rig.answer().starts_with("done, x 60.0"));
        assert_eq!(rig.panel().steps(), steps_at(joints_of(to)));
        assert_eq!(rig.pins.steps, rig.panel().steps());
        assert_eq!(rig.panel().underruns(), 0);
        rig.pins.assert_on_line(start, to, TOOL_TOLERANCE_MM);
        rig.pins.assert_driver_times();
        // And back.
        rig.ask("feed 100");
        let back = format!("line {} {}", start[0], start[1]);
        assert!(rig.ask(&back).starts_with("ok, "), "{:?}", rig.log());
        assert!(rig.answer().starts_with("done, "));
        assert_eq!(rig.panel().steps(), START_STEPS);
    }
}

#[test]
fn a_stopped_line_is_over_and_the_position_known() {
    let mut rig = Rig::homed();
    rig.ask("line 60 150");
    rig.play_blocks(12);
    assert_eq!(rig.ask("stop"), "ok");
    assert!(rig.answer().starts_with("stopped, "));
    assert_eq!(rig.panel().state(), State::Ready);
    assert_eq!(rig.pins.steps, rig.panel().steps());
    rig.pins.assert_slow_end();
    let start = forward(rig.pins.joints());
    rig.pins.forget();
    // A stop is between whole steps: the next line begins where the planner is.
    assert!(rig.ask("line 60 150").starts_with("ok, "));
    assert!(rig.answer().starts_with("done, x 60.0"));
    assert_eq!(rig.panel().steps(), steps_at(joints_of([60.0, 150.0])));
    rig.pins
        .assert_on_line(start, [60.0, 150.0], TOOL_TOLERANCE_MM);
}

#[test]
fn a_stop_is_not_taken_back() {
    let mut rig = Rig::homed();
    for command in ["hold", "resume"] {
        assert!(rig.ask("line 60 150").starts_with("ok, "));
        rig.play_blocks(12);
        assert_eq!(rig.ask("stop"), "ok");
        assert_eq!(rig.ask(command), "refused: stopping");
        assert!(rig.answer().starts_with("stopped, "), "{:?}", rig.log());
        assert_eq!(rig.panel().state(), State::Ready);
    }
}

#[test]
fn a_jog_turns_one_joint() {
    let mut rig = Rig::homed();
    assert!(rig.ask("jog elbow 36").starts_with("ok, "));
    assert!(rig.answer().starts_with("done, "));
    let turned = (0.1 * STEPS_PER_TURN) as i32;
    assert_eq!(
        rig.panel().steps(),
        [START_STEPS[0], START_STEPS[1] + turned]
    );
    let answer = rig.ask("jog shoulder -61");
    assert_eq!(
        answer,
        "refused: shoulder at -91.000 degrees, not within -90.000 to 210.000"
    );
    rig.pins.assert_driver_times();
}

#[test]
fn what_cannot_be_done_is_refused_and_nothing_moves() {
    let mut rig = Rig::homed();
    for command in [
        "line 400 0",
        "line 0 0",
        "line -150 -150",
        "jog elbow 200",
        "resume",
        "hold",
    ] {
        let answer = rig.ask(command);
        assert!(answer.starts_with("refused: "), "{command}: {answer}");
        assert_eq!(rig.panel().state(), State::Ready, "{command}");
        assert_eq!(rig.pins.steps, START_STEPS, "{command}");
    }
    assert_eq!(rig.ask("line 1"), "column 7: number of mm is missing");
    assert_eq!(rig.ask("status"), "ready, feed 100 %, 0 underruns");
    assert!(rig.ask("where").ends_with("steps -1333 889"));
    assert!(
        rig.ask("limits")
            .contains("shoulder -90.0 to 210.0 degrees, 180 /s")
    );
}

#[test]
fn a_joint_beyond_its_range_is_named_with_by_how_much() {
    let mut rig = Rig::homed();
    // The elbow is at the end of its range: on, the arm would have to be straighter.
    for (line, message) in [
        (
            "line 244.33 -88.9",
            "refused: after 0.000 mm elbow is beyond 20.000 to 160.000 degrees by ",
        ),
        ("line 250 -91", "refused: after 0.000 mm elbow is beyond "),
    ] {
        let answer = rig.ask(line);
        assert!(answer.starts_with(message), "{line}: {answer}");
        let by = answer.rsplit(' ').next().unwrap();
        assert!(by.parse::<f64>().unwrap() > 0.0, "{answer}");
    }
}

#[test]
fn a_planner_that_is_late_is_seen() {
    let mut rig = Rig::homed();
    rig.ask("line 60 150");
    rig.play_blocks(10);
    rig.starve();
    assert!(rig.answer().starts_with("done, x 60.0"));
    assert_eq!(rig.panel().underruns(), 1);
    assert_eq!(
        rig.pins.steps,
        steps_at(joints_of([60.0, 150.0])),
        "nothing is lost"
    );
}
