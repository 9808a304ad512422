//! What a terminal with `PARMRK` and a serial server (RFC 2217) hand on: in order, and any bytes.
#![no_main]

extern crate alloc;

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use proto3964r::CharacterError;
use proto3964r::tokio::Damage;

use port::{Frame, Heard, Marks, Telnet};

/// The decoders themselves, which are private in `line3964r`.
#[path = "../../tools/src/port"]
#[expect(dead_code, reason = "of each file only the decoder is used")]
mod port {
    mod frame;
    mod heard;
    mod marks;
    mod telnet;

    pub use frame::{Frame, Parity};
    pub(crate) use heard::Heard;
    pub(crate) use marks::Marks;
    pub(crate) use telnet::Telnet;
}

const IAC: u8 = 255;
const SB: u8 = 250;
const SE: u8 = 240;
const DONT: u8 = 254;
const COM_PORT: u8 = 44;
const NOTIFY_LINESTATE: u8 = 107;
const BREAK: u8 = 16;

/// Bytes with which a client asks for its port: all of its own accord.
const ASKED: usize = 80;

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    match u.int_in_range(0..=3)? {
        0 => terminal(u),
        1 => server(u),
        2 => any_bytes_of_a_terminal(u),
        _ => any_bytes_of_a_server(u),
    }
}

/// What a line carries.
fn heard(u: &mut Unstructured<'_>) -> Result<Heard> {
    Ok(match u.int_in_range(0..=3)? {
        0 => Err(Damage::Break),
        1 => Ok(IAC),
        _ => Ok(u.arbitrary()?),
    })
}

/// Nothing is lost and nothing invented.
fn terminal(u: &mut Unstructured<'_>) -> Result<()> {
    let mut marks = Marks::default();
    while !u.is_empty() {
        let wanted = match (heard(u)?, u.arbitrary()?) {
            (Ok(byte), true) if byte != 0 => Err(Damage::Character {
                byte,
                error: CharacterError::Parity,
            }),
            (heard, _) => heard,
        };
        let bytes = match wanted {
            Ok(0xFF) => vec![0xFF, 0xFF],
            Ok(byte) => vec![byte],
            Err(Damage::Character { byte, .. }) => vec![0xFF, 0, byte],
            Err(_) => vec![0xFF, 0, 0],
        };
        let read: Vec<_> = bytes.into_iter().filter_map(|it| marks.take(it)).collect();
        assert_eq!(read, [wanted]);
    }
    Ok(())
}

/// Commands and answers of any kind between the characters.
fn server(u: &mut Unstructured<'_>) -> Result<()> {
    let mut telnet = Telnet::new(Frame::DEFAULT);
    while !u.is_empty() {
        let (bytes, wanted) = match u.int_in_range(0..=3)? {
            0 => (vec![IAC, u.int_in_range(251..=254)?, u.arbitrary()?], None),
            1 => answer(&u.arbitrary::<Vec<u8>>()?),
            2 => answer(&[COM_PORT, NOTIFY_LINESTATE, u.arbitrary()?]),
            _ => {
                let byte = u.arbitrary()?;
                (Telnet::encode(byte).collect(), Some(Ok(byte)))
            }
        };
        let read: std::result::Result<Vec<_>, _> =
            bytes.into_iter().map(|it| telnet.take(it)).collect();
        match read {
            Ok(read) => assert_eq!(
                Vec::from_iter(read.into_iter().flatten()),
                Vec::from_iter(wanted)
            ),
            Err(refusal) => {
                assert!(!refusal.to_string().is_empty());
                break;
            }
        }
    }
    Ok(())
}

/// What stands between SB and SE, as it is written, and what it tells.
fn answer(data: &[u8]) -> (Vec<u8>, Option<Heard>) {
    let mut bytes = vec![IAC, SB];
    bytes.extend(data.iter().flat_map(|&byte| Telnet::encode(byte)));
    bytes.extend([IAC, SE]);
    let is_break = matches!(data, [COM_PORT, NOTIFY_LINESTATE, state] if state & BREAK != 0);
    (bytes, is_break.then_some(Err(Damage::Break)))
}

/// A byte is a character at most.
fn any_bytes_of_a_terminal(u: &mut Unstructured<'_>) -> Result<()> {
    let mut marks = Marks::default();
    while !u.is_empty() {
        let _ = marks.take(u.arbitrary()?);
    }
    // Whatever was open ends with a character and its neighbour.
    let _ = (marks.take(0x41), marks.take(0x41));
    assert_eq!(marks.take(0x42), Some(Ok(0x42)));
    Ok(())
}

/// The answers are no longer than what is answered, and what was open can be closed.
fn any_bytes_of_a_server(u: &mut Unstructured<'_>) -> Result<()> {
    let mut telnet = Telnet::new(Frame::DEFAULT);
    let (mut taken, mut written) = (0, 0);
    while !u.is_empty() {
        let byte: u8 = u.arbitrary()?;
        taken += 1;
        let refused = telnet.take(byte).is_err();
        written += telnet.replies().count();
        assert!(written <= ASKED + taken);
        if refused {
            return Ok(());
        }
    }
    for byte in [0, IAC, SE] {
        if telnet.take(byte).is_err() {
            return Ok(());
        }
    }
    assert_eq!(telnet.take(0x41), Ok(Some(Ok(0x41))));
    let refusal = [IAC, DONT, COM_PORT].map(|byte| telnet.take(byte));
    assert!(refusal[2].is_err());
    Ok(())
}
