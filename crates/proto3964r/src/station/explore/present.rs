//! What of a station counts for what can still happen: its times, less what has no effect any more.

use super::*;

impl State {
    /// All times in the state.
    pub(super) fn times_mut(&mut self) -> Vec<&mut Duration> {
        match self {
            Self::Idle => vec![],
            Self::Sending { begun_at, .. } => vec![begun_at],
            Self::AwaitBuffer { refuse_at } | Self::Held { refuse_at } => vec![refuse_at],
            Self::Invited { gap_at } | Self::Receiving { gap_at, .. } => vec![gap_at],
            Self::AwaitRepeat { give_up_at, .. } => vec![give_up_at],
            Self::AwaitAck { answer_at } => vec![answer_at],
            Self::Noise {
                silent_at,
                noise_end_at,
                ..
            }
            | Self::Interrupted {
                silent_at,
                noise_end_at,
            }
            | Self::Settling {
                silent_at,
                noise_end_at,
            } => vec![silent_at, noise_end_at],
            Self::Spoiled {
                gap_at,
                noise_end_at,
                ..
            } => vec![gap_at, noise_end_at],
            Self::Request { stalled_at, burst } => vec![stalled_at, &mut burst.until],
            Self::AwaitDle {
                answer_at, burst, ..
            } => vec![answer_at, &mut burst.until],
        }
    }
}

impl Small {
    /// Whether [`poll_event`](Self::poll_event) has something.
    pub(super) fn has_event(&self) -> bool {
        self.clone().take_note().is_some()
    }

    /// Length of the telegram that has not been polled, 0 without one.
    pub(super) fn waiting_telegram(&self) -> usize {
        let mut copy = self.clone();
        core::iter::from_fn(|| copy.take_note())
            .find_map(|note| match note {
                Note::Received { len } => Some(usize::from(len)),
                _ => None,
            })
            .unwrap_or(0)
    }

    /// Clears what can no longer have any effect.
    pub(super) fn forget(&mut self) {
        let used = match &self.state {
            State::Receiving { block, .. } | State::Spoiled { block, .. } => block.stored(),
            _ => self.waiting_telegram(),
        };
        for byte in self.rx.iter_mut().skip(used) {
            *byte = 0;
        }
        if let State::Noise { first, .. } = &mut self.state {
            *first = 0;
        }
        self.discard = false; // a line that takes one character at a time has nothing to discard
        let long_ago = NOW - 4 * HALF_CHARACTER;
        self.leaving_at = self.leaving_at.filter(|&at| at > long_ago);
        for at in self.state.times_mut() {
            if *at < long_ago {
                *at = Duration::ZERO;
            }
        }
        if let State::Request { burst, .. } | State::AwaitDle { burst, .. } = &mut self.state
            && burst.until <= NOW
        {
            *burst = Burst::NONE;
        }
        if !self.is_busy() {
            self.job = Job::NONE;
            (self.tx_len, self.tx) = (0, [0]);
        }
    }
}
