//! Mistakes of a receiver.

use proto3964r::{
    Activity,
    frame::{Check, encode},
};

use super::*;

#[test]
fn m02_dle_before_anything_else_is_an_error() {
    let mut station = after_hearing::<64>(&[STX, 0x10, 0x41, 0x42, 0x10, 0x03, 0x10]);
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
fn m06_a_buffer_that_becomes_free_is_seen_at_once() {
    let mut station = after_hearing::<64>(&[STX, 0x41, 0x10, 0x03, 0x52]);
    assert_eq!(sent(&mut station, ms(0)), [DLE, DLE]);
    station.handle_byte(ms(10), STX);
    assert_eq!(sent(&mut station, ms(10)), [0_u8; 0]);
    assert_eq!(station.poll_timeout(), Some(ms(410)));
    assert_eq!(station.poll_event(), Some(Event::Received(b"A")));
    assert!(station.poll_timeout().is_some_and(|due| due <= ms(10)));
    station.handle_timeout(ms(10));
    assert_eq!(sent(&mut station, ms(10)), [DLE]);
    hear(&mut station, ms(10), &[0x42, 0x10, 0x03, 0x51]);
    assert_eq!(station.poll_event(), Some(Event::Received(b"B")));
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
    let mut station = after_hearing::<64>(&[STX, 0x00, 0x41, 0x00, 0x10, 0x03, 0x52]);
    assert_eq!(
        station.poll_event(),
        Some(Event::Received(&[0x00, 0x41, 0x00]))
    );
}

#[test]
fn m11_a_wrong_bcc_is_answered_nak() {
    for bcc in (0..=255).filter(|&bcc| bcc != 0x52) {
        let mut station = after_hearing::<64>(&[STX, 0x41, 0x10, 0x03, bcc]);
        assert_eq!(sent(&mut station, ms(0)), [DLE, NAK]);
        assert!(matches!(station.poll_event(), Some(Event::Rejected(_))));
        assert_eq!(station.poll_event(), None);
    }
}

#[test]
fn m12_the_bcc_covers_the_doubled_dle() {
    let mut station = asking::<64>(low(), &[0x10]);
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
    let mut station = after_hearing::<64>(&[STX, 0x10, 0x10, 0x03, 0x41, 0x10, 0x03, 0x51]);
    assert_eq!(
        station.poll_event(),
        Some(Event::Received(&[0x10, 0x03, 0x41]))
    );
}

#[test]
fn m14_a_block_too_long_is_swallowed_to_its_end() {
    let mut station = after_hearing::<4>(&[STX, 1, 2, 3, 4, 5, STX, 0x41, 0x15, 0x10, 0x03]);
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

/// What is left of a block, once a damaged character has made an end of its data, holds an STX, and
/// the BCC happens to be that of the characters after it as well.
#[test]
fn the_rest_of_a_block_that_seemed_to_end_is_no_telegram() {
    let data = [0x00, 0x0C, 0xF3, 0x10, 0x03, 0x02, 0xFF, 0x10, 0x03, 0x02];
    let data = [&data[..], &[0xFF, 0x10, 0x03, 0x02]].concat();
    let mut block = [0; 32];
    let len = encode(&data, Check::Bcc, &mut block).unwrap();
    let block = &mut block[..len];
    let mut station = Station::<64>::new(low());
    station.handle_byte(ms(0), STX);
    assert_eq!(sent(&mut station, ms(0)), [DLE]);
    block[3] = 0x00; // the first of a doubled DLE
    assert_eq!(block[3..7], [0x00, 0x10, 0x03, STX]);
    hear(&mut station, ms(0), block);
    assert_eq!(sent(&mut station, ms(0)), [NAK]);
    assert_eq!(station.activity(), Activity::AwaitRepeat);
    assert!(matches!(station.poll_event(), Some(Event::Rejected(_))));
    assert_eq!(station.poll_event(), None);

    block[3] = DLE;
    station.handle_byte(ms(0), STX);
    assert_eq!(sent(&mut station, ms(0)), [DLE]);
    hear(&mut station, ms(0), block);
    assert_eq!(station.poll_event(), Some(Event::Received(&data[..])));
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
        assert_eq!(sent(&mut station, ms(0)), [0_u8; 0]);
        assert_eq!(station.poll_event(), None);
    }
}

/// The reception of a partner that never stops sending ends, and so does every job.
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
