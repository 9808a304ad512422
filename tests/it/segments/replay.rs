//! Decoder and player on this PC.

use std::io::Write;
use std::process::{Command, Stdio};

use super::{Wire, file, steps_of};

#[test]
fn the_player_in_c_makes_the_same_steps() {
    // Starts, cruises, turns round and rests; one at half a step a millisecond.
    let wire = Wire::of_rows(&[
        (20_000, 100, 10),
        (500_000, 5100, 10),
        (40_000, 5200, -8),
        (300_000, 2800, -8),
        (1_000_000, 100, 0),
        (3_000_000_000, 90, 0),
        (50_000, 91, 0),
        (50_000, 90, 0),
        (1000, 94, 3),
    ]);
    assert!(wire.counts.iter().any(|&count| count > 500));
    assert!(wire.counts.contains(&1));

    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("replay");
    let flags = "-std=c99 -O2 -Wall -Wextra -Wconversion -Werror -o";
    let compiled = Command::new("cc")
        .args(flags.split(' '))
        .arg(&program)
        .arg(file("extras/replay.c"))
        .status()
        .expect("cc, which links Rust programs too");
    assert!(compiled.success());
    let replay = |bytes: &[u8]| {
        let mut replay = Command::new(&program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        replay.stdin.take().unwrap().write_all(bytes).unwrap();
        replay.wait_with_output().unwrap()
    };

    let output = replay(&wire.bytes);
    assert!(output.status.success());
    assert!(steps_of(str::from_utf8(&output.stdout).unwrap()) == wire.steps);

    // A piece is no segment.
    let (_, piece) = wire.bytes.split_last().unwrap();
    assert_eq!(replay(piece).status.code(), Some(1));
}
