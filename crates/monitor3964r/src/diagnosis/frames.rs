//! Blocks that are wrong in the same way each time: that is no noise.

use core::time::Duration;

use proto3964r::ascii::{DLE, NAK, STX};

use super::delay::ALONE;
use crate::monitor::{Character, since};

/// FNV-1a of 32 bits.
const HASH: u32 = 0x811C_9DC5;
const HASH_FACTOR: u32 = 0x0100_0193;

/// What speaks for a sender that frames its blocks in its own way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frames {
    /// Of the characters of the block so far.
    hash: u32,
    xor: u8,
    dles: u32,
    /// Of the last bad block.
    before: Option<u32>,
    /// When a bad block ended after which nothing has come.
    ended: Option<Duration>,
    /// Bad blocks with the characters of the bad one before.
    pub(super) same: u32,
    /// Blocks of which DLE and a character that may not follow it are in the BCC, and those that go
    /// on after what reads as their BCC.
    pub(super) undoubled: u32,
    /// Good blocks with 10h in their data.
    pub(super) doubled: u32,
}

impl Default for Frames {
    fn default() -> Self {
        Self {
            hash: HASH,
            xor: 0,
            dles: 0,
            before: None,
            ended: None,
            same: 0,
            undoubled: 0,
            doubled: 0,
        }
    }
}

impl Frames {
    pub(super) const fn begin(&mut self) {
        self.hash = HASH;
        self.xor = 0;
        self.dles = 0;
        self.ended = None;
    }

    /// A character of a block.
    pub(super) fn take(&mut self, byte: u8) {
        self.hash = (self.hash ^ u32::from(byte)).wrapping_mul(HASH_FACTOR);
        self.xor ^= byte;
        self.dles = self.dles.saturating_add(u32::from(byte == DLE));
    }

    /// The block that has just ended is good.
    pub(super) const fn is_good(&mut self) {
        // A pair, that of the end, and perhaps the BCC.
        if self.dles > 2 {
            self.doubled = self.doubled.saturating_add(1);
        }
    }

    /// The block that has just ended is bad, though none of its characters came in damaged.
    pub(super) fn is_bad(&mut self, at: Duration, has_illegal_dle: bool) {
        if self.before.replace(self.hash) == Some(self.hash) {
            self.same = self.same.saturating_add(1);
        }
        if !has_illegal_dle {
            self.ended = Some(at);
        } else if self.xor == 0 {
            self.undoubled = self.undoubled.saturating_add(1);
        }
    }

    /// A character of the side outside of its blocks.
    pub(super) fn after_block(&mut self, heard: Character) {
        // A port without marks reads 00h where STX is damaged.
        if let Some(ended) = self.ended.take()
            && since(ended, heard.at) <= ALONE
            && heard.error.is_none()
            && !matches!(heard.byte, 0 | STX | NAK)
        {
            self.undoubled = self.undoubled.saturating_add(1);
        }
    }
}
