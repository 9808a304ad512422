//! The search for the next DLE, eight bytes at a time.

use crate::ascii::DLE;

const ONES: u64 = u64::from_le_bytes([0x01; 8]);
const HIGH_BITS: u64 = u64::from_le_bytes([0x80; 8]);
const DLES: u64 = u64::from_le_bytes([DLE; 8]);

/// Length of the run in front of the first DLE, and the XOR of that run.
#[inline]
pub(super) fn plain_run(bytes: &[u8]) -> (usize, u8) {
    let (words, tail) = bytes.as_chunks::<8>();
    let mut len = 0;
    let mut xor = 0;
    for word in words {
        let word = u64::from_le_bytes(*word);
        let found = dle_flags(word);
        if found != 0 {
            // The lowest flag is exact: a borrow can only raise false flags above a true one.
            let bits = found.trailing_zeros() & !7;
            let in_front = word & (1_u64 << bits).wrapping_sub(1);
            let run = bits / 8;
            return (len + run as usize, fold(xor ^ in_front));
        }
        xor ^= word;
        len += 8;
    }
    let mut xor = fold(xor);
    for &byte in tail {
        if byte == DLE {
            break;
        }
        xor ^= byte;
        len += 1;
    }
    (len, xor)
}

/// The high bit of every byte that is a DLE; bits above the lowest one may be false.
const fn dle_flags(word: u64) -> u64 {
    let zero_where_dle = word ^ DLES;
    zero_where_dle.wrapping_sub(ONES) & !zero_where_dle & HIGH_BITS
}

/// XOR of the eight bytes.
fn fold(word: u64) -> u8 {
    word.to_le_bytes()
        .into_iter()
        .fold(0, |xor, byte| xor ^ byte)
}
