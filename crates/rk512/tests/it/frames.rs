//! The checked frames: every telegram, its payload, and what 3964R makes of it on the wire.

use rk512::{
    Area, AreaKind, Command, Continuation, Message, Part, Reaction, ReactionError, Request,
    Telegram,
};

/// The body of a 3964R block: data with each 10h doubled, 10h 03h, and the XOR of all that.
fn body(payload: &[u8]) -> Vec<u8> {
    let mut wire = Vec::new();
    for &byte in payload {
        wire.push(byte);
        if byte == 0x10 {
            wire.push(byte);
        }
    }
    wire.extend([0x10, 0x03]);
    wire.push(wire.iter().fold(0, |bcc, byte| bcc ^ byte));
    wire
}

fn bytes(hex: &str) -> Vec<u8> {
    hex.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal"))
        .collect()
}

/// The telegram gives these bytes on the wire, and decodes to itself.
fn check(telegram: Telegram, wire: &str) {
    assert_eq!(body(&telegram), bytes(wire), "wire of {telegram:?}");
    let message = Message::decode(&telegram).expect("own telegram");
    assert_eq!(message.encode(), Ok(telegram));
}

fn words(range: core::ops::Range<u16>) -> Vec<u8> {
    range.flat_map(u16::to_be_bytes).collect()
}

fn send(area: Area, words: u16, data: &[u8]) -> Telegram {
    let command = Command::send(area, words).expect("DB or DX");
    command.telegram(data).expect("as long as announced")
}

fn fetch(area: Area, length: u16) -> Telegram {
    let command = Command::fetch(area, length).expect("not empty");
    command.telegram(&[]).expect("no data")
}

fn reaction(part: Part, code: u8, data: &[u8]) -> Telegram {
    let result = ReactionError::from_code(code).map_or(Ok(()), Err);
    let reaction = Reaction { part, result };
    reaction.telegram(data).expect("at most 128 bytes")
}

fn continuation(request: Request, data: &[u8]) -> Telegram {
    let continuation = Continuation::new(request);
    continuation.telegram(data).expect("at most 128 bytes")
}

#[test]
fn commands_on_the_wire() {
    check(
        send(Area::db(5, 10), 2, &[0x12, 0x34, 0xAB, 0xCD]),
        "00 00 41 44 05 0A 00 02 FF FF 12 34 AB CD 10 03 5B",
    );
    check(
        send(Area::dx(3, 7), 1, &[0x11, 0x22]),
        "00 00 4F 44 03 07 00 01 FF FF 11 22 10 03 2E",
    );
    for (area, length, wire) in [
        (Area::db(5, 0), 65, "05 00 00 41 FF FF 10 03 56"),
        // 16 is doubled.
        (Area::db(16, 0), 1, "10 10 00 00 01 FF FF 10 03 13"),
    ] {
        check(fetch(area, length), &format!("00 00 45 44 {wire}"));
    }
    let flags = "00 00 45 4D 00 14 00 04 FF FF 10 03 0B";
    check(fetch(Area::flags(20), 4), flags);
}

#[test]
fn continuations_on_the_wire() {
    let rest = continuation(Request::SendDb, &[0x00, 0x40]);
    check(rest, "FF 00 41 44 00 40 10 03 A9");
    let next = continuation(Request::Fetch(AreaKind::DataBlock), &[]);
    check(next, "FF 00 45 44 10 03 ED");
}

#[test]
fn reactions_on_the_wire() {
    assert_eq!(ReactionError::from_code(0x32), Some(ReactionError::Locked));
    for (part, code, data, wire) in [
        (Part::First, 0, &[][..], "00 00 00 00 10 03 13"),
        (Part::Continuation, 0, &[], "FF 00 00 00 10 03 EC"),
        (
            Part::Continuation,
            0,
            &[0x00, 0x40],
            "FF 00 00 00 00 40 10 03 AC",
        ),
        (Part::First, 0x32, &[], "00 00 00 32 10 03 21"),
        (Part::First, 0x10, &[], "00 00 00 10 10 10 03 13"),
        (Part::First, 0x36, &[], "00 00 00 36 10 03 25"),
    ] {
        check(reaction(part, code, data), wire);
    }
}

#[test]
fn send_db5_dw0_65_words_first_telegram() {
    let telegram = send(Area::db(5, 0), 65, &words(0..64));
    assert_eq!(telegram.len(), 138);
    let wire = body(&telegram);
    assert_eq!((wire.len(), wire.last()), (142, Some(&0x42)));
}

#[test]
fn fetch_reaction_words_0_to_63() {
    let telegram = reaction(Part::First, 0, &words(0..64));
    assert_eq!(telegram.len(), 132);
    let wire = body(&telegram);
    assert_eq!((wire.len(), wire.last()), (136, Some(&0x03)));
}
