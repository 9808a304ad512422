//! Numbers as LEB128: seven bits a byte, low ones first, bit 7 set in all bytes but the last.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "bytes are cut out of numbers; lengths and shifts below 64"
)]

/// Most bytes of a number: 64 bits, 7 in each.
pub(crate) const MAX_LEN: usize = 10;

/// Why bytes are no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberError {
    /// They end too early.
    Truncated {
        /// Bytes given.
        len: usize,
    },
    /// More than 64 bits, or more bytes than it needs.
    TooLong {
        /// Its last byte, from 0.
        at: usize,
    },
}

/// Hands out the bytes of an unsigned number.
pub(crate) fn put_unsigned(mut number: u64, mut put: impl FnMut(u8)) {
    while number >> 7 > 0 {
        put(number as u8 | 0x80);
        number >>= 7;
    }
    put(number as u8);
}

/// Hands out the bytes of a signed number, with its sign in the lowest bit.
pub(crate) fn put_signed(number: i64, put: impl FnMut(u8)) {
    put_unsigned(((number << 1) ^ (number >> 63)) as u64, put);
}

/// Takes numbers from the front of bytes.
pub(crate) struct Reader<'b> {
    bytes: &'b [u8],
    rest: &'b [u8],
}

impl<'b> Reader<'b> {
    pub(crate) const fn new(bytes: &'b [u8]) -> Self {
        Self { bytes, rest: bytes }
    }

    /// The bytes that are left.
    pub(crate) const fn rest(&self) -> &'b [u8] {
        self.rest
    }

    pub(crate) fn byte(&mut self) -> Result<u8, NumberError> {
        let (&byte, rest) = self.rest.split_first().ok_or(NumberError::Truncated {
            len: self.bytes.len(),
        })?;
        self.rest = rest;
        Ok(byte)
    }

    pub(crate) fn unsigned(&mut self) -> Result<u64, NumberError> {
        let mut number = 0;
        for shift in (0..).step_by(7) {
            let byte = self.byte()?;
            let bits = u64::from(byte & 0x7F);
            // Of the tenth byte one bit is left; a last byte of 0 is one too many.
            if shift > 63 || bits << shift >> shift != bits || (byte == 0 && shift > 0) {
                let at = self.bytes.len() - self.rest.len() - 1;
                return Err(NumberError::TooLong { at });
            }
            number |= bits << shift;
            if byte & 0x80 == 0 {
                break;
            }
        }
        Ok(number)
    }

    pub(crate) fn signed(&mut self) -> Result<i64, NumberError> {
        let number = self.unsigned()?;
        Ok((number >> 1) as i64 ^ -((number & 1) as i64))
    }
}
