//! Mistakes of earlier implementations of 3964R, one test for each.
#![cfg(test)]

#[path = "common/low_side.rs"]
mod low_side;

use core::time::Duration;

use proto3964r::{
    Abandoned, Cause, Character, Config, Event, Failure, IdleNoise, Line, Monitor, Phase, Priority,
    Rejection, Side, Station, SubmitError, Transmit, Verdict, diagnose, frame::FrameError,
};

use low_side::{DLE, NAK, STX, hear, low, ms};

/// What the station sends now, with the discards dropped.
fn sent<const N: usize, const T: usize>(station: &mut Station<N, T>, now: Duration) -> Vec<u8> {
    let mut all = Vec::new();
    let mut out = [0; 300];
    while let Some(transmit) = station.poll_transmit(now, &mut out) {
        if let Transmit::Bytes(bytes) = transmit {
            all.extend_from_slice(bytes);
        }
    }
    all
}

/// The names of all events, with their contents.
fn events<const N: usize, const T: usize>(station: &mut Station<N, T>) -> Vec<String> {
    let mut all = Vec::new();
    while let Some(event) = station.poll_event() {
        all.push(format!("{event:?}"));
    }
    all
}

/// A station that has sent the block of its job and awaits the answer, at 0 ms.
fn after_block(payload: &[u8]) -> Station<64> {
    let mut station = Station::new(low());
    station.submit(ms(0), payload).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(0), DLE);
    assert!(!sent(&mut station, ms(0)).is_empty());
    station
}

#[test]
fn m01_bcc_starts_again_with_the_stx_of_a_repeat() {
    let mut station = Station::<64>::new(low());
    station.submit(ms(0), &[0x55]).unwrap();
    for _ in 0..3 {
        assert_eq!(sent(&mut station, ms(0)), [STX]);
        station.handle_byte(ms(0), DLE);
        assert_eq!(sent(&mut station, ms(0)), [0x55, 0x10, 0x03, 0x46]);
        station.handle_byte(ms(0), NAK);
    }
    // And on the receiving side.
    let mut station = Station::<64>::new(low());
    for bcc in [0x00, 0x52] {
        hear(&mut station, ms(0), &[STX, 0x41, 0x10, 0x03, bcc]);
    }
    assert_eq!(sent(&mut station, ms(0)), [DLE, NAK, DLE, DLE]);
}

#[test]
fn m02_dle_before_anything_else_is_an_error() {
    let mut station = Station::<64>::new(low());
    hear(
        &mut station,
        ms(0),
        &[STX, 0x10, 0x41, 0x42, 0x10, 0x03, 0x10],
    );
    assert_eq!(sent(&mut station, ms(0)), [DLE, NAK]);
    assert_eq!(
        station.poll_event(),
        Some(Event::Rejected(Rejection::Frame(FrameError::IllegalDle {
            byte: 0x41,
            offset: 0
        })))
    );
}

#[test]
fn m03_a_job_survives_a_collision_whatever_becomes_of_the_reception() {
    // What comes in after we gave way, how long we wait then, and what we send from then on.
    let cases: [(&[u8], u64, &[u8]); 3] = [
        (&[0x42, 0x10, 0x03, 0x51], 0, &[DLE, STX]),
        (&[0x42], 220, &[NAK, STX]),
        (&[0x42, 0x10, 0x03, 0x00], 4000, &[STX]),
    ];
    for (body, wait, answer) in cases {
        let mut station = Station::<64>::new(low());
        station.submit(ms(0), &[0x41]).unwrap();
        assert_eq!(sent(&mut station, ms(0)), [STX]);
        station.handle_byte(ms(0), STX);
        assert_eq!(sent(&mut station, ms(0)), [DLE]);
        hear(&mut station, ms(0), body);
        if wait == 4000 {
            assert_eq!(sent(&mut station, ms(0)), [NAK]);
        }
        station.handle_timeout(ms(wait));
        assert_eq!(sent(&mut station, ms(wait)), answer);
        station.handle_byte(ms(wait), DLE);
        assert_eq!(sent(&mut station, ms(wait)), [0x41, 0x10, 0x03, 0x52]);
        station.handle_byte(ms(wait), DLE);
        assert!(events(&mut station).contains(&"Sent { len: 1 }".to_owned()));
    }
}

#[test]
fn m04_the_receiver_gives_up_after_six_rejections() {
    let mut station = Station::<64>::new(low());
    for attempt in 1..=6 {
        hear(&mut station, ms(0), &[STX, 0x41, 0x10, 0x03, 0x00]);
        assert_eq!(sent(&mut station, ms(0)), [DLE, NAK]);
        let bad = Event::Rejected(Rejection::Frame(FrameError::Bcc {
            computed: 0x52,
            received: 0,
        }));
        assert_eq!(station.poll_event(), Some(bad));
        let given_up = (attempt == 6).then_some(Event::Abandoned(Abandoned::TooMany(6)));
        assert_eq!(station.poll_event(), given_up);
    }
    assert!(station.is_idle());
}

#[test]
fn m05_a_line_that_takes_nothing_does_not_stop_the_timers() {
    let mut station = Station::<64>::new(low());
    station.submit(ms(0), &[0x41]).unwrap();
    let mut now = ms(0);
    while let Some(due) = station.poll_timeout() {
        assert!(due > now);
        now = due;
        station.handle_timeout(now);
    }
    assert_eq!(now, ms(12_000));
    let failure = station.poll_event();
    assert!(matches!(
        failure,
        Some(Event::Failed(Failure {
            phase: Phase::Connection,
            cause: Cause::Stalled,
            attempts: 6,
            ..
        }))
    ));
    // The same in the middle of the block.
    let mut station = Station::<64>::new(low());
    station.submit(ms(0), &[0x41]).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(0), DLE);
    assert_eq!(
        station.poll_transmit(ms(5), &mut [0; 2]),
        Some(Transmit::Bytes(&[0x41, DLE]))
    );
    assert_eq!(station.poll_timeout(), Some(ms(2005)));
    station.handle_timeout(ms(2005));
    assert_eq!(
        station.poll_transmit(ms(2005), &mut [0; 2]),
        Some(Transmit::Discard)
    );
    assert_eq!(sent(&mut station, ms(2005)), [STX]);
}

#[test]
fn m06_a_buffer_that_becomes_free_is_seen_at_once() {
    let mut station = Station::<64>::new(low());
    hear(&mut station, ms(0), &[STX, 0x41, 0x10, 0x03, 0x52]);
    assert_eq!(sent(&mut station, ms(0)), [DLE, DLE]);
    station.handle_byte(ms(10), STX);
    assert_eq!(sent(&mut station, ms(10)), []);
    assert_eq!(station.poll_timeout(), Some(ms(410)));
    assert_eq!(station.poll_event(), Some(Event::Received(b"A")));
    assert!(station.poll_timeout().is_some_and(|due| due <= ms(10)));
    station.handle_timeout(ms(10));
    assert_eq!(sent(&mut station, ms(10)), [DLE]);
    hear(&mut station, ms(10), &[0x42, 0x10, 0x03, 0x51]);
    assert_eq!(station.poll_event(), Some(Event::Received(b"B")));
}

/// A burst is one wrong answer: one attempt, however long it is, as long as no pause of ZVZ is in
/// it, and whether it comes in one piece or byte by byte.
#[test]
fn m07_a_burst_of_garbage_costs_one_attempt() {
    let garbage = [0x55; 40];
    for piece in [1, 7, 40] {
        let mut station = Station::<64>::new(low());
        station.submit(ms(0), &[0x41]).unwrap();
        assert_eq!(sent(&mut station, ms(0)), [STX]);
        let mut answers = Vec::new();
        for (time, bytes) in (1..).zip(garbage.chunks(piece)) {
            hear(&mut station, ms(time), bytes);
            answers.extend(sent(&mut station, ms(time)));
        }
        assert_eq!(answers, [STX], "pieces of {piece}");
        station.handle_byte(ms(100), DLE);
        assert_eq!(sent(&mut station, ms(100)), [0x41, 0x10, 0x03, 0x52]);
        // The same in place of the answer to the block.
        let mut answers = Vec::new();
        for (time, bytes) in (101..).zip(garbage.chunks(piece)) {
            hear(&mut station, ms(time), bytes);
            answers.extend(sent(&mut station, ms(time)));
        }
        assert_eq!(answers, [STX], "pieces of {piece}");
    }
}

#[test]
fn m07_garbage_after_a_pause_is_a_new_answer() {
    let mut station = Station::<64>::new(low());
    station.submit(ms(0), &[0x41]).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    for attempt in 2..=6 {
        station.handle_byte(ms(attempt * 220), 0x55);
        assert_eq!(sent(&mut station, ms(attempt * 220)), [STX]);
    }
    station.handle_byte(ms(7 * 220), 0x55);
    assert_eq!(sent(&mut station, ms(7 * 220)), [NAK]);
}

#[test]
fn m08_the_rest_of_an_aborted_block_is_discarded() {
    // (character, what follows) after two bytes of the block.
    for (byte, silence) in [(NAK, 0), (0x55, 220), (DLE, 220), (STX, 220)] {
        let mut station = Station::<64>::new(low());
        station.submit(ms(0), &[1, 2, 3, 4, 5, 6]).unwrap();
        assert_eq!(sent(&mut station, ms(0)), [STX]);
        station.handle_byte(ms(0), DLE);
        let mut two = [0; 2];
        assert_eq!(
            station.poll_transmit(ms(1), &mut two),
            Some(Transmit::Bytes(&[1, 2]))
        );
        station.handle_byte(ms(2), byte);
        assert_eq!(
            station.poll_transmit(ms(2), &mut two),
            Some(Transmit::Discard)
        );
        if silence > 0 {
            assert_eq!(sent(&mut station, ms(2)), []);
            station.handle_byte(ms(100), 0x66); // the silence begins again
            station.handle_timeout(ms(2 + silence));
            assert_eq!(sent(&mut station, ms(2 + silence)), []);
            station.handle_timeout(ms(100 + silence));
            assert_eq!(sent(&mut station, ms(100 + silence)), [NAK, STX]);
        } else {
            assert_eq!(sent(&mut station, ms(2)), [STX]);
        }
        station.handle_byte(ms(500), DLE);
        assert_eq!(
            sent(&mut station, ms(500)),
            [1, 2, 3, 4, 5, 6, 0x10, 0x03, 0x14]
        );
    }
}

/// The output was queued whole: the character time tells that the block is still going out.
#[test]
fn m08_a_nak_into_a_queued_block_discards_its_rest() {
    let mut station = Station::<64>::new(Config {
        line: Line::Paced {
            character_ns: 1_146_000,
        },
        ..low()
    });
    station.submit(ms(0), &[0x41; 50]).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(3), DLE);
    assert_eq!(sent(&mut station, ms(3)).len(), 53);
    assert_eq!(
        station.poll_timeout(),
        Some(Duration::from_micros(3000 + 53 * 1146 + 2_000_000))
    );
    station.handle_byte(ms(20), NAK);
    assert_eq!(
        station.poll_transmit(ms(20), &mut [0; 9]),
        Some(Transmit::Discard)
    );
    assert_eq!(sent(&mut station, ms(20)), [STX]);
}

#[test]
fn m09_every_character_restarts_the_character_delay() {
    let mut station = Station::<64>::new(low());
    station.handle_byte(ms(0), STX);
    assert_eq!(sent(&mut station, ms(0)), [DLE]);
    for (at, byte) in (1..).zip([0x41, 0x10, 0x10, 0x10, 0x03]) {
        station.handle_byte(ms(at * 219), byte);
        assert_eq!(station.poll_timeout(), Some(ms(at * 219 + 220)));
    }
    station.handle_byte(ms(6 * 219), 0x52);
    assert_eq!(station.poll_event(), Some(Event::Received(&[0x41, 0x10])));
}

#[test]
fn m10_a_zero_byte_is_data() {
    let mut station = Station::<64>::new(low());
    hear(
        &mut station,
        ms(0),
        &[STX, 0x00, 0x41, 0x00, 0x10, 0x03, 0x52],
    );
    assert_eq!(
        station.poll_event(),
        Some(Event::Received(&[0x00, 0x41, 0x00]))
    );
}

#[test]
fn m11_a_wrong_bcc_is_answered_nak() {
    for bcc in (0..=255).filter(|&bcc| bcc != 0x52) {
        let mut station = Station::<64>::new(low());
        hear(&mut station, ms(0), &[STX, 0x41, 0x10, 0x03, bcc]);
        assert_eq!(sent(&mut station, ms(0)), [DLE, NAK]);
        assert!(matches!(station.poll_event(), Some(Event::Rejected(_))));
        assert_eq!(station.poll_event(), None);
    }
}

#[test]
fn m12_the_bcc_covers_the_doubled_dle() {
    let mut station = Station::<64>::new(low());
    station.submit(ms(0), &[0x10]).unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(0), DLE);
    assert_eq!(sent(&mut station, ms(0)), [0x10, 0x10, 0x10, 0x03, 0x13]);
    hear(
        &mut station,
        ms(0),
        &[DLE, STX, 0x10, 0x10, 0x10, 0x03, 0x03],
    );
    assert!(
        events(&mut station)[1].starts_with("Rejected"),
        "03h would be the BCC of the undoubled data"
    );
}

#[test]
fn m13_a_doubled_dle_before_03_is_data() {
    let mut station = Station::<64>::new(low());
    hear(
        &mut station,
        ms(0),
        &[STX, 0x10, 0x10, 0x03, 0x41, 0x10, 0x03, 0x51],
    );
    assert_eq!(
        station.poll_event(),
        Some(Event::Received(&[0x10, 0x03, 0x41]))
    );
}

#[test]
fn m14_a_block_too_long_is_swallowed_to_its_end() {
    let mut station = Station::<4>::new(low());
    hear(
        &mut station,
        ms(0),
        &[STX, 1, 2, 3, 4, 5, STX, 0x41, 0x15, 0x10, 0x03],
    );
    assert_eq!(sent(&mut station, ms(0)), [DLE]);
    station.handle_byte(ms(0), 0x00);
    assert_eq!(sent(&mut station, ms(0)), [NAK]);
    assert_eq!(
        station.poll_event(),
        Some(Event::Rejected(Rejection::Frame(FrameError::TooLong {
            capacity: 4
        })))
    );
    assert_eq!(station.poll_event(), None);
}

#[test]
fn m15_a_nak_while_idle_is_never_answered() {
    for policy in [
        IdleNoise::NakAfterSilence,
        IdleNoise::NakAtOnce,
        IdleNoise::Ignore,
    ] {
        let mut station = Station::<64>::new(Config {
            idle_noise: policy,
            ..low()
        });
        hear(&mut station, ms(0), &[NAK; 20]);
        assert_eq!(station.poll_timeout(), None);
        assert_eq!(sent(&mut station, ms(0)), []);
        assert_eq!(station.poll_event(), None);
    }
}

#[test]
fn m16_every_state_but_idle_has_a_deadline() {
    let mut waiting_for_dle = Station::<64>::new(low());
    waiting_for_dle.submit(ms(0), b"A").unwrap();
    let mut receiving = Station::<64>::new(low());
    receiving.handle_byte(ms(0), STX);
    let mut rejected = Station::<64>::new(low());
    hear(&mut rejected, ms(0), &[STX, 0x10, 0x03, 0x00]);
    let mut no_buffer = Station::<64>::new(low());
    hear(&mut no_buffer, ms(0), &[STX, 0x10, 0x03, 0x13, STX]);
    let mut noise = Station::<64>::new(low());
    noise.handle_byte(ms(0), 0x41);
    let mut interrupted = Station::<64>::new(low());
    interrupted.submit(ms(0), b"A").unwrap();
    assert_eq!(sent(&mut interrupted, ms(0)), [STX]);
    hear(&mut interrupted, ms(0), &[DLE, 0x41]);
    for mut station in [
        after_block(b"A"),
        waiting_for_dle,
        receiving,
        rejected,
        no_buffer,
        noise,
        interrupted,
    ] {
        let before = station.clone();
        let due = station.poll_timeout().unwrap();
        assert!(due > ms(0) && due <= ms(4000), "{station:?}");
        station.handle_timeout(due);
        assert_ne!(station, before);
    }
}

#[test]
fn m17_a_monitor_tells_why_the_link_does_not_come_up() {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    let mut monitor = Monitor::<64>::new(config);
    let mut record = Vec::new();
    for attempt in 0..6 {
        for (at, side, byte) in [
            (ms(10 * attempt), Side::A, STX),
            (ms(10 * attempt + 5), Side::B, NAK),
        ] {
            assert_eq!(monitor.handle_byte(at, side, byte).count(), 1);
            record.push(Character {
                at,
                side,
                byte,
                error: None,
            });
        }
    }
    let verdict = diagnose(&record, &config).verdict;
    assert_eq!(verdict, Verdict::NoReceiveBuffer { refuser: Side::B });
    assert_eq!(
        verdict.to_string(),
        "B answers NAK to STX: no receive buffer"
    );
}

/// The reception of a babbling partner ends, and so does every job.
#[test]
fn endless_input_does_not_hang() {
    for prefix in [&[STX, 0x10, 0x41][..], &[0x41], &[STX]] {
        let mut station = Station::<8>::new(low());
        hear(&mut station, ms(0), prefix);
        station.submit(ms(0), b"job").unwrap();
        let end = (1..200_000_u64).step_by(10).find(|&time| {
            if station.poll_timeout().is_some_and(|due| due <= ms(time)) {
                station.handle_timeout(ms(time));
            }
            station.handle_byte(ms(time), 0x41);
            let _characters = sent(&mut station, ms(time));
            events(&mut station)
                .iter()
                .any(|event| event.starts_with("Failed"))
        });
        assert!(end.is_some(), "{prefix:02X?}");
    }
}

#[test]
fn same_priority_is_reported() {
    // Two high ones: STX against STX, again and again.
    let mut high = Station::<8>::new(Config {
        priority: Priority::High,
        ..low()
    });
    high.submit(ms(0), b"A").unwrap();
    for attempt in 0..2 {
        high.handle_timeout(ms(2000 * attempt));
        assert_eq!(sent(&mut high, ms(2000 * attempt)), [STX]);
        high.handle_byte(ms(2000 * attempt), STX);
    }
    assert_eq!(
        events(&mut high),
        [
            "Conflict { in_a_row: 1 }",
            "Conflict { in_a_row: 2 }",
            "SamePriority"
        ]
    );
    // Two low ones: DLE against DLE.
    let mut station = Station::<8>::new(low());
    station.submit(ms(0), b"A").unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    hear(&mut station, ms(0), &[STX, DLE]);
    station.handle_timeout(ms(220));
    assert_eq!(
        events(&mut station),
        [
            "Conflict { in_a_row: 1 }",
            "SamePriority",
            "Rejected(CharacterDelay)"
        ]
    );
}

#[test]
fn wrong_jobs_are_named() {
    let mut station = Station::<8, 4>::with_buffers(Config {
        allow_empty: false,
        ..low()
    });
    assert_eq!(
        station.submit(ms(0), b"12345"),
        Err(SubmitError::TooLong {
            len: 5,
            capacity: 4
        })
    );
    assert_eq!(station.submit(ms(0), b""), Err(SubmitError::Empty));
    assert_eq!(station.submit(ms(0), b"1234"), Ok(()));
    assert_eq!(station.submit(ms(0), b"1"), Err(SubmitError::Busy));
    assert!(station.cancel(ms(0)));
    assert!(!station.cancel(ms(0)));
    assert_eq!(
        events(&mut station),
        ["Failed(Failure { phase: Connection, cause: Cancelled, attempts: 1 })"]
    );
    assert_eq!(sent(&mut station, ms(0)), [NAK]);
    assert!(!station.is_busy());
}

#[test]
fn break_ends_a_transmission_and_a_reception() {
    let mut station = after_block(b"A");
    station.handle_break(ms(1));
    assert_eq!(
        events(&mut station),
        [
            "Break",
            "Failed(Failure { phase: Transmission, cause: Break, attempts: 1 })"
        ]
    );
    let mut station = Station::<8>::new(low());
    hear(&mut station, ms(0), &[STX, 0x41]);
    station.handle_break(ms(1));
    assert!(station.is_idle());
    assert_eq!(events(&mut station), ["Break"]);
}
