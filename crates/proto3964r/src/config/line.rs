//! What lies between the station and the wire.

use core::time::Duration;

/// What becomes of the characters that a station hands out.
///
/// The station has to know it: an answer that comes before the partner can have read the question
/// is none, and what still stands in a buffer goes out, whatever the procedure wants.
///
/// | line | examples | the station's guarantee |
/// |---|---|---|
/// | [`Instant`](Self::Instant) | pseudo-terminal, two stations in one program | what the procedure itself gives: whatever comes instead of an answer is one |
/// | [`Paced`](Self::Paced) | a UART, with or without the driver's buffer | besides: nothing that comes too soon is taken for an answer, and the rest of a block that was broken off does not reach the partner |
/// | [`Buffered`](Self::Buffered) | USB adapter, TCP serial server | besides: nothing that comes too soon is taken for an answer; after a block that was broken off the station waits until its rest has left and the line is silent. The partner may receive that block whole, and then once more |
///
/// "Too soon" is less than one and a half characters after STX was handed out, and for the
/// acknowledgement of a block less than half a character after its end, less 1/32 of the block. So
/// the times given to a station on a paced or buffered line must resolve a third of a
/// character, and the character time must be that of the line within 3 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_enums,
    reason = "it is at once, slowly, or slowly and for good"
)]
pub enum Line {
    /// What is handed out has arrived.
    Instant,
    /// Characters leave one after the other; those that have not left can be discarded.
    Paced {
        /// Time of one character, in nanoseconds.
        character_ns: u32,
    },
    /// Characters leave one after the other, and nothing can be taken back.
    Buffered {
        /// Time of one character, in nanoseconds.
        character_ns: u32,
    },
}

impl Line {
    /// A UART of `baud` bit/s with `bits` bits to a character: 11 for 8E1, 10 for 8N1.
    ///
    /// ```text
    /// character = bits / baud, rounded down; without end for 0 bit/s
    /// ```
    #[must_use]
    pub const fn paced(baud: u32, bits: u8) -> Self {
        let character_ns = character_ns(baud, bits);
        Self::Paced { character_ns }
    }

    /// A USB adapter or a serial server, set to `baud` bit/s and `bits` bits to a character, as
    /// for [`paced`](Self::paced).
    #[must_use]
    pub const fn buffered(baud: u32, bits: u8) -> Self {
        let character_ns = character_ns(baud, bits);
        Self::Buffered { character_ns }
    }

    const fn character_ns(self) -> u32 {
        match self {
            Self::Instant => 0,
            Self::Paced { character_ns } | Self::Buffered { character_ns } => character_ns,
        }
    }

    /// Time of `count` characters.
    pub(crate) fn characters(self, count: usize) -> Duration {
        Duration::from_nanos(u64::from(self.character_ns()).saturating_mul(count as u64))
    }

    /// Whether what was handed out and has not left can still be dropped.
    pub(crate) const fn can_discard(self) -> bool {
        !matches!(self, Self::Buffered { .. })
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the branch before holds what does not fit"
)]
const fn character_ns(baud: u32, bits: u8) -> u32 {
    match (bits as u64 * 1_000_000_000).checked_div(baud as u64) {
        Some(ns) if ns <= u32::MAX as u64 => ns as u32,
        _ => u32::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn character_times() {
        let ns = |baud, bits| Line::paced(baud, bits).character_ns();
        assert_eq!(ns(9600, 11), 1_145_833);
        assert_eq!(ns(115_200, 10), 86_805);
        assert_eq!(ns(0, 10), u32::MAX);
        assert_eq!(ns(1, 10), u32::MAX);
        assert_eq!(Line::Instant.characters(usize::MAX), Duration::ZERO);
        assert_eq!(
            Line::buffered(9600, 11).characters(203),
            Duration::from_nanos(203 * 1_145_833)
        );
    }
}
