//! Whether both inputs of a tap hear the same wire.

use core::time::Duration;

use proto3964r::ascii::{DLE, NAK, STX};

use crate::monitor::{Character, Side, since};

/// Two taps on one wire show a character within this time: the latency of USB adapters.
const TOGETHER: Duration = Duration::from_millis(20);

/// How much of a record is heard on both inputs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Echo {
    characters: usize,
    /// Pairs of the same character, one of each side.
    pairs: usize,
    /// Those of the pairs that are not STX, DLE or NAK.
    data: usize,
}

impl Echo {
    /// Compares the two directions character by character, as long as they come together.
    pub(super) fn of(record: &[Character]) -> Self {
        let of = |side| record.iter().filter(move |heard| heard.side == side);
        let (mut from_a, mut from_b) = (of(Side::A).peekable(), of(Side::B).peekable());
        let mut echo = Self {
            characters: record.len(),
            ..Self::default()
        };
        while let (Some(&a), Some(&b)) = (from_a.peek(), from_b.peek()) {
            let apart = since(a.at, b.at).max(since(b.at, a.at));
            if apart <= TOGETHER && a.byte == b.byte {
                echo.pairs = echo.pairs.saturating_add(1);
                if !matches!(a.byte, STX | DLE | NAK) {
                    echo.data = echo.data.saturating_add(1);
                }
                from_a.next();
                from_b.next();
            } else if a.at <= b.at {
                from_a.next();
            } else {
                from_b.next();
            }
        }
        echo
    }

    /// Whether nine characters of ten are heard twice.
    pub(super) const fn is_everywhere(self) -> bool {
        self.pairs.saturating_mul(20) >= self.characters.saturating_mul(9) && self.pairs > 0
    }

    /// Whether data are heard twice, which two stations of the same priority do not do.
    pub(super) const fn has_data(self) -> bool {
        self.data > 0
    }
}
