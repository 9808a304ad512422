//! What is wrong at one side of a line.

use core::time::Duration;

/// What is wrong at one side: with its station, its circuits or its wire. Any of it may change
/// while the line works.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::exhaustive_structs,
    clippy::struct_excessive_bools,
    reason = "plain settings, to be written as a literal on top of `NONE`; each fault is there or not"
)]
pub struct Faults {
    /// It is off: sends nothing, hears nothing.
    pub is_dead: bool,
    /// Nothing reaches its receiver: the wire from the other's transmitter is open.
    pub is_deaf: bool,
    /// It hears its own characters too: echo of a two-wire line.
    pub hears_itself: bool,
    /// Nobody fetches what it receives: its receive buffer stays in use.
    pub keeps_telegrams: bool,
    /// Each of its outputs comes so much later.
    pub delay: Duration,
    /// Each of its blocks pauses for so long after its first character.
    pub pause: Duration,
    /// XOR on its check characters: where its payload has an odd and an even number of 10h.
    pub bcc_change: [u8; 2],
    /// It sends each 10h of its payload once; its check character is over what it sends.
    pub doubles_no_dle: bool,
    /// Bit error rate of its transmit wire: the probability that a bit arrives inverted.
    pub bit_error_rate: f64,
    /// The probability that its receiver takes a character for damaged.
    pub receiver_error_rate: f64,
}

impl Faults {
    /// A side that works.
    pub const NONE: Self = Self {
        is_dead: false,
        is_deaf: false,
        hears_itself: false,
        keeps_telegrams: false,
        delay: Duration::ZERO,
        pause: Duration::ZERO,
        bcc_change: [0; 2],
        doubles_no_dle: false,
        bit_error_rate: 0.0,
        receiver_error_rate: 0.0,
    };
}
