//! Time passes: the deadline of each state and what the manual wants when it has come.

use core::time::Duration;

use super::{
    Station,
    queue::Reply,
    state::{Burst, State},
};
use crate::event::{Abandoned, Cause, Rejection};

impl<const N: usize, const T: usize> Station<N, T> {
    /// When [`handle_timeout`](Self::handle_timeout) must be called; a time in the past means at
    /// once, `None` means that only a push can change anything.
    ///
    /// Changes after every push, after [`poll_transmit`](Self::poll_transmit), and after
    /// [`Event::Received`](crate::Event::Received) was polled.
    #[must_use]
    #[inline]
    pub fn poll_timeout(&self) -> Option<Duration> {
        Some(match self.state {
            State::Idle => return None,
            State::AwaitBuffer { .. } if !self.holds_telegram => Duration::ZERO,
            State::AwaitBuffer { refuse_at } | State::Held { refuse_at } => refuse_at,
            State::Noise {
                silent_at,
                noise_end_at,
                ..
            }
            | State::Interrupted {
                silent_at,
                noise_end_at,
            }
            | State::Settling {
                silent_at,
                noise_end_at,
            } => silent_at.min(noise_end_at),
            State::Invited { gap_at } | State::Receiving { gap_at, .. } => gap_at,
            State::Spoiled {
                gap_at,
                noise_end_at,
                ..
            } => gap_at.min(noise_end_at),
            State::AwaitRepeat { give_up_at, .. } => give_up_at,
            State::Request { stalled_at, .. } => stalled_at,
            State::AwaitDle { answer_at, .. } | State::AwaitAck { answer_at } => answer_at,
            State::Sending { begun_at, .. } => {
                let end = self.end_of_output().max(begun_at);
                end.saturating_add(self.config.qvz())
            }
        })
    }

    /// Does what is due at `now`; nothing when nothing is.
    #[inline]
    pub fn handle_timeout(&mut self, now: Duration) {
        if self.poll_timeout().is_some_and(|due| due <= now) {
            self.deadline_came(now);
        }
    }

    #[cold]
    fn deadline_came(&mut self, now: Duration) {
        // A deadline past the end of time never comes.
        if self.poll_timeout() == Some(Duration::MAX) {
            return;
        }
        match self.state {
            State::Idle => {}
            // A buffer became free in time: DLE.
            State::AwaitBuffer { .. } if !self.holds_telegram => self.invite(now),
            // None did: NAK (080Ah).
            State::AwaitBuffer { .. } => self.turn_away(now, Rejection::NoBuffer),
            // Silence after noise, or no end of it: NAK (0802h).
            State::Noise { first, .. } => self.turn_away(now, Rejection::Noise { first }),
            // ZVZ ran out before or in a block: NAK (0806h).
            State::Invited { .. } | State::Receiving { .. } => self.gap_in_block(now),
            State::Spoiled { gap_at, .. } if gap_at <= now => self.gap_in_block(now),
            // A bad block does not end.
            State::Spoiled { .. } => self.reject(now, Rejection::Endless),
            // The user has not accepted the block in time: NAK.
            State::Held { .. } => self.reject(now, Rejection::Undecided),
            // BWZ ran out.
            State::AwaitRepeat { .. } => self.abandon(now, Abandoned::NoRepeat),
            // The line does not take STX.
            State::Request { .. } => self.next_connection(now, Cause::Stalled, Burst::NONE),
            // QVZ ran out: STX again (0703h).
            State::AwaitDle { .. } => self.next_connection(now, Cause::Timeout, Burst::NONE),
            // The line does not take the block.
            State::Sending { .. } => self.repeat_block(now, Cause::Stalled, Burst::NONE),
            // The line is silent, or never will be: NAK, and all again from STX. In the last
            // attempt the end of the job sends that NAK.
            State::Interrupted { .. } => {
                if self.job.transmission_attempts < self.config.transmission_attempts {
                    self.replies.push(Reply::Nak);
                }
                self.next_transmission(now, Cause::Timeout, Burst::NONE);
            }
            // Nobody answers the job that was given up any more.
            State::Settling { .. } => self.go_idle(now),
            // QVZ ran out: all again from STX (0705h).
            State::AwaitAck { .. } => self.repeat_block(now, Cause::Timeout, Burst::NONE),
        }
    }
}
