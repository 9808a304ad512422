//! The frames of the sources, and the identities of the body.

use alloc::{vec, vec::Vec};

use proptest::prelude::*;

use super::*;

fn encoded(payload: &[u8], check: Check) -> Vec<u8> {
    let mut out = vec![0; max_encoded_len(payload.len())];
    let len = encode(payload, check, &mut out).unwrap();
    out.truncate(len);
    out
}

/// RK512 and EUCHNER frames with the values that their manuals print or that follow from them.
#[test]
fn known_bodies() {
    let hex = |text: &str| -> Vec<u8> {
        text.split(' ')
            .map(|byte| u8::from_str_radix(byte, 16).unwrap())
            .collect()
    };
    for body in [
        "37 10 03 24",
        "6C A5 D5 C3 C8 CE C5 D2 10 03 DD",
        "00 00 41 44 05 0A 00 02 FF FF 12 34 AB CD 10 03 5B",
        "00 00 45 44 10 10 00 00 01 FF FF 10 03 13",
        "00 00 00 10 10 10 03 13",
        "FF 00 00 00 00 40 10 03 AC",
        "6C 49 35 10 03 03",
        "6C 42 49 35 43 10 03 02",
    ] {
        let body = hex(body);
        let mut buffer = [0; 32];
        let (payload, rest) = decode(&body, Check::Bcc, &mut buffer).unwrap();
        assert!(rest.is_empty());
        assert_eq!(encoded(payload, Check::Bcc), body);
    }
}

#[test]
fn rk512_send_of_65_words() {
    let mut payload = vec![0x00, 0x00, 0x41, 0x44, 0x05, 0x00, 0x00, 0x41, 0xFF, 0xFF];
    payload.extend((0..64_u8).flat_map(|word| [0, word]));
    let body = encoded(&payload, Check::Bcc);
    assert_eq!(
        (payload.len(), body.len(), body.last()),
        (138, 142, Some(&0x42))
    );
}

#[test]
fn the_output_is_too_short_by_one() {
    let mut out = [0; 6];
    assert_eq!(
        encode(&[1, 0x10, 2], Check::Bcc, &mut out),
        Err(EncodeError::BufferTooSmall {
            needed: 7,
            available: 6
        })
    );
}

#[test]
fn the_payload_is_longer_than_any_block() {
    let payload = vec![0; 65536];
    let mut out = vec![0; 70_000];
    assert_eq!(
        encode(&payload, Check::Bcc, &mut out),
        Err(EncodeError::PayloadTooLong { len: 65536 })
    );
    assert_eq!(encode(&payload[1..], Check::Bcc, &mut out), Ok(65538));
}

#[test]
fn errors_name_place_and_value() {
    let mut buffer = [0; 4];
    let mut error = |body: &[u8]| decode(body, Check::Bcc, &mut buffer).unwrap_err();
    assert_eq!(
        error(&[0x41, 0x10, 0x03, 0x00]),
        FrameError::Bcc {
            computed: 0x52,
            received: 0
        }
        .into()
    );
    assert_eq!(
        error(&[0x41, 0x10, 0x42, 0x10, 0x03, 0]),
        FrameError::IllegalDle {
            byte: 0x42,
            offset: 1
        }
        .into()
    );
    assert_eq!(
        error(&[1, 2, 3, 4, 5, 0x10, 0x03, 0]),
        FrameError::TooLong { capacity: 4 }.into()
    );
    assert_eq!(
        error(&[0x41, 0x10, 0x03]),
        DecodeError::Incomplete { len: 3 }
    );
}

#[test]
fn rules_for_an_illegal_dle() {
    let body = [0x10, 0x41, 0x10, 0x03, 0x52 ^ 0x10];
    let mut buffer = [0; 4];
    let mut feed = |rule| {
        Decoder::new(Check::Bcc)
            .with_illegal_dle(rule)
            .feed(&body, &mut buffer)
    };
    let error = Some(Err(FrameError::IllegalDle {
        byte: 0x41,
        offset: 0,
    }));
    assert_eq!(feed(IllegalDle::RejectAtEnd), (5, error));
    assert_eq!(feed(IllegalDle::RejectAtOnce), (2, error));
    assert_eq!(feed(IllegalDle::Accept), (5, Some(Ok(1))));
}

/// One flipped bit makes an accepted frame: 12h becomes 10h, which pairs with the 03h after it,
/// and the next data byte is the right BCC by chance. Parity would catch it.
#[test]
fn one_bit_forgery() {
    let payload = [0x41, 0x12, 0x03, 0x52];
    let mut body = encoded(&payload, Check::Bcc);
    body[1] ^= 0x02;
    let mut buffer = [0; 8];
    let (forged, rest) = decode(&body, Check::Bcc, &mut buffer).unwrap();
    assert_eq!(forged, b"A");
    assert!(!rest.is_empty());
}

/// The first half of a doubled DLE is damaged: the second half now pairs with the 03h after it.
#[test]
fn forgery_by_half_a_doubled_dle() {
    let payload = [0x41, 0x10, 0x03, 0xDE];
    let mut body = encoded(&payload, Check::Bcc);
    assert_eq!(body[1..4], [0x10, 0x10, 0x03]);
    body[1] = 0x8C;
    let mut buffer = [0; 8];
    let (forged, _) = decode(&body, Check::Bcc, &mut buffer).unwrap();
    assert_eq!(forged, [0x41, 0x8C]);
}

/// Payloads with many control characters in them.
fn payload() -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![Just(0x02), Just(0x03), Just(0x10), Just(0x15), any::<u8>()];
    prop::collection::vec(byte, 0..80)
}

fn check() -> impl Strategy<Value = Check> {
    prop_oneof![Just(Check::None), Just(Check::Bcc)]
}

proptest! {
    #[test]
    fn decode_inverts_encode(payload in payload(), check in check()) {
        let body = encoded(&payload, check);
        prop_assert_eq!(body.len(), encoded_len(&payload, check));
        let mut buffer = vec![0; payload.len()];
        let (decoded, rest) = decode(&body, check, &mut buffer).unwrap();
        prop_assert_eq!(decoded, &payload[..]);
        prop_assert!(rest.is_empty());
    }

    #[test]
    fn xor_of_a_body_is_zero(payload in payload()) {
        let body = encoded(&payload, Check::Bcc);
        let doubled = payload.iter().filter(|&&byte| byte == 0x10).count();
        prop_assert_eq!(body.len(), payload.len() + doubled + 3);
        prop_assert_eq!(body.iter().fold(0, |xor, byte| xor ^ byte), 0);
    }

    /// Every substitution of one byte is rejected, but for three that end the block early where
    /// the right BCC happens to follow. Two shift how the DLEs of the run after them pair, up to
    /// one before a 03h: a data byte becomes a DLE, or the first half of a doubled DLE
    /// becomes something else. The third turns the second half of a doubled DLE into a 03h.
    #[test]
    fn one_wrong_byte_is_seen(payload in payload(), at in any::<prop::sample::Index>(), flip in 1..=255_u8) {
        let mut body = encoded(&payload, Check::Bcc);
        let at = at.index(body.len());
        body[at] ^= flip;
        let mut buffer = vec![0; 2 * payload.len() + 2];
        if let Ok((_, rest)) = decode(&body, Check::Bcc, &mut buffer) {
            let end = body.len() - rest.len() - 3;
            prop_assert_eq!((body[end], body[end + 1]), (0x10, 0x03));
            let was_dle = body[at] ^ flip == 0x10;
            let run = || body[at + 1..=end].iter().all(|&byte| byte == 0x10);
            let forged = match end.checked_sub(at) {
                Some(shift) if body[at] == 0x10 => shift % 2 == 0 && run(),
                Some(shift) => was_dle && shift % 2 == 1 && run(),
                None => end + 1 == at && was_dle && body[at] == 0x03,
            };
            prop_assert!(forged);
        }
    }

    /// The pieces in which a body arrives make no difference, nor does the buffer's size change
    /// where it ends.
    #[test]
    fn any_split_gives_the_same(
        mut body in prop::collection::vec(prop_oneof![Just(0x03), Just(0x10), any::<u8>()], 0..120),
        cuts in prop::collection::vec(1..20_usize, 0..12),
        capacity in 0..60_usize,
    ) {
        body.extend([0x10, 0x03, 0x00]);
        let (mut one, mut many) = (Decoder::new(Check::Bcc), Decoder::new(Check::Bcc));
        let (mut one_buffer, mut many_buffer) = (vec![0; capacity], vec![0; capacity]);
        let byte_by_byte = body
            .iter()
            .enumerate()
            .find_map(|(at, &byte)| Some((at + 1, one.push(byte, &mut one_buffer)?)));
        let (mut at, mut in_pieces) = (0, None);
        for cut in cuts.into_iter().chain([body.len()]) {
            let piece = &body[at..body.len().min(at + cut)];
            let (taken, end) = many.feed(piece, &mut many_buffer);
            at += taken;
            if let Some(block) = end {
                in_pieces = Some((at, block));
                break;
            }
        }
        prop_assert_eq!(byte_by_byte, in_pieces);
        prop_assert_eq!(one_buffer, many_buffer);
    }

    /// A body written in pieces is the body.
    #[test]
    fn encoded_in_pieces(payload in payload(), pieces in prop::collection::vec(0..9_usize, 1..10)) {
        let mut encoder = Encoder::START;
        let mut body = Vec::new();
        for len in pieces.into_iter().cycle().take(300).chain([400]) {
            let mut out = [0; 400];
            let written = encoder.fill(Check::Bcc, &payload, &mut out[..len]);
            body.extend(&out[..written]);
            body.extend(encoder.next_byte(Check::Bcc, &payload));
        }
        prop_assert!(encoder.is_done());
        prop_assert_eq!(body, encoded(&payload, Check::Bcc));
    }

    /// Two swapped data bytes pass: the check knows no order.
    #[test]
    fn a_swap_is_not_seen(payload in prop::collection::vec(0x20..=0xFF_u8, 2..40), at in any::<prop::sample::Index>()) {
        let mut body = encoded(&payload, Check::Bcc);
        let at = at.index(payload.len() - 1);
        body.swap(at, at + 1);
        let mut buffer = [0; 40];
        prop_assert!(decode(&body, Check::Bcc, &mut buffer).is_ok());
    }
}
