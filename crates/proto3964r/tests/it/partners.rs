//! What foreign stations were seen to do, and what came of it once.

mod receive;

use core::time::Duration;

use proto3964r::{
    Cause, Config, Conflict, Event, Failure, JobPhase, Line, Priority, Rejection, Station,
    frame::FrameError,
};

use crate::common::low_side::{CHARACTER, DLE, NAK, STX, handed_out, ms, quiet, sent};

fn low(line: Line) -> Config {
    quiet(Priority::Low, line)
}

fn uart() -> Line {
    Line::paced(9600, 11)
}

/// Takes all characters, and polls each telegram as soon as it is there.
fn hear<const N: usize>(
    station: &mut Station<N>,
    now: Duration,
    characters: &[u8],
) -> Vec<Vec<u8>> {
    let (mut rest, mut telegrams) = (characters, Vec::new());
    while !rest.is_empty() {
        rest = &rest[station.handle_bytes(now, rest)..];
        while let Some(event) = station.poll_event() {
            if let Event::Received(telegram) = event {
                telegrams.push(telegram.to_vec());
            }
        }
    }
    telegrams
}

/// A partner that took the first STX for lost would take the others for data, which cancel in the
/// BCC when they are two: `02 02 tare`, and `Sent`.
#[test]
fn a_burst_of_nak_is_one_wrong_answer() {
    for line in [Line::Instant, uart(), Line::buffered(9600, 11)] {
        let mut station = Station::<64>::new(low(line));
        station.submit(ms(0), b"tare").unwrap();
        let mut out = sent(&mut station, ms(0));
        for nak in 2..5 {
            station.handle_byte(nak * CHARACTER, NAK);
            out.extend(sent(&mut station, nak * CHARACTER));
        }
        assert_eq!(out, [STX, STX], "{line:?}");
        station.handle_byte(ms(8), DLE);
        assert_eq!(sent(&mut station, ms(8)), b"tare\x10\x03\x11");
    }
}

/// The same in place of the answer to a block.
#[test]
fn a_burst_of_nak_to_a_block_is_one_wrong_answer() {
    let mut station = Station::<64>::new(low(uart()));
    station.submit(ms(0), b"A").unwrap();
    let mut out = sent(&mut station, ms(0));
    station.handle_byte(ms(3), DLE);
    out.extend(sent(&mut station, ms(3)));
    for nak in 1..5 {
        let now = ms(10) + nak * CHARACTER;
        station.handle_byte(now, NAK);
        out.extend(sent(&mut station, now));
    }
    assert_eq!(out, [STX, 0x41, 0x10, 0x03, 0x52, STX]);
}

/// A partner without a receive buffer refuses each STX by itself, after a while.
#[test]
fn each_nak_after_a_pause_is_an_answer_of_its_own() {
    let mut station = Station::<64>::new(low(uart()));
    station.submit(ms(0), b"A").unwrap();
    let mut out = sent(&mut station, ms(0));
    for refusal in 1..=6 {
        station.handle_byte(ms(400 * refusal), NAK);
        out.extend(sent(&mut station, ms(400 * refusal)));
    }
    assert_eq!(out, [STX, STX, STX, STX, STX, STX, NAK]);
    let Some(Event::Failed(Failure { phase, cause, .. })) = station.poll_event() else {
        panic!("six refusals end the job");
    };
    assert_eq!((phase, cause), (JobPhase::Connection, Cause::Nak));
}

/// The answer to an STX long before, or to a data byte 02h: the end of the block is still to come.
#[test]
fn a_dle_long_before_the_end_of_the_block_acknowledges_nothing() {
    for line in [uart(), Line::buffered(9600, 11)] {
        let mut station = Station::<256>::new(low(line));
        station.submit(ms(0), &[0x41; 200]).unwrap();
        assert_eq!(sent(&mut station, ms(0)), [STX]);
        station.handle_byte(ms(3), DLE);
        assert_eq!(sent(&mut station, ms(3)).len(), 203); // on the line until 235.6 ms
        station.handle_byte(Duration::from_micros(4500), DLE);
        assert_eq!(station.poll_event(), None, "{line:?}");
        let (out, discarded) = handed_out(&mut station, ms(5));
        assert_eq!((out, discarded), (vec![], line == uart()));
        // Silence, counted from where the line becomes free: NAK, and all again.
        let free = if discarded {
            Duration::from_micros(4500)
        } else {
            ms(3) + 203 * CHARACTER
        };
        assert_eq!(station.poll_timeout(), Some(free + ms(220)));
        station.handle_timeout(free + ms(220));
        assert_eq!(sent(&mut station, free + ms(220)), [NAK, STX]);
    }
}

/// On a line that takes no time, the block has left as soon as it was handed out.
#[test]
fn on_an_instant_line_any_dle_after_the_block_acknowledges() {
    let mut station = Station::<256>::new(low(Line::Instant));
    station.submit(ms(0), &[0x41; 200]).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(0), DLE);
    assert_eq!(sent(&mut station, ms(0)).len(), 203);
    station.handle_byte(ms(0), DLE);
    assert_eq!(station.poll_event(), Some(Event::Sent { len: 200 }));
}

/// NAK into a block that cannot be called back: STX comes after the rest, and after the NAK that
/// the partner answers to that rest.
#[test]
fn on_a_buffered_line_a_block_that_was_broken_off_leaves_first() {
    let mut station = Station::<64>::new(low(Line::buffered(9600, 11)));
    station.submit(ms(0), &[0x41; 50]).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(3), DLE);
    assert_eq!(sent(&mut station, ms(3)).len(), 53); // on the line until 63.7 ms
    station.handle_byte(ms(20), NAK);
    assert_eq!(handed_out(&mut station, ms(20)), (vec![], false));
    station.handle_byte(ms(282), NAK); // to the rest, which was noise to the partner
    assert_eq!(station.poll_timeout(), Some(ms(502)));
    station.handle_timeout(ms(502));
    assert_eq!(sent(&mut station, ms(502)), [NAK, STX]);
    station.handle_byte(ms(506), DLE);
    assert_eq!(sent(&mut station, ms(506)).len(), 53);
    station.handle_byte(ms(570), DLE);
    assert_eq!(station.poll_event(), Some(Event::Sent { len: 50 }));
}

/// The partner may have the block whole, and answer it: that is no answer to the next job's STX.
#[test]
fn the_answer_to_a_cancelled_block_is_not_for_the_next_job() {
    for line in [Line::Instant, uart(), Line::buffered(9600, 11)] {
        let mut station = Station::<64>::new(low(line));
        station.submit(ms(0), &[0x41; 50]).unwrap();
        assert_eq!(sent(&mut station, ms(0)), [STX]);
        station.handle_byte(ms(3), DLE);
        assert_eq!(sent(&mut station, ms(3)).len(), 53); // on the line until 63.7 ms
        assert!(station.cancel(ms(20)));
        assert!(matches!(station.poll_event(), Some(Event::Failed(_))));
        station.submit(ms(20), b"A").unwrap();
        assert_eq!(sent(&mut station, ms(20)), [NAK], "{line:?}");
        station.handle_byte(ms(68), DLE);
        assert_eq!(sent(&mut station, ms(68)), [0_u8; 0]);
        let silent = ms(68 + 220);
        assert_eq!(station.poll_timeout(), Some(silent));
        station.handle_timeout(silent);
        assert_eq!(sent(&mut station, silent), [STX]);
        station.handle_byte(ms(292), DLE);
        assert_eq!(sent(&mut station, ms(292)), [0x41, 0x10, 0x03, 0x52]);
        station.handle_byte(ms(300), DLE);
        assert_eq!(station.poll_event(), Some(Event::Sent { len: 1 }));
    }
}

/// STX again and again, for jobs that are given up, would be data that cancel in the BCC.
#[test]
fn after_a_cancelled_request_the_partner_has_time_to_give_up() {
    let mut station = Station::<64>::new(low(uart()));
    let mut out = Vec::new();
    for _ in 0..3 {
        station.submit(ms(0), b"A").unwrap();
        out.extend(sent(&mut station, ms(0)));
        station.cancel(ms(1));
        assert!(station.poll_event().is_some());
    }
    out.extend(sent(&mut station, ms(1)));
    assert_eq!(out, [STX, NAK]);
    station.handle_byte(ms(3), STX); // a partner that asks is served
    assert_eq!(sent(&mut station, ms(3)), [DLE]);
}

/// A Linux partner of high priority gives way at its second STX: everything arrives, two seconds
/// late each time. One of the two is set wrong all the same.
#[test]
fn same_priority_is_reported_when_the_partner_yields_on_a_retry() {
    let mut station = Station::<64>::new(quiet(Priority::High, uart()));
    let mut reports = Vec::new();
    for begin in [0, 10_000, 20_000] {
        station.submit(ms(begin), b"A").unwrap();
        assert_eq!(sent(&mut station, ms(begin)), [STX]);
        for stx in [1, 551, 1101, 1651] {
            station.handle_byte(ms(begin + stx), STX);
        }
        let due = station.poll_timeout().unwrap();
        station.handle_timeout(due);
        assert_eq!(sent(&mut station, due), [STX]);
        station.handle_byte(due + ms(3), DLE);
        assert_eq!(sent(&mut station, due + ms(3)).len(), 4);
        station.handle_byte(due + ms(10), DLE);
        while let Some(event) = station.poll_event() {
            reports.push(format!("{event:?}"));
        }
    }
    assert_eq!(
        reports,
        [
            "Conflict { in_a_row: 1 }",
            "Sent { len: 1 }",
            "Conflict { in_a_row: 2 }",
            "SamePriority",
            "Sent { len: 1 }",
            "Conflict { in_a_row: 3 }",
            "Sent { len: 1 }"
        ]
    );
}

/// A partner of low priority gives way at once: that is what conflicts are settled by.
#[test]
fn conflicts_that_the_partner_settles_are_no_sign_of_the_same_priority() {
    let mut station = Station::<64>::new(quiet(Priority::High, uart()));
    for begin in [0, 10_000, 20_000] {
        station.submit(ms(begin), b"A").unwrap();
        assert_eq!(sent(&mut station, ms(begin)), [STX]);
        station.handle_byte(ms(begin + 1), STX);
        station.handle_byte(ms(begin + 4), DLE);
        assert_eq!(sent(&mut station, ms(begin + 4)).len(), 4);
        station.handle_byte(ms(begin + 11), DLE);
        assert_eq!(station.poll_event(), Some(Event::Conflict { in_a_row: 1 }));
        assert_eq!(station.poll_event(), Some(Event::Sent { len: 1 }));
    }
}

/// A KM271 client repeats STX in a conflict, but not while a partner that gave way takes it for
/// data.
#[test]
fn stx_is_repeated_in_a_conflict_after_a_silence() {
    let mut station = Station::<64>::new(Config {
        conflict: Conflict::Repeat,
        ..quiet(Priority::High, uart())
    });
    station.submit(ms(0), b"A").unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(1), STX); // crosses ours
    assert_eq!(sent(&mut station, ms(1)), [0_u8; 0]);
    station.handle_byte(ms(30), STX); // in place of the answer
    assert_eq!(sent(&mut station, ms(30)), [0_u8; 0]);
    assert_eq!(station.poll_timeout(), Some(ms(221)));
    station.handle_timeout(ms(221));
    assert_eq!(sent(&mut station, ms(221)), [STX]);
    station.handle_byte(ms(224), DLE);
    assert_eq!(sent(&mut station, ms(224)).len(), 4);
}

/// A line that is faster than it is said to be: the cause says so, not what comes of it.
#[test]
fn answers_that_come_sooner_than_the_rate_allows_are_a_cause_of_their_own() {
    let mut station = Station::<64>::new(low(uart()));
    station.submit(ms(0), b"tare").unwrap();
    let mut now = ms(0);
    let failure = loop {
        if sent(&mut station, now) == [STX] {
            // STX and DLE at twice the rate.
            station.handle_byte(now + CHARACTER, DLE);
        }
        if let Some(Event::Failed(failure)) = station.poll_event() {
            break failure;
        }
        now = station.poll_timeout().unwrap();
        station.handle_timeout(now);
    };
    let Failure {
        phase,
        cause,
        attempts,
        ..
    } = failure;
    assert_eq!(
        (phase, cause, attempts),
        (JobPhase::Connection, Cause::TooSoon, 6)
    );

    // Likewise the acknowledgement.
    let mut station = Station::<64>::new(low(uart()));
    station.submit(ms(0), b"tare").unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(3 * CHARACTER, DLE);
    sent(&mut station, 3 * CHARACTER);
    station.handle_byte(7 * CHARACTER, DLE);
    station.cancel(8 * CHARACTER);
    let event = station.poll_event();
    assert!(
        matches!(
            event,
            Some(Event::Failed(Failure {
                cause: Cause::TooSoon,
                ..
            }))
        ),
        "{event:?}"
    );
}
