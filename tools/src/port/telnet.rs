//! RFC 2217: a serial port over TELNET.

use alloc::collections::VecDeque;

use proto3964r::tokio::Damage;
use thiserror::Error;

use super::{Frame, Parity, heard::Heard};

// RFC 854, 856, 858, 2217.
const SE: u8 = 240;
const NOP: u8 = 241;
const SB: u8 = 250;
const WILL: u8 = 251;
const WONT: u8 = 252;
const DO: u8 = 253;
const DONT: u8 = 254;
const IAC: u8 = 255;
const BINARY: u8 = 0;
const SUPPRESS_GO_AHEAD: u8 = 3;
const COM_PORT: u8 = 44;
/// What the client asks; the server answers with 100 more.
const SET_BAUDRATE: u8 = 1;
const SET_DATASIZE: u8 = 2;
const SET_PARITY: u8 = 3;
const SET_STOPSIZE: u8 = 4;
const SET_CONTROL: u8 = 5;
const SET_LINESTATE_MASK: u8 = 10;
const SERVER: u8 = 100;
const NOTIFY_LINESTATE: u8 = 7;
const LINESTATE_BREAK: u8 = 16;
const NO_FLOW_CONTROL: u8 = 1;

/// Longest answer of a server that is read; the rest of a longer one is dropped.
const LONGEST: usize = 64;

/// The client's end of a TELNET connection to a serial server.
#[derive(Debug)]
pub(crate) struct Telnet {
    state: State,
    /// Settings that the server has not confirmed: the command, its name and value.
    open: Vec<(u8, &'static str, u32)>,
    answered: bool,
    /// What is to be written before anything else.
    replies: VecDeque<u8>,
}

#[derive(Debug)]
enum State {
    Data,
    Command,
    /// After one of WILL, WONT, DO, DONT.
    Option(u8),
    /// After SB: the option and its data.
    Inside(Vec<u8>),
    /// After IAC in those.
    InsideCommand(Vec<u8>),
}

/// Why a serial server cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub(crate) enum Refusal {
    #[error(
        "the server does not set up a serial port (RFC 2217); as a raw one it is tcp://HOST:PORT"
    )]
    NoComPort,
    #[error("the server sets {name} to {set} in place of {wanted}")]
    Setting {
        name: &'static str,
        wanted: u32,
        set: u32,
    },
}

impl Telnet {
    /// What means nothing to the server.
    pub(crate) const NOTHING: [u8; 2] = [IAC, NOP];

    /// Asks for a port with this frame.
    pub(crate) fn new(frame: Frame) -> Self {
        let parity = match frame.parity {
            Parity::None => 1,
            Parity::Odd => 2,
            Parity::Even => 3,
        };
        let settings = [
            (SET_BAUDRATE, "baud", frame.baud),
            (SET_DATASIZE, "data bits", 8),
            (SET_PARITY, "parity", parity),
            (SET_STOPSIZE, "stop", frame.stop_bits.into()),
            (SET_CONTROL, "flow control", NO_FLOW_CONTROL.into()),
        ];
        let mut telnet = Self {
            state: State::Data,
            open: settings.to_vec(),
            answered: false,
            replies: VecDeque::new(),
        };
        for option in [BINARY, SUPPRESS_GO_AHEAD] {
            telnet.replies.extend([IAC, WILL, option, IAC, DO, option]);
        }
        telnet.replies.extend([IAC, WILL, COM_PORT]);
        telnet
    }

    /// Whether the server has confirmed all settings.
    pub(crate) fn is_ready(&self) -> bool {
        self.open.is_empty()
    }

    /// What is to be written before anything else.
    pub(crate) fn replies(&mut self) -> impl Iterator<Item = u8> {
        self.replies.drain(..)
    }

    /// A character of data as it is written.
    pub(crate) fn encode(byte: u8) -> impl Iterator<Item = u8> {
        let count = if byte == IAC { 2 } else { 1 };
        core::iter::repeat_n(byte, count)
    }

    /// Takes a byte of the connection; returns what it completes.
    ///
    /// # Errors
    /// The server does otherwise than was asked.
    pub(crate) fn take(&mut self, byte: u8) -> Result<Option<Heard>, Refusal> {
        let state = core::mem::replace(&mut self.state, State::Data);
        let mut heard = None;
        self.state = match (state, byte) {
            (State::Data, IAC) => State::Command,
            (State::Command, IAC) | (State::Data, _) => {
                heard = Some(Ok(byte));
                State::Data
            }
            (State::Command, WILL | WONT | DO | DONT) => State::Option(byte),
            (State::Command, SB) => State::Inside(Vec::new()),
            (State::Command, _) => State::Data,
            (State::Option(verb), _) => {
                self.negotiate(verb, byte)?;
                State::Data
            }
            (State::Inside(data), IAC) => State::InsideCommand(data),
            (State::InsideCommand(data), SE) => {
                heard = self.answer(&data)?;
                State::Data
            }
            (State::InsideCommand(mut data) | State::Inside(mut data), _) => {
                if data.len() < LONGEST {
                    data.push(byte);
                }
                State::Inside(data)
            }
        };
        Ok(heard)
    }

    fn negotiate(&mut self, verb: u8, option: u8) -> Result<(), Refusal> {
        match (verb, option) {
            (DO, COM_PORT) if !self.answered => {
                self.answered = true;
                self.ask();
            }
            (DONT, COM_PORT) => return Err(Refusal::NoComPort),
            // Asked for, or granted.
            (_, BINARY | SUPPRESS_GO_AHEAD | COM_PORT) | (WONT | DONT, _) => {}
            (WILL, _) => self.replies.extend([IAC, DONT, option]),
            (_, _) => self.replies.extend([IAC, WONT, option]),
        }
        Ok(())
    }

    /// Asks for the settings.
    fn ask(&mut self) {
        for &(command, _, value) in &self.open {
            let bytes = value.to_be_bytes();
            let [.., last] = bytes;
            let value: &[u8] = match command {
                SET_BAUDRATE => &bytes,
                _ => &[last],
            };
            let value = value.iter().flat_map(|&byte| Self::encode(byte));
            self.replies.extend([IAC, SB, COM_PORT, command]);
            self.replies.extend(value);
            self.replies.extend([IAC, SE]);
        }
        let mask = [
            IAC,
            SB,
            COM_PORT,
            SET_LINESTATE_MASK,
            LINESTATE_BREAK,
            IAC,
            SE,
        ];
        self.replies.extend(mask);
    }

    /// Takes what the server says of its port.
    fn answer(&mut self, data: &[u8]) -> Result<Option<Heard>, Refusal> {
        let [COM_PORT, command, value @ ..] = data else {
            return Ok(None);
        };
        let command = command.wrapping_sub(SERVER);
        let set = match (command, value) {
            (SET_BAUDRATE, &[a, b, c, d]) => u32::from_be_bytes([a, b, c, d]),
            (SET_BAUDRATE, _) => return Ok(None),
            (_, &[value]) => value.into(),
            _ => return Ok(None),
        };
        if command == NOTIFY_LINESTATE {
            let is_break = set & u32::from(LINESTATE_BREAK) != 0;
            return Ok(is_break.then_some(Err(Damage::Break)));
        }
        let asked = self.open.iter().position(|&(open, ..)| open == command);
        if let Some(at) = asked {
            let (_, name, wanted) = self.open.remove(at);
            if set != wanted {
                return Err(Refusal::Setting { name, wanted, set });
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn take_all(telnet: &mut Telnet, bytes: &[u8]) -> Result<Vec<Heard>, Refusal> {
        let heard = bytes.iter().map(|&byte| telnet.take(byte));
        heard.filter_map(Result::transpose).collect()
    }

    /// A client whose server has granted the option; the bytes with which it asks are gone.
    fn granted() -> Telnet {
        let mut telnet = Telnet::new(Frame::DEFAULT);
        take_all(&mut telnet, &[IAC, DO, COM_PORT]).unwrap();
        drop(telnet.replies());
        telnet
    }

    /// Bytes after the example of RFC 2217 and the definitions of RFC 855.
    #[test]
    fn a_port_is_set_up() {
        let mut telnet = Telnet::new(Frame::DEFAULT);
        let asked: Vec<_> = telnet.replies().collect();
        assert_eq!(asked[12..], [255, 251, 44]);
        assert_eq!(take_all(&mut telnet, &[255, 253, 44]), Ok(vec![]));
        let settings: Vec<_> = telnet.replies().collect();
        let baud = [255, 250, 44, 1, 0, 0, 0x25, 0x80, 255, 240];
        assert_eq!(settings[..10], baud);
        let rest = [
            [255, 250, 44, 2, 8, 255, 240],
            [255, 250, 44, 3, 3, 255, 240],
            [255, 250, 44, 4, 1, 255, 240],
            [255, 250, 44, 5, 1, 255, 240],
            [255, 250, 44, 10, 16, 255, 240],
        ];
        assert_eq!(settings[10..], rest.concat());

        let baud = [255, 250, 44, 101, 0, 0, 0x25, 0x80, 255, 240];
        let rest = [
            [255, 250, 44, 102, 8, 255, 240],
            [255, 250, 44, 103, 3, 255, 240],
            [255, 250, 44, 104, 1, 255, 240],
            [255, 250, 44, 105, 1, 255, 240],
        ];
        assert_eq!(take_all(&mut telnet, &baud), Ok(vec![]));
        assert!(!telnet.is_ready());
        assert_eq!(take_all(&mut telnet, &rest.concat()), Ok(vec![]));
        assert!(telnet.is_ready());
    }

    #[test]
    fn what_a_server_refuses_is_named() {
        let refusal = take_all(&mut Telnet::new(Frame::DEFAULT), &[IAC, DONT, COM_PORT]);
        assert_eq!(refusal, Err(Refusal::NoComPort));
        let baud = [IAC, SB, COM_PORT, 101, 0, 0, 0x4B, 0, IAC, SE];
        let refusal = take_all(&mut granted(), &baud).unwrap_err();
        assert_eq!(
            refusal.to_string(),
            "the server sets baud to 19200 in place of 9600"
        );
    }

    #[test]
    fn other_options_are_declined_once() {
        let mut telnet = granted();
        let offers = [IAC, WILL, 1, IAC, DO, 24, IAC, WONT, 1, IAC, DONT, 24];
        assert_eq!(take_all(&mut telnet, &offers), Ok(vec![]));
        let replies: Vec<_> = telnet.replies().collect();
        assert_eq!(replies, [IAC, DONT, 1, IAC, WONT, 24]);
    }

    #[test]
    fn break_is_heard() {
        let state = [0x41, IAC, SB, COM_PORT, 107, 16, IAC, SE, 0x42];
        let heard = take_all(&mut granted(), &state);
        assert_eq!(heard, Ok(vec![Ok(0x41), Err(Damage::Break), Ok(0x42)]));
        // The state of a line is one byte.
        let longer = [IAC, SB, COM_PORT, 107, 0, 0, 0, 16, IAC, SE];
        assert_eq!(take_all(&mut granted(), &longer), Ok(vec![]));
    }

    proptest! {
        #[test]
        fn data_come_through(data in prop::collection::vec(prop_oneof![any::<u8>(), Just(IAC)], 0..64)) {
            let written: Vec<_> = data.iter().flat_map(|&byte| Telnet::encode(byte)).collect();
            let wanted: Vec<Heard> = data.into_iter().map(Ok).collect();
            prop_assert_eq!(take_all(&mut granted(), &written), Ok(wanted));
        }

        /// No panic, no memory without bound, and data after it as usual.
        #[test]
        fn any_bytes(
            bytes in prop::collection::vec(
                prop_oneof![any::<u8>(), 240..=255_u8, Just(COM_PORT), 100..=112_u8], 0..400,
            ),
        ) {
            let mut telnet = granted();
            let refused = take_all(&mut telnet, &bytes).is_err();
            if let State::Inside(data) | State::InsideCommand(data) = &telnet.state {
                prop_assert!(data.len() <= LONGEST);
            }
            // Out of whatever was open: the 0 ends an option, IAC SE a longer one.
            if !refused && let Ok(end) = take_all(&mut telnet, &[0, IAC, SE, 0x41]) {
                prop_assert_eq!(end.last(), Some(&Ok(0x41)));
            }
        }
    }
}
