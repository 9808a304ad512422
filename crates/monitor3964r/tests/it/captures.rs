//! Captures of lines with known faults, and what a diagnosis says of them.

use core::time::Duration;
use std::{fs, path::Path};

use monitor3964r::{BaudRatio, Character, Diagnosis, Formula, Side, Verdict, diagnose};
use proto3964r::{Config, Line, Priority};

/// Lines `time_s > hex..` from A to B, `<` from B to A, as a tap at 9600 8E1 hears a simulated
/// wire; a character with a wrong parity or stop bit reads 00.
fn record(name: &str) -> Vec<Character> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/captures");
    let text = fs::read_to_string(path.join(name)).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let read = lines.flat_map(|line| {
        let mut words = line.split_whitespace();
        let at = Duration::from_secs_f64(words.next().unwrap().parse().unwrap());
        let side = match words.next().unwrap() {
            ">" => Side::A,
            _ => Side::B,
        };
        words.map(move |word| Character {
            at,
            side,
            byte: u8::from_str_radix(word, 16).unwrap(),
            error: None,
        })
    });
    read.collect()
}

fn diagnosis(record: &[Character]) -> Diagnosis {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    diagnose(record, &config)
}

/// The same line with the tap's inputs exchanged.
fn exchanged(record: &[Character]) -> Vec<Character> {
    let exchanged = record.iter().map(|&heard| Character {
        side: other(heard.side),
        ..heard
    });
    exchanged.collect()
}

const fn other(side: Side) -> Side {
    match side {
        Side::A => Side::B,
        Side::B => Side::A,
    }
}

/// The verdict, whichever input hears which side.
fn check(name: &str, verdict: impl Fn(Side, Side) -> Verdict) -> Diagnosis {
    let record = record(name);
    let found = diagnosis(&record);
    assert_eq!(found.verdict, verdict(Side::A, Side::B), "{name}");
    let mirrored = diagnosis(&exchanged(&record));
    assert_eq!(
        mirrored.verdict,
        verdict(Side::B, Side::A),
        "{name}, exchanged"
    );
    assert_eq!((mirrored.a, mirrored.b), (found.b, found.a), "{name}");
    found
}

#[test]
fn nothing_is_wrong() {
    for (name, telegrams) in [("00_good.txt", (10, 8)), ("10a_taps_swapped.txt", (8, 10))] {
        let found = check(name, |_, _| Verdict::Works);
        assert_eq!((found.a.telegrams, found.b.telegrams), telegrams);
        assert_eq!((found.a.repeats, found.b.repeats), (0, 0));
    }
}

#[test]
fn some_blocks_are_damaged() {
    let found = check("12_every_3rd_block_of_B_bad_then_ok.txt", |_, b| {
        Verdict::WorksWithRepeats {
            sender: b,
            repeated: 7,
            damaged: 7,
            blocks: 21,
        }
    });
    assert_eq!((found.b.telegrams, found.b.rejected), (14, 7));
}

#[test]
fn characters_of_one_side_cannot_be_read() {
    check("01a_parity_B_8N1.txt", |_, b| Verdict::NoParity { side: b });
    check("02b_baud_B_4800.txt", |_, b| Verdict::OtherRate {
        side: b,
        ratio: BaudRatio::Half,
    });
}

#[test]
fn one_side_is_not_heard() {
    check("03a_TX_A_open_both_send.txt", |a, b| Verdict::NotHeard {
        speaker: a,
        listener: b,
    });
    check("03c_TX_B_open_tap_at_B.txt", |a, b| Verdict::NotHeard {
        speaker: b,
        listener: a,
    });
}

/// In step, two stations of low priority say nothing that an echo would not say.
#[test]
fn both_have_low_priority() {
    let found = check("04b_both_low.txt", |_, _| Verdict::SamePriority {
        priority: Priority::Low,
    });
    assert_eq!(found.or, Some(Verdict::Echo));
}

#[test]
fn one_side_is_dead() {
    for name in ["05a_B_dead.txt", "05c_A_linux_550ms_B_dead.txt"] {
        let found = check(name, |_, b| Verdict::NoAnswer { silent: b });
        assert_eq!(found.or, None);
    }
}

#[test]
fn another_bcc() {
    check("06b_B_bcc_undoubled.txt", |_, b| Verdict::OtherBcc {
        sender: b,
        formula: Formula::UndoubledOrWithoutDle,
    });
}

#[test]
fn one_side_without_bcc() {
    for name in [
        "07a_B_3964_A_3964R.txt",
        "07d_B_3964_A_3964R_only_A_3ms.txt",
        "min3.txt",
    ] {
        check(name, |_, b| Verdict::WithoutBcc { side: b });
    }
}

#[test]
fn answers_come_late() {
    for (name, true_ms) in [
        ("08a_B_slow_2500ms.txt", 2500),
        ("08d_B_slow_4500ms.txt", 4500),
    ] {
        let record = record(name);
        let Verdict::Late { side, delay, qvz } = diagnosis(&record).verdict else {
            panic!("{name}: {}", diagnosis(&record));
        };
        assert_eq!(side, Side::B);
        // With the time of the character on the line.
        let exact = Duration::from_millis(true_ms);
        assert!(
            delay >= exact && delay <= exact + Duration::from_millis(3),
            "{delay:?}"
        );
        assert!(
            qvz.abs_diff(Duration::from_secs(2)) < Duration::from_millis(3),
            "{qvz:?}"
        );
    }
}

#[test]
fn both_hear_themselves() {
    check("09a_echo_two_taps_same_wire.txt", |_, _| Verdict::Echo);
}

#[test]
fn stx_for_an_answer() {
    check("min1.txt", |_, b| Verdict::RequestForAnswer {
        side: b,
        delay: Duration::from_millis(8),
    });
}
