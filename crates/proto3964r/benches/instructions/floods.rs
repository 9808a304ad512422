//! What else a line can bring: data that are not random, and noise.
#![expect(clippy::unwrap_used, reason = "a bench fails loudly")]

use core::time::Duration;

use super::work::{Bench, LEN};

/// Nothing but `bytes`, again and again.
pub(crate) fn full_of(bytes: &[u8]) -> Vec<u8> {
    bytes.iter().copied().cycle().take(LEN).collect()
}

/// Characters in place of what the procedure expects.
pub(crate) struct Flood {
    pub(crate) name: &'static str,
    /// What brings the station there.
    before: fn(&mut Bench),
    pub(crate) characters: &'static [u8],
}

pub(crate) const FLOODS: [Flood; 9] = [
    Flood {
        name: "noise in idle",
        before: |_| {},
        characters: &[0x41],
    },
    Flood {
        name: "NAK in idle",
        before: |_| {},
        characters: &[0x15],
    },
    Flood {
        name: "noise for an answer",
        before: Bench::request,
        characters: &[0x41],
    },
    Flood {
        name: "NAK for an answer",
        before: Bench::request,
        characters: &[0x15],
    },
    Flood {
        name: "noise into the block",
        before: |bench| bench.begin(b"A"),
        characters: &[0x41],
    },
    Flood {
        name: "noise before a repeat",
        before: |bench| {
            bench.receive_slice(&[0x02, 0x10, 0x03, 0x00]);
        },
        characters: &[0x41],
    },
    Flood {
        name: "STX before DLE",
        before: |bench| bench.hear_slice(&[0x02]),
        characters: &[0x02],
    },
    Flood {
        name: "a block too long",
        before: |bench| {
            bench.receive_slice(&[0x02]);
            bench.hear_slice(&[0x41; LEN]);
        },
        characters: &[0x41],
    },
    Flood {
        name: "illegal DLE",
        before: |bench| {
            bench.receive_slice(&[0x02]);
        },
        characters: &[0x10, 0x41],
    },
];

impl Flood {
    /// A station that it meets.
    pub(crate) fn bench(&self) -> Bench {
        let mut bench = Bench::new();
        (self.before)(&mut bench);
        bench
    }
}

impl Bench {
    /// STX is out, and could have been answered.
    fn request(&mut self) {
        self.station.submit(self.now, b"A").unwrap();
        assert_eq!(self.station.poll_transmit_byte(self.now), Some(0x02));
        self.now += Duration::from_millis(3);
    }

    /// The flood meets the station, in one piece or byte by byte.
    pub(crate) fn meet(&self, characters: &[u8], in_one_piece: bool) -> Self {
        let mut bench = self.clone();
        if in_one_piece {
            bench.hear_slice(characters);
        } else {
            bench.hear_bytes(characters);
        }
        bench
    }
}
