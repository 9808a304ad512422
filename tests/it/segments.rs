//! `firmware/segments` against the crate's own player, step by step.

use std::io::Write;
use std::process::{Command, Stdio};

use pose2pulse::pvt_steps::{
    Direction, JoinedSegments, MinIntervals, PvtKnot, Segment, SegmentPlayer,
};

/// Rows that start, cruise, turn round and rest; one at half a step a millisecond.
fn segments() -> Vec<Segment> {
    let knot = |steps: i64, thousandths: i64| PvtKnot {
        position: steps << 32,
        velocity: (thousandths << 56) / 1000,
    };
    let rows = [
        (20_000, knot(100, 10)),
        (500_000, knot(5100, 10)),
        (40_000, knot(5200, -8)),
        (300_000, knot(2800, -8)),
        (1_000_000, knot(100, 0)),
        (3_000_000_000, knot(90, 0)),
        (50_000, knot(91, 0)),
        (50_000, knot(90, 0)),
        (1000, knot(94, 3)),
    ];
    let least = MinIntervals {
        step_ticks: 20,
        reversal_ticks: 40,
    };
    let mut axis = JoinedSegments::new(knot(0, 0), least);
    let mut segments = Vec::new();
    for (ticks, knot) in rows {
        axis.push(ticks, knot).unwrap();
        segments.extend(axis.by_ref());
    }
    axis.finish();
    segments.extend(axis);
    segments
}

#[test]
fn the_player_in_c_makes_the_same_steps() {
    let segments = segments();
    let mut bytes = Vec::new();
    let mut wanted = String::new();
    let mut ticks = 0;
    for segment in &segments {
        bytes.extend_from_slice(segment.encode(&mut [0; Segment::MAX_ENCODED_LEN]));
        let sign = if segment.direction() == Direction::Positive {
            '+'
        } else {
            '-'
        };
        let mut player = SegmentPlayer::new();
        let mut interval = Some(player.load(segment));
        while let Some(next) = interval {
            ticks += next;
            wanted.push_str(&format!("{ticks} {sign}\n"));
            interval = player.next().map(u64::from);
        }
    }
    assert!(segments.iter().any(|segment| segment.count() > 500));
    assert!(segments.iter().any(|segment| segment.count() == 1));

    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("replay");
    let compiled = Command::new("cc")
        .args([
            "-std=c99",
            "-O2",
            "-Wall",
            "-Wextra",
            "-Wconversion",
            "-Werror",
            "-o",
        ])
        .arg(&program)
        .arg(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/firmware/segments/replay.c"
        ))
        .status()
        .expect("cc, which links Rust programs too");
    assert!(compiled.success());
    let mut replay = Command::new(&program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    replay.stdin.take().unwrap().write_all(&bytes).unwrap();
    let output = replay.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(String::from_utf8(output.stdout).unwrap() == wanted);

    // A piece is no segment.
    let mut replay = Command::new(&program)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    replay
        .stdin
        .take()
        .unwrap()
        .write_all(&bytes[..bytes.len() - 1])
        .unwrap();
    assert_eq!(replay.wait().unwrap().code(), Some(1));
}
