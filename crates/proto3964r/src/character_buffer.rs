//! Characters between a port and its station.

use core::time::Duration;

use crate::station::Station;

/// Characters in a buffer, first in, first out.
#[derive(Debug)]
pub(crate) struct CharacterBuffer<const LEN: usize> {
    bytes: [u8; LEN],
    begin: usize,
    end: usize,
}

impl<const LEN: usize> CharacterBuffer<LEN> {
    pub(crate) const EMPTY: Self = Self {
        bytes: [0; LEN],
        begin: 0,
        end: 0,
    };

    /// As many of the characters as the buffer holds.
    #[cfg(feature = "embedded-io-async")]
    pub(crate) fn of(characters: &[u8]) -> Self {
        let mut buffer = Self::EMPTY;
        for (to, &from) in buffer.bytes.iter_mut().zip(characters) {
            *to = from;
        }
        buffer.filled(characters.len());
        buffer
    }

    /// The characters that wait.
    pub(crate) fn waiting(&self) -> &[u8] {
        self.bytes.get(self.begin..self.end).unwrap_or_default()
    }

    /// The buffer for the next characters; those that wait are lost.
    pub(crate) fn room(&mut self) -> &mut [u8] {
        (self.begin, self.end) = (0, 0);
        &mut self.bytes
    }

    /// `count` characters are in the buffer.
    pub(crate) fn filled(&mut self, count: usize) {
        self.end = count.min(LEN);
    }

    /// The first `count` of those that wait are done.
    pub(crate) fn gone(&mut self, count: usize) {
        self.begin += count;
    }

    /// Hands the station what waits, up to the end of the next telegram; nothing while one has not
    /// been polled.
    pub(crate) fn hand_to<const N: usize, const T: usize>(
        &mut self,
        station: &mut Station<N, T>,
        now: Duration,
    ) {
        if !station.holds_telegram() {
            let taken = station.handle_bytes(now, self.waiting());
            self.gone(taken);
        }
    }
}
