//! Commands, and what is said of those that are none.

use board_machine::{Command, Job, Joint};

fn parsed(text: &str) -> Result<Command, String> {
    Command::parse(text.as_bytes()).map_err(|error| error.to_string())
}

#[test]
fn commands() {
    let line = |feed_mm_s| {
        Command::Job(Job::Line {
            to_mm: [60.0, -15.5],
            feed_mm_s,
        })
    };
    let jog = |joint, by_deg| Command::Job(Job::Jog { joint, by_deg });
    for (text, command) in [
        ("home", Command::Job(Job::Home)),
        ("line 60 -15.5", line(None)),
        ("  line  6e1 -15.5 80\r\n", line(Some(80.0))),
        ("jog shoulder -5", jog(Joint::Shoulder, -5.0)),
        ("jog elbow 0.25", jog(Joint::Elbow, 0.25)),
        ("hold", Command::Hold),
        ("resume", Command::Resume),
        ("stop", Command::Stop),
        ("feed 100", Command::Feed { percent: 100 }),
        ("where", Command::Where),
        ("status", Command::Status),
        ("limits", Command::Limits),
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
        ("hold on", "column 6: `on` is too much"),
        ("\x1b[A", "column 1: `\\x1b[A` is no command"),
        (
            "a-word-that-is-very-much-too-long",
            "column 1: `a-word-that-is-v...` is no command",
        ),
    ] {
        assert_eq!(parsed(text), Err(message.into()), "{text:?}");
    }
    let message = Command::parse(b"line \xFF 2").map_err(|error| error.to_string());
    assert_eq!(message, Err("column 6: `\\xff` is no number of mm".into()));
}
