//! One block on the wire, of any length: its payload byte by byte, its end, and what its BCC says
//! of the sender's formula.

use proto3964r::{
    ascii::DLE,
    frame::{Check, Decoder, FrameError},
};

/// A block as far as it was heard.
#[derive(Clone, Debug)]
pub(crate) struct Scan {
    decoder: Decoder,
    characters: u32,
    /// Payload bytes so far.
    len: u32,
    /// The payload byte that the last character completed.
    data: Option<u8>,
    /// Payload bytes before the first fault.
    fault_offset: Option<u32>,
    has_odd_dle: bool,
    bcc: Option<BccSeen>,
}

/// What the BCC of a block says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BccSeen {
    /// XOR of the one received and the one computed.
    pub(crate) difference: u8,
    /// Whether the payload holds an odd number of 10h.
    pub(crate) has_odd_dle: bool,
}

impl Scan {
    /// Before the first character.
    pub(crate) const fn new(check: Check) -> Self {
        Self {
            decoder: Decoder::new(check),
            characters: 0,
            len: 0,
            data: None,
            fault_offset: None,
            has_odd_dle: false,
            bcc: None,
        }
    }

    /// Takes a character; `Some` when it ended the block.
    pub(crate) fn push(&mut self, byte: u8) -> Option<Result<(), FrameError>> {
        self.characters = self.characters.saturating_add(1);
        if self.decoder.awaits_bcc() && self.fault_offset.is_none() {
            self.bcc = Some(BccSeen {
                difference: byte ^ self.decoder.bcc(),
                has_odd_dle: self.has_odd_dle,
            });
        }
        let mut slot = [0];
        let end = self.decoder.push(byte, &mut slot);
        self.data = None;
        if self.decoder.take_payload() > 0 {
            let [byte] = slot;
            self.data = Some(byte);
            self.len = self.len.saturating_add(1);
            self.has_odd_dle ^= byte == DLE;
        } else if self.decoder.fault().is_some() {
            self.fault_offset.get_or_insert(self.len);
        }
        end.map(|end| end.map(|_| ()).map_err(|error| self.placed(error)))
    }

    /// The error with the place in the whole payload, at most 65535.
    fn placed(&self, error: FrameError) -> FrameError {
        match (error, self.fault_offset) {
            (FrameError::IllegalDle { byte, .. }, Some(offset)) => FrameError::IllegalDle {
                byte,
                offset: u16::try_from(offset).map_or(u16::MAX, |offset| offset),
            },
            _ => error,
        }
    }

    /// Whether no character has come.
    pub(crate) const fn is_empty(&self) -> bool {
        self.characters == 0
    }

    /// Whether a single DLE is all that came.
    pub(crate) fn is_lone_dle(&self) -> bool {
        self.characters == 1 && self.decoder.bcc() == DLE
    }

    /// Whether nothing but the BCC is missing.
    pub(crate) fn awaits_bcc(&self) -> bool {
        self.decoder.awaits_bcc()
    }

    /// The BCC that would be right now.
    pub(crate) const fn expected_bcc(&self) -> u8 {
        self.decoder.bcc()
    }

    /// Payload bytes so far.
    pub(crate) const fn len(&self) -> u32 {
        self.len
    }

    /// The payload byte that the last character completed.
    pub(crate) const fn data(&self) -> Option<u8> {
        self.data
    }

    /// The BCC of the block, if it had one and the characters before it were in order.
    pub(crate) const fn bcc(&self) -> Option<BccSeen> {
        self.bcc
    }
}
