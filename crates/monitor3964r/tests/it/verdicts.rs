//! Short conversations, each of which shows one fault, and its sentence.

use core::time::Duration;

use monitor3964r::{BaudRatio, Character, Diagnosis, Formula, Monitor, Side, Verdict, diagnose};
use proto3964r::{CharacterError, Config, Line, Priority};

/// Reads `ms side byte...` groups; `?` after a byte is a parity error.
fn read(conversation: &str) -> Vec<Character> {
    let mut record = Vec::new();
    for group in conversation.split(';') {
        let mut words = group.split_whitespace();
        let at = Duration::from_millis(words.next().unwrap().parse().unwrap());
        let side = match words.next().unwrap() {
            "A" => Side::A,
            "B" => Side::B,
            other => panic!("{other}"),
        };
        record.extend(words.map(|word| Character {
            at,
            side,
            byte: u8::from_str_radix(word.trim_end_matches('?'), 16).unwrap(),
            error: word.ends_with('?').then_some(CharacterError::Parity),
        }));
    }
    record
}

fn diagnosis(conversation: &str) -> Diagnosis {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    diagnose(&read(conversation), &config)
}

fn check(conversation: &str, verdict: Verdict, sentence: &str) {
    let found = diagnosis(conversation);
    assert_eq!(found.verdict, verdict, "{conversation}: {found}");
    assert_eq!(found.verdict.to_string(), sentence);
}

#[test]
fn m17_a_monitor_tells_why_the_link_does_not_come_up() {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    let mut monitor = Monitor::<64>::new(config);
    let record = read(
        "0 A 02; 5 B 15; 10 A 02; 15 B 15; 20 A 02; 25 B 15; 30 A 02; 35 B 15; 40 A 02; 45 B 15; 50 A 02; 55 B 15",
    );
    for heard in &record {
        let steps = monitor.handle_byte(heard.at, heard.side, heard.byte);
        assert_eq!(steps.count(), 1);
    }
    let verdict = diagnose(&record, &config).verdict;
    assert_eq!(verdict, Verdict::NoReceiveBuffer { refuser: Side::B });
    assert_eq!(
        verdict.to_string(),
        "B answers NAK to STX: no receive buffer"
    );
}

#[test]
fn nothing_yet() {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    let nothing = diagnose(&[], &config);
    assert_eq!(nothing.verdict, Verdict::Silent);
    assert_eq!(nothing.verdict.to_string(), "the line is silent");
    check(
        "0 A 15; 1 A 02",
        Verdict::Open,
        "nothing to complain of so far",
    );
}

#[test]
fn who_answers() {
    check(
        "0 A 02; 2001 A 02; 4002 A 02; 6003 A 15",
        Verdict::NoAnswer { silent: Side::B },
        "B does not answer STX: off, not wired, or set to another baud rate",
    );
    // It lives: the wire to it is the other cause.
    let alive = diagnosis("0 B 15; 1 A 02; 2001 A 02; 4002 A 02; 6003 A 15");
    assert_eq!(alive.verdict, Verdict::NoAnswer { silent: Side::B });
    assert_eq!(
        alive.or,
        Some(Verdict::NotHeard {
            speaker: Side::A,
            listener: Side::B
        })
    );
    let telegram = "0 A 02; 1 B 10; 2 A 41 10 03 52; 3 B 10";
    check(
        &format!("{telegram}; 1000 A 02; 3000 A 02; 5000 A 02; 7000 A 15"),
        Verdict::NoLongerAnswers {
            silent: Side::B,
            last: Duration::from_millis(3),
        },
        "B does not answer STX any more: the last sign of it came at 0.003000 s",
    );
    check(
        "0 A 02; 400 B 15; 401 A 02; 801 B 15",
        Verdict::NoReceiveBuffer { refuser: Side::B },
        "B answers NAK to STX: no receive buffer",
    );
    check(
        "0 A 02; 2500 B 10",
        Verdict::Late {
            side: Side::B,
            delay: Duration::from_millis(2500),
            qvz: Duration::from_secs(2),
        },
        "B answers 2500.000 ms after the question, later than A waits (QVZ, 2000.000 ms): too late by 500.000 ms",
    );
    check(
        "0 A 02; 1 B 10; 2 A 41 10 03 52; 2003 A 02; 2004 B 10; 2005 A 41 10 03 52; 5000 A 02",
        Verdict::NoAcknowledgement { silent: Side::B },
        "B does not answer blocks: it still waits for their end, or its answer is lost",
    );
}

#[test]
fn the_same_priority() {
    check(
        "0 A 02; 5 B 02; 2000 A 02; 2001 B 02; 4000 B 02; 4001 A 02",
        Verdict::SamePriority {
            priority: Priority::High,
        },
        "both sides have the same priority, high: set one of them to low",
    );
    check(
        "0 A 02; 0 B 02; 1 A 10; 1 B 10; 250 A 15; 250 B 15",
        Verdict::SamePriority {
            priority: Priority::Low,
        },
        "both sides have the same priority, low: set one of them to high",
    );
}

#[test]
fn with_and_without_bcc() {
    check(
        "0 A 02; 1 B 10; 2 A 41 10 03; 3 B 10; 9 B 02; 10 A 10; 11 B 41 10 03; 12 A 10; 20 A 02",
        Verdict::BothWithoutBcc,
        "both sides are set to 3964, without BCC; the monitor expects 3964R",
    );
    check(
        "0 A 02; 1 B 10; 2 A 41 10 03; 222 B 15; 223 A 02; 224 B 10; 225 A 41 10 03; 445 B 15",
        Verdict::WithoutBcc { side: Side::A },
        "A neither awaits a BCC nor sends one: it is set to 3964, B to 3964R",
    );
    let record = read("0 A 02; 1 B 10; 2 A 41 10 03 52; 3 B 10");
    let plain = Config::siemens_3964(Priority::Low, Line::Instant);
    let verdict = diagnose(&record, &plain).verdict;
    assert_eq!(verdict, Verdict::BothWithBcc);
}

#[test]
fn blocks_and_their_answers() {
    check(
        "0 A 02; 1 B 10; 2 A 41 10 03 52; 3 B 15",
        Verdict::GoodBlocksRejected {
            refuser: Side::B,
            rejected: 1,
            blocks: 1,
        },
        "B rejects blocks of A that are good (1 of 1): reception errors on its side, or it checks the BCC otherwise",
    );
    check(
        "0 A 02; 1 B 10; 2 A 41 10 03 52; 3 B 10; 4 A 02; 5 B 10; 6 A 41 42 10 03 10; 7 B 15; 8 A 02; 9 B 10; 10 A 41 42 10 03 10; 11 B 15",
        Verdict::LongBlocksRejected {
            refuser: Side::B,
            accepted: 1,
            rejected: 2,
        },
        "B rejects good blocks from 2 bytes upwards and accepts them up to 1: its block length is set shorter",
    );
    check(
        "0 A 02; 1 B 10; 2 A 41 10 03 53; 3 B 10",
        Verdict::BadBlocksAccepted { receiver: Side::B },
        "B accepts blocks whose BCC is wrong",
    );
    check(
        "0 A 02; 1 B 10; 2 A 41; 300 A 10 03 53; 301 B 15; 302 A 02; 303 B 10; 310 A 41; 540 A 42",
        Verdict::Gaps {
            sender: Side::A,
            longest: Duration::from_millis(298),
        },
        "A pauses in its blocks for longer than the character delay time (ZVZ): 298.000 ms",
    );
    // Damaged although the BCC is right: the receiver had its reason.
    check(
        "0 A 02; 1 B 10; 2 A 41? 10 03 52; 3 B 15",
        Verdict::BadBlocks {
            sender: Side::A,
            bad: 1,
            blocks: 1,
        },
        "1 of 1 blocks of A arrive damaged: noise on the line",
    );
}

/// A second fault that no rule names, and noise that is none.
#[test]
fn there_is_more() {
    let block = |ms: u32, data: &str, bcc: &str| {
        let [answer, data_ms, end] = [1, 2, 3].map(|after| ms + after);
        format!("{ms} A 02; {answer} B 10; {data_ms} A {data} 10 03 {bcc}; {end} B 15; ")
    };
    let blocks = [
        block(0, "41", "41"),
        block(100, "42", "42"),
        block(200, "43", "43"),
        block(300, "44", "44"),
    ]
    .concat();
    let refused = |times: u32| {
        let refusal = |at| format!("{} A 02; {} B 15; ", 1000 + 10 * at, 1001 + 10 * at);
        (0..times).map(refusal).collect::<String>()
    };
    let found = |times| diagnosis(&format!("{blocks}{}2000 A 02", refused(times)));
    for (times, more) in [(0, false), (1, false), (3, true)] {
        let found = found(times);
        let other_bcc = matches!(found.verdict, Verdict::OtherBcc { .. });
        assert!(other_bcc && found.also.is_none(), "{found}");
        assert_eq!(found.more, more, "{found}");
        assert_eq!(found.to_string().contains("; and more"), more);
    }
}

#[test]
fn formulas() {
    for (blocks, formula) in [
        (["41 10 03 50", "42 10 03 53"], Formula::WithStx),
        (["41 10 03 42", "42 10 03 41"], Formula::WithoutDle),
        (["41 10 03 41", "42 10 03 42"], Formula::WithoutEnd),
        (["41 10 03 51", "42 10 03 52"], Formula::WithoutEtx),
        (["10 10 10 03 03", "42 10 03 51"], Formula::Undoubled),
        (["10 10 10 03 01", "42 10 03 53"], Formula::WithStxUndoubled),
        (
            ["41 10 03 AD", "42 10 03 AE"],
            Formula::StartValue { difference: 0xFF },
        ),
    ] {
        let mut conversation = Vec::new();
        for (number, block) in blocks.iter().chain(&blocks).enumerate() {
            let at = 1000 * number;
            conversation.push(format!("{at} A 02; {} B 10", at + 1));
            let answer = if block.ends_with("51") && formula == Formula::Undoubled {
                "10"
            } else {
                "15"
            };
            conversation.push(format!("{} A {block}; {} B {answer}", at + 2, at + 3));
        }
        let found = diagnosis(&conversation.join("; "));
        let expected = Verdict::OtherBcc {
            sender: Side::A,
            formula,
        };
        assert_eq!(found.verdict, expected, "{found}");
    }
}

#[test]
fn the_tap_itself() {
    check(
        "0 A FE 7F 01",
        Verdict::Garbage { side: Side::A },
        "A sends characters outside the procedure: another parity, baud rate or protocol",
    );
    let telegram = "0 A 02; 2 A 41 10 03 52";
    check(
        telegram,
        Verdict::TapDeaf {
            speaker: Side::A,
            unheard: Side::B,
        },
        "A goes on as if B had answered, but the tap hears nothing of B: its input for B is not connected",
    );
    check(
        "0 A 02; 1 A 10; 2 A 41 10 03 52; 3 A 10",
        Verdict::OneInput { side: Side::A },
        "both directions come in on the tap's input for A: a two-wire line, or its inputs are joined",
    );
}

/// What STX, DLE and NAK of another rate read as, as often as this.
fn repeated(side: &str, readings: &[&str], times: usize) -> String {
    let groups = readings.iter().cycle().take(readings.len() * times);
    let groups = (0..)
        .zip(groups)
        .map(|(at, reading)| format!("{} {side} {reading}", at * 300));
    groups.collect::<Vec<_>>().join("; ")
}

#[test]
fn another_baud_rate() {
    for (readings, ratio, sentence) in [
        (&["66 E0", "00"][..], BaudRatio::Half, "half"),
        (&["18?", "00 E0"], BaudRatio::Half, "half"),
        (&["1C 00"], BaudRatio::Third, "a third of"),
        (&["80 00", "00 00"], BaudRatio::Quarter, "a quarter of"),
        (&["78? 78?"], BaudRatio::Quarter, "a quarter of"),
        (&["80 80 80 00"], BaudRatio::Eighth, "an eighth of"),
        (&["F8", "00"], BaudRatio::Double, "twice"),
        (&["FE", "00"], BaudRatio::DoubleOrMore, "at least twice"),
    ] {
        check(
            &repeated("B", readings, 4),
            Verdict::OtherRate {
                side: Side::B,
                ratio,
            },
            &format!(
                "B sends characters outside the procedure: another baud rate, {sentence} that of A"
            ),
        );
    }
    // Of these nothing more can be told.
    for readings in [&["00"][..], &["E1", "E4"], &["3A", "4B"]] {
        let found = diagnosis(&repeated("B", readings, 4));
        assert_eq!(found.verdict, Verdict::Garbage { side: Side::B }, "{found}");
    }
}

#[test]
fn another_parity() {
    check(
        &repeated("A", &["15?", "02?", "10?"], 2),
        Verdict::OtherParity { side: Side::A },
        "A sends another parity: its STX, DLE and NAK come in with a wrong parity bit",
    );
}

#[test]
fn the_tap_is_set_otherwise_than_both() {
    let both = |a: &[&str], b: &[&str]| {
        let record = [repeated("A", a, 4), repeated("B", b, 4)].map(|side| read(&side));
        let mut record = record.concat();
        record.sort_by_key(|heard| heard.at);
        let config = Config::siemens_3964r(Priority::Low, Line::Instant);
        diagnose(&record, &config).verdict
    };
    // DLE at twice the rate is damaged: alone it tells nothing.
    let ratio = BaudRatio::Double;
    assert_eq!(both(&["F8"], &["00"]), Verdict::TapRate { ratio });
    assert_eq!(both(&["02?"], &["10?"]), Verdict::TapParity);
    assert_eq!(both(&["F8"], &["66 E0"]), Verdict::BothGarbage);
    assert_eq!(
        Verdict::TapRate { ratio }.to_string(),
        "neither side can be read: the baud rate of the line is twice that of the tap"
    );
    assert_eq!(
        Verdict::TapParity.to_string(),
        "neither side can be read: the tap is set to another parity than both of them"
    );
}
