//! What foreign senders do, and what the receiver makes of it.

use super::*;

/// A partner that insists on its STX sends NAK STX: twice, and it cancels in the BCC.
#[test]
fn what_a_partner_says_before_it_can_see_dle_is_no_data() {
    for early in [
        &[][..],
        &[STX],
        &[NAK, STX],
        &[NAK, STX, NAK, STX],
        &[STX, STX],
    ] {
        for line in [Line::Instant, uart()] {
            let mut station = Station::<64>::new(low(line));
            station.handle_byte(ms(0), STX);
            // On an instant line DLE has to wait in the station for that.
            let mut out = match line {
                Line::Instant => vec![],
                _ => sent(&mut station, ms(0)),
            };
            assert!(hear(&mut station, Duration::from_micros(1700), early).is_empty());
            out.extend(sent(&mut station, ms(2)));
            assert_eq!(out, [DLE], "one for all of them");
            let telegrams = hear(&mut station, ms(9), &[0x41, 0x10, 0x03, 0x52]);
            assert_eq!(telegrams, [b"A"], "{early:02X?} {line:?}");
        }
    }
}

/// As soon as the partner can have seen our DLE, they are data.
#[test]
fn stx_and_nak_after_dle_are_data() {
    let mut station = Station::<64>::new(low(uart()));
    station.handle_byte(ms(0), STX);
    assert_eq!(sent(&mut station, ms(0)), [DLE]);
    let block = [NAK, STX, 0x10, 0x03, 0x04];
    let answered = CHARACTER + CHARACTER / 2;
    assert_eq!(hear(&mut station, answered, &block), [[NAK, STX]]);
}

/// An adapter hands on what came in together: the end of one telegram and all of the next.
#[test]
fn two_telegrams_in_one_read() {
    let both = [
        STX, 0x41, 0x10, 0x03, 0x52, STX, 0x42, 0x10, 0x03, 0x51, STX, 0x43,
    ];
    for line in [Line::Instant, uart(), Line::buffered(9600, 11)] {
        let mut station = Station::<64>::new(low(line));
        assert_eq!(station.handle_bytes(ms(0), &both), 5);
        assert_eq!(station.poll_event(), Some(Event::Received(b"A")));
        assert_eq!(sent(&mut station, ms(0)), [DLE, DLE]);
        assert_eq!(station.handle_bytes(ms(0), &both[5..]), 5);
        assert_eq!(station.poll_event(), Some(Event::Received(b"B")));
        assert_eq!(sent(&mut station, ms(0)), [DLE, DLE]);
        assert_eq!(station.handle_bytes(ms(0), &both[10..]), 2);
        assert_eq!(sent(&mut station, ms(0)), [DLE]);
        // Who does not poll makes the partner wait, but gets on.
        let mut station = Station::<64>::new(low(line));
        assert_eq!(station.handle_bytes(ms(0), &both), 5);
        assert_eq!(station.handle_bytes(ms(0), &both[5..]), 7);
        assert_eq!(station.poll_event(), Some(Event::Received(b"A")));
        assert_eq!(station.poll_event(), None);
    }
}

/// A stray byte between NAK and the repeat must not cost the repeat, nor a second NAK.
#[test]
fn noise_before_a_repeat_is_ignored() {
    for noise in [0x77, DLE] {
        let mut station = Station::<64>::new(low(uart()));
        assert!(hear(&mut station, ms(0), &[STX, 0x41, 0x10, 0x03, 0x00]).is_empty());
        assert_eq!(sent(&mut station, ms(0)), [DLE, NAK]);
        station.handle_byte(ms(5), noise);
        assert_eq!(sent(&mut station, ms(5)), [0_u8; 0]);
        station.handle_byte(ms(55), STX);
        assert_eq!(sent(&mut station, ms(55)), [DLE]);
        let repeat = hear(&mut station, ms(60), &[0x41, 0x10, 0x03, 0x52]);
        assert_eq!(repeat, [b"A"]);
    }
}

/// The wait for the repeat ends in time, whatever comes in.
#[test]
fn noise_does_not_prolong_the_wait_for_a_repeat() {
    let mut station = Station::<64>::new(low(Line::Instant));
    assert!(hear(&mut station, ms(0), &[STX, 0x41, 0x10, 0x03, 0x00]).is_empty());
    assert_eq!(sent(&mut station, ms(0)), [DLE, NAK]);
    for time in (100..4000).step_by(100) {
        station.handle_byte(ms(time), 0x77);
    }
    assert_eq!(station.poll_timeout(), Some(ms(4000)));
}

/// At the end of time a gap is none, for a block in one piece and for its characters one by one.
#[test]
fn the_end_of_time_is_no_gap() {
    let telegram = [STX, 0x41, 0x42, 0x10, 0x03, 0x10];
    for before_the_end in [0, 1, 100_000_000, 220_000_000] {
        let now = Duration::MAX - Duration::from_nanos(before_the_end);
        let mut whole = Station::<64>::new(low(Line::Instant));
        let mut single = whole.clone();
        assert_eq!(whole.handle_bytes(now, &telegram), telegram.len());
        for byte in telegram {
            single.handle_byte(now, byte);
        }
        assert_eq!(whole, single);
        assert_eq!(whole.poll_event(), Some(Event::Received(b"AB")));
    }
}

/// What a damaged repeat says is reported as before.
#[test]
fn a_second_bad_block_is_answered_nak_again() {
    let mut station = Station::<64>::new(low(uart()));
    for begin in [0, 100] {
        let taken = station.handle_bytes(ms(begin), &[STX, 0x41, 0x10, 0x03, 0x00]);
        assert_eq!(taken, 5);
        assert_eq!(sent(&mut station, ms(begin)), [DLE, NAK]);
        let bad = Rejection::Frame(FrameError::Bcc {
            computed: 0x52,
            received: 0,
        });
        assert_eq!(station.poll_event(), Some(Event::Rejected(bad)));
    }
}
