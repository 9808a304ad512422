//! Commands, and what is said of those that are none.

use board_machine::{Command, Job, RotaryDelta, Turn, TwoLinkArm, XyStage};

fn parsed(text: &str) -> Result<Command<2>, String> {
    Command::parse::<TwoLinkArm>(text.as_bytes()).map_err(|error| error.to_string())
}

#[test]
fn commands() {
    let line = |feed_mm_s| {
        Command::Job(Job::Line {
            to_mm: [60.0, -15.5],
            feed_mm_s,
        })
    };
    let jog = |axis, by| Command::Job(Job::Jog { axis, by });
    for (text, command) in [
        ("home", Command::Job(Job::Home)),
        ("line 60 -15.5", line(None)),
        ("  line  6e1 -15.5 80\r\n", line(Some(80.0))),
        ("jog shoulder -5", jog(0, -5.0)),
        ("jog elbow 0.25", jog(1, 0.25)),
        ("hold", Command::Hold),
        ("resume", Command::Resume),
        ("stop", Command::Stop),
        ("feed 100", Command::Feed { percent: 100 }),
        ("where", Command::Where),
        ("status", Command::Status),
        ("limits", Command::Limits),
        ("machine", Command::Machine),
    ] {
        assert_eq!(parsed(text), Ok(command), "{text}");
    }
}

#[test]
fn what_is_no_command_is_named_with_its_place() {
    for (text, message) in [
        ("", "no command"),
        (" \t", "no command"),
        ("lime 1 2", "column 1: `lime` is no command"),
        ("  HOME", "column 3: `HOME` is no command"),
        ("line", "column 5: number of mm is missing"),
        ("line 1", "column 7: number of mm is missing"),
        ("line 1 2x", "column 8: `2x` is no number of mm"),
        ("line nan 2", "column 6: `nan` is no number of mm"),
        ("line 1e999 2", "column 6: `1e999` is no number of mm"),
        ("line 1 2 0", "column 10: `0` is no positive number of mm/s"),
        ("line 1 2 3 4", "column 12: `4` is too much"),
        ("jog 1", "column 5: `1` is no `shoulder` or `elbow`"),
        ("jog elbow", "column 10: number of degrees is missing"),
        (
            "feed 0",
            "column 6: `0` is no whole percentage from 1 to 100",
        ),
        (
            "feed 101",
            "column 6: `101` is no whole percentage from 1 to 100",
        ),
        ("cw 1 2 3 4", "column 1: `cw` is no command"),
        ("hold on", "column 6: `on` is too much"),
        ("\x1b[A", "column 1: `\\x1b[A` is no command"),
        (
            "a-word-that-is-very-much-too-long",
            "column 1: `a-word-that-is-v...` is no command",
        ),
    ] {
        assert_eq!(parsed(text), Err(message.into()), "{text:?}");
    }
    let message = Command::parse::<TwoLinkArm>(b"line \xFF 2").map_err(|error| error.to_string());
    assert_eq!(message, Err("column 6: `\\xff` is no number of mm".into()));
}

#[test]
fn a_delta_takes_three_coordinates_and_has_three_arms() {
    let parsed = |text: &'static str| Command::parse::<RotaryDelta>(text.as_bytes());
    let (to_mm, feed_mm_s) = ([50.0, -20.0, -280.5], Some(80.0));
    let line = Command::Job(Job::Line { to_mm, feed_mm_s });
    assert_eq!(parsed("line 50 -20 -280.5 80"), Ok(line));
    let jog = Command::Job(Job::Jog { axis: 2, by: -5.0 });
    assert_eq!(parsed("jog arm3 -5"), Ok(jog));
    for (text, message) in [
        ("line 50 -20", "column 12: number of mm is missing"),
        (
            "jog arm4 1",
            "column 5: `arm4` is no `arm1`, `arm2` or `arm3`",
        ),
        ("ccw 1 2 3 4", "column 1: `ccw` is no command"),
    ] {
        assert_eq!(
            parsed(text).map_err(|error| error.to_string()),
            Err(message.into())
        );
    }
}

#[test]
fn a_stage_takes_arcs() {
    let parsed = |text: &'static str| Command::parse::<XyStage>(text.as_bytes());
    let arc = |turn, feed_mm_s| {
        Command::Job(Job::Arc {
            turn,
            to_mm: [20.0, 30.0],
            centre_mm: [-5.0, 0.5],
            feed_mm_s,
        })
    };
    for (text, command) in [
        ("cw 20 30 -5 0.5", arc(Turn::Clockwise, None)),
        (
            "ccw 20 30 -5 .5 10",
            arc(Turn::CounterClockwise, Some(10.0)),
        ),
        ("jog y 2", Command::Job(Job::Jog { axis: 1, by: 2.0 })),
    ] {
        assert_eq!(parsed(text), Ok(command), "{text}");
    }
    for (text, message) in [
        ("cw 20 30 -5", "column 12: number of mm is missing"),
        (
            "cw 20 30 1 1 0",
            "column 14: `0` is no positive number of mm/s",
        ),
        ("jog z 2", "column 5: `z` is no `x` or `y`"),
        ("jog x a", "column 7: `a` is no number of mm"),
    ] {
        assert_eq!(
            parsed(text).map_err(|error| error.to_string()),
            Err(message.into())
        );
    }
}
