//! Mistakes of a sender: its job, its attempts, the answers to them.

use super::*;

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
fn m03_a_job_survives_a_collision_whatever_becomes_of_the_reception() {
    // What comes in after we gave way, how long we wait then, and what we send from then on.
    let cases: [(&[u8], u64, &[u8]); 3] = [
        (&[0x42, 0x10, 0x03, 0x51], 0, &[DLE, STX]),
        (&[0x42], 220, &[NAK, STX]),
        (&[0x42, 0x10, 0x03, 0x00], 4000, &[STX]),
    ];
    for (body, wait, answer) in cases {
        let mut station = asking::<64>(low(), &[0x41]);
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
            phase: JobPhase::Connection,
            cause: Cause::Stalled,
            attempts: 6,
            ..
        }))
    ));
    // The same in the middle of the block.
    let mut station = asking::<64>(low(), &[0x41]);
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

/// A burst is one wrong answer: one attempt, however long it is, as long as no pause of ZVZ is in
/// it, and whether it comes in one piece or byte by byte.
#[test]
fn m07_a_burst_of_garbage_costs_one_attempt() {
    let garbage = [0x55; 40];
    for piece in [1, 7, 40] {
        let mut station = asking::<64>(low(), &[0x41]);
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
    let mut station = asking::<64>(low(), &[0x41]);
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
        let mut station = asking::<64>(low(), &[1, 2, 3, 4, 5, 6]);
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
            assert_eq!(sent(&mut station, ms(2)), [0_u8; 0]);
            station.handle_byte(ms(100), 0x66); // the silence begins again
            station.handle_timeout(ms(2 + silence));
            assert_eq!(sent(&mut station, ms(2 + silence)), [0_u8; 0]);
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
