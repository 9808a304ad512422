//! How the characters of a line are made.

/// The character frame of a line: one start bit, 8 data bits, parity, stop bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_structs, reason = "the settings of a UART")]
pub struct Frame {
    /// Bits per second, not 0.
    pub baud: u32,
    /// Parity bit.
    pub parity: Parity,
    /// Stop bits, 1 or 2.
    pub stop_bits: u8,
}

/// Parity bit of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_enums, reason = "3964R knows these")]
pub enum Parity {
    /// None: 8N1.
    None,
    /// Even: 8E1.
    Even,
    /// Odd: 8O1.
    Odd,
}

impl Frame {
    /// 9600 bit/s, 8E1: what Siemens' communication processors come with.
    pub const DEFAULT: Self = Self {
        baud: 9600,
        parity: Parity::Even,
        stop_bits: 1,
    };

    /// Bits of a character on the line: 11 for 8E1, 10 for 8N1.
    #[must_use]
    pub const fn bits(self) -> u8 {
        let parity = match self.parity {
            Parity::None => 0,
            Parity::Even | Parity::Odd => 1,
        };
        1 + 8 + parity + self.stop_bits
    }
}
