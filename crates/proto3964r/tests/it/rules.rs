//! Rules that the documentation states and that neither the vectors nor the mistakes touch.

use core::time::Duration;

use proto3964r::{
    Abandoned, Cause, Config, Event, Failure, JobPhase, Line, Priority, Rejection, Station,
    Transmit,
};

use crate::common::low_side::{CHARACTER, DLE, NAK, STX, hear, low, ms, sent_by_byte as sent};

#[test]
fn nak_at_startup_comes_before_anything_else() {
    let mut station = Station::<16>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
    station.submit(ms(0), b"A").unwrap();
    assert_eq!(sent(&mut station, ms(0)), [NAK, STX]);
}

/// The DLE of the attempt before comes while the next STX is still in the station.
#[test]
fn a_late_dle_counts_while_the_next_stx_is_not_out() {
    let mut station = Station::<16>::new(low());
    station.submit(ms(0), b"A").unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_timeout(ms(2000));
    station.handle_byte(ms(2000), DLE);
    assert_eq!(sent(&mut station, ms(2000)), [0x41, 0x10, 0x03, 0x52]);
}

/// Siemens' error 0706h.
#[test]
fn a_dle_into_the_block_waits_for_silence() {
    let mut station = Station::<16>::new(Config {
        transmission_attempts: 1,
        ..low()
    });
    station.submit(ms(0), b"AB").unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(1), DLE);
    for character in [0x41, 0x42, DLE, 0x03] {
        assert_eq!(station.poll_transmit_byte(ms(2)), Some(character));
    }
    station.handle_byte(ms(3), DLE); // the BCC is not out
    assert_eq!(sent(&mut station, ms(3)), [0_u8; 0]);
    station.handle_timeout(ms(222));
    assert_eq!(station.poll_event(), None);
    station.handle_timeout(ms(223));
    assert_eq!(sent(&mut station, ms(223)), [NAK]);
    let Some(Event::Failed(Failure { phase, cause, .. })) = station.poll_event() else {
        panic!("the job has failed");
    };
    assert_eq!(
        (phase, cause),
        (JobPhase::Transmission, Cause::Unexpected(DLE))
    );
}

#[test]
fn a_foreign_character_into_a_queued_block_waits_for_silence() {
    let mut station = Station::<16>::new(Config {
        line: Line::paced(9600, 11),
        ..low()
    });
    station.submit(ms(0), b"ABCDEFGHIJKLMNOP").unwrap();
    assert_eq!(sent(&mut station, ms(0)), [STX]);
    station.handle_byte(ms(3), DLE);
    let mut block = [0; 24];
    let Some(Transmit::Bytes(block)) = station.poll_transmit(ms(3), &mut block) else {
        panic!("the block");
    };
    assert_eq!(block.len(), 19);
    station.handle_byte(ms(10), 0x55); // 19 characters take 21.8 ms
    assert_eq!(
        station.poll_transmit(ms(10), &mut [0; 9]),
        Some(Transmit::Discard)
    );
    assert_eq!(station.poll_transmit(ms(10), &mut [0; 9]), None);
    station.handle_timeout(ms(230));
    assert_eq!(sent(&mut station, ms(230)), [NAK, STX]);
}

#[test]
fn a_series_of_rejections_ends_with_the_wait_for_its_repeat() {
    let mut station = Station::<16>::new(low());
    let bad = [STX, 0x41, 0x10, 0x03, 0x00];
    for _ in 0..5 {
        hear(&mut station, ms(0), &bad);
    }
    while station.poll_event().is_some() {}
    station.handle_timeout(ms(4000));
    assert_eq!(
        station.poll_event(),
        Some(Event::Abandoned(Abandoned::NoRepeat))
    );
    hear(&mut station, ms(4000), &bad);
    assert!(matches!(
        station.poll_event(),
        Some(Event::Rejected(Rejection::Frame(_)))
    ));
    assert_eq!(station.poll_event(), None, "one rejection, not six");
}

/// The line was busy: the times run from the moment in which it takes the answer.
#[test]
fn times_run_from_the_hand_over() {
    let mut station = Station::<16>::new(low());
    station.handle_byte(ms(0), STX);
    assert_eq!(sent(&mut station, ms(100)), [DLE]);
    assert_eq!(station.poll_timeout(), Some(ms(320)));
    hear(&mut station, ms(200), &[0x41, 0x10, 0x03, 0x00]);
    assert_eq!(sent(&mut station, ms(300)), [NAK]);
    assert_eq!(station.poll_timeout(), Some(ms(4300)));
    let mut station = Station::<16>::new(low());
    station.submit(ms(0), b"A").unwrap();
    assert_eq!(sent(&mut station, ms(70)), [STX]);
    assert_eq!(station.poll_timeout(), Some(ms(2070)));
}

#[test]
fn nak_ends_the_wait_for_a_buffer() {
    let mut station = Station::<16>::new(low());
    hear(&mut station, ms(0), &[STX, 0x41, 0x10, 0x03, 0x52]);
    assert_eq!(sent(&mut station, ms(0)), [DLE, DLE]);
    hear(&mut station, ms(1), &[STX, NAK]);
    assert!(station.is_idle());
    // A second STX does not prolong the wait of the first.
    station.handle_byte(ms(10), STX);
    station.handle_byte(ms(300), STX);
    assert_eq!(station.poll_timeout(), Some(ms(410)));
}

/// A partner that asks before our STX is out, and then never delivers, cannot hold a job for ever.
#[test]
fn asking_first_and_delivering_nothing_costs_attempts() {
    let mut station = Station::<16>::new(low());
    station.submit(ms(0), b"A").unwrap();
    let mut now = 0;
    for _ in 0..6 {
        station.handle_byte(ms(now), STX);
        now += 220;
        station.handle_timeout(ms(now));
    }
    let mut last = None;
    while let Some(event) = station.poll_event() {
        if let Event::Failed(Failure {
            phase,
            cause,
            attempts,
            ..
        }) = event
        {
            last = Some((phase, cause, attempts));
        }
    }
    assert_eq!(last, Some((JobPhase::Connection, Cause::Conflict, 6)));
}

/// Earlier than one and a half characters after STX: it left the partner before STX was there.
#[test]
fn an_answer_sooner_than_the_line_allows_is_none() {
    let earliest = CHARACTER + CHARACTER / 2;
    for line in [Line::paced(9600, 11), Line::buffered(9600, 11)] {
        for byte in [NAK, 0x55, DLE] {
            let mut station = Station::<16>::new(Config { line, ..low() });
            station.submit(ms(0), b"A").unwrap();
            assert_eq!(sent(&mut station, ms(0)), [STX]);
            station.handle_byte(earliest - Duration::from_nanos(1), byte);
            assert_eq!(sent(&mut station, ms(3)), [0_u8; 0]);
            station.handle_byte(earliest, DLE);
            assert_eq!(sent(&mut station, ms(3)), [0x41, 0x10, 0x03, 0x52]);
        }
    }
}

/// Both UARTs report a character in the middle of its stop bit, and both baud rates are 3 % fast:
/// that soon DLE is the answer to STX, and to the block.
#[test]
fn an_answer_as_soon_as_a_uart_reports_it_counts() {
    for payload in [1, 20, 250] {
        for (line, bits) in [(Line::paced(9600, 11), 11), (Line::paced(115_200, 10), 10)] {
            let mut station = Station::<250>::new(Config { line, ..low() });
            let baud = if bits == 11 { 9600 } else { 115_200 };
            let after = |bits: u64| Duration::from_nanos(bits * 1_000_000_000 / baud) * 100 / 103;
            station.submit(ms(0), &[0x41; 250][..payload]).unwrap();
            assert_eq!(station.poll_transmit_byte(ms(0)), Some(STX));
            let answer = after(2 * bits - 1);
            station.handle_byte(answer, DLE);
            let mut out = [0; 300];
            let block = station.poll_transmit(answer, &mut out);
            let Some(Transmit::Bytes(block)) = block else {
                panic!("{block:?} after DLE");
            };
            let len = u64::try_from(block.len()).unwrap();
            station.handle_byte(answer + after((len + 1) * bits - 1), DLE);
            assert_eq!(station.poll_event(), Some(Event::Sent { len: payload }));
        }
    }
}

/// With no gap allowed at all, a block in one piece and its characters one by one would differ.
#[test]
fn a_character_delay_of_zero_counts_as_one_millisecond() {
    let block = [0x41, 0x10, 0x03, 0x52];
    let mut whole = Station::<16>::new(Config { zvz_ms: 0, ..low() });
    let mut single = Station::<16>::new(Config { zvz_ms: 0, ..low() });
    for station in [&mut whole, &mut single] {
        station.handle_byte(ms(0), STX);
        assert_eq!(sent(station, ms(0)), [DLE]);
    }
    hear(&mut whole, ms(0), &block);
    for byte in block {
        single.handle_byte(ms(0), byte);
    }
    for station in [&mut whole, &mut single] {
        assert_eq!(station.config().zvz_ms, 1);
        assert_eq!(sent(station, ms(0)), [DLE]);
        assert_eq!(station.poll_event(), Some(Event::Received(b"A")));
    }
}
