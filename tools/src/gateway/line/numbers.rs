//! The numbers of what comes on a line, and what may have come before.

use core::time::Duration;

use tokio::time::Instant;

use crate::gateway::store::Last;

/// The numbers of a line's telegrams.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    /// Of the last telegram or area.
    seq: u64,
    /// The last telegram that was acknowledged.
    last: Option<Acknowledged>,
    /// One that was numbered and not acknowledged: its repeat has the same number.
    pub(super) open: Option<Arrival>,
}

#[derive(Debug)]
struct Acknowledged {
    telegram: Vec<u8>,
    /// `None` before the line was lost: the partner may not have heard of it.
    at: Option<Instant>,
}

/// A telegram and its number.
#[derive(Clone, Debug)]
pub(super) struct Arrival {
    telegram: Vec<u8>,
    pub(super) seq: u64,
    pub(super) possible_repeat: bool,
    pub(super) is_stored: bool,
}

impl Arrival {
    /// What no partner repeats.
    pub(super) const fn new(seq: u64) -> Self {
        Self {
            telegram: Vec::new(),
            seq,
            possible_repeat: false,
            is_stored: false,
        }
    }
}

impl Numbers {
    /// Goes on after the last telegram of the run before.
    pub(super) fn after(last: &Last) -> Self {
        let is_first = last.seq == 0;
        let telegram = last.telegram.clone();
        Self {
            seq: last.seq,
            last: (!is_first).then_some(Acknowledged { telegram, at: None }),
            open: None,
        }
    }

    pub(super) fn next(&mut self) -> u64 {
        self.seq += 1;
        self.seq
    }

    /// The highest so far.
    pub(super) const fn highest(&self) -> u64 {
        self.seq
    }

    /// The last telegram that was acknowledged, or nothing.
    pub(super) fn last_telegram(&self) -> Vec<u8> {
        self.last
            .as_ref()
            .map_or_else(Vec::new, |last| last.telegram.clone())
    }

    /// The number of a telegram: that of the one before, if that is the same and was not
    /// acknowledged. It may be the repeat of an equal one that was acknowledged so long ago at
    /// most, or of which the partner may not know that it was; never without such a time.
    pub(super) fn arrival(&mut self, telegram: &[u8], within: Option<Duration>) -> Arrival {
        if let Some(open) = self.open.take()
            && open.telegram == telegram
        {
            return open;
        }
        let is_repeat = |last: &Acknowledged, within| {
            last.telegram == telegram && last.at.is_none_or(|at| at.elapsed() <= within)
        };
        let last = self.last.as_ref().zip(within);
        Arrival {
            possible_repeat: last.is_some_and(|(last, within)| is_repeat(last, within)),
            telegram: telegram.to_vec(),
            seq: self.next(),
            is_stored: false,
        }
    }

    /// A telegram was acknowledged, at a time when the partner heard of it for sure.
    pub(super) fn acknowledged(&mut self, telegram: Vec<u8>, at: Option<Instant>) {
        self.last = Some(Acknowledged { telegram, at });
    }

    pub(super) const fn line_was_lost(&mut self) {
        if let Some(last) = &mut self.last {
            last.at = None;
        }
    }
}
