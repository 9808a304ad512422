//! The line takes characters: replies first, then STX, then the block.

use core::time::Duration;

use super::{Station, Transmit, head, queue::Reply, state::State};
use crate::ascii::STX;

impl<const N: usize, const T: usize> Station<N, T> {
    /// Hands out characters for the line, as many as `out` takes; `None` when there are none.
    ///
    /// The answer timer runs from the last character of the block, so hand on to the line what
    /// you get; [`Config::line`](crate::Config::line) says how long it takes there. When
    /// [`Transmit::Discard`] comes, drop what the line has not taken yet.
    #[must_use]
    pub fn poll_transmit<'o>(&mut self, now: Duration, out: &'o mut [u8]) -> Option<Transmit<'o>> {
        if self.take_discard(now) {
            return Some(Transmit::Discard);
        }
        let mut len = 0;
        while let Some(slot) = out.get_mut(len)
            && let Some(byte) = self.next_control(now)
        {
            *slot = byte;
            len += 1;
        }
        if let Some(free) = out.get_mut(len..) {
            len += self.fill(now, free);
        }
        out.get(..len)
            .filter(|bytes| !bytes.is_empty())
            .map(Transmit::Bytes)
    }

    /// Hands out the next character, for a line that takes one at a time: when it asks for one, the
    /// one before has left.
    ///
    /// There is nothing to discard then: what the line has taken is on the line.
    #[must_use]
    #[inline]
    pub fn poll_transmit_byte(&mut self, now: Duration) -> Option<u8> {
        // What nearly all characters are, first: one more byte of the payload.
        if let State::Sending { block, .. } = &mut self.state
            && self.replies.is_empty()
            && !self.discard
            && let Some(payload) = self.tx.get(..usize::from(self.tx_len))
            && let Some(byte) = block.next_data(payload)
        {
            self.leaving_at = Some(now); // the one before has left, or the line would not ask
            Some(byte)
        } else {
            self.next_other_byte(now)
        }
    }

    #[inline(never)]
    fn next_other_byte(&mut self, now: Duration) -> Option<u8> {
        self.take_discard(now);
        self.next_control(now).or_else(|| {
            let mut out = [0];
            let written = self.fill(now, &mut out);
            let [byte] = out;
            (written > 0).then_some(byte)
        })
    }

    fn take_discard(&mut self, now: Duration) -> bool {
        let discard = core::mem::take(&mut self.discard);
        if discard {
            // One character at most is leaving.
            self.leaving_at = self.leaving_at.map(|at| at.min(now));
        }
        discard
    }

    /// The next reply, or STX after the replies. The timer of the state starts again.
    fn next_control(&mut self, now: Duration) -> Option<u8> {
        let reply = self.replies.pop();
        if reply.is_none() && !matches!(self.state, State::Request { .. }) {
            return None;
        }
        self.handed_out(now, 1);
        let end = self.end_of_output();
        match (&mut self.state, reply) {
            // QVZ runs from STX.
            (&mut State::Request { burst, .. }, None) => {
                self.state = State::AwaitDle {
                    answer_at: end.saturating_add(self.config.qvz()),
                    burst,
                    in_conflict: false,
                };
            }
            // ZVZ runs from the DLE that invites the block.
            (
                State::Invited { gap_at }
                | State::Receiving { gap_at, .. }
                | State::Spoiled { gap_at, .. },
                Some(Reply::Dle),
            ) => {
                *gap_at = end.saturating_add(self.zvz);
            }
            // BWZ runs from NAK.
            (State::AwaitRepeat { give_up_at, .. }, _) => {
                *give_up_at = end.saturating_add(self.config.bwz());
            }
            _ => {}
        }
        Some(reply.map_or(STX, Reply::character))
    }

    /// Writes the next part of the block, if one goes out, and returns its length.
    #[inline]
    fn fill(&mut self, now: Duration, out: &mut [u8]) -> usize {
        let State::Sending { block, .. } = &mut self.state else {
            return 0;
        };
        let payload = head(&self.tx, self.tx_len);
        let written = block.fill(self.config.check, payload, out);
        let done = block.is_done();
        if written > 0 {
            self.handed_out(now, written);
        }
        if done {
            // QVZ runs from the end of the block.
            let answer_at = self.end_of_output().saturating_add(self.config.qvz());
            self.state = State::AwaitAck { answer_at };
        }
        written
    }

    /// `count` more characters leave, one after the other.
    fn handed_out(&mut self, now: Duration, count: usize) {
        let others = self.config.line.characters(count.saturating_sub(1));
        let first_leaves_at = self.end_of_output().max(now);
        self.leaving_at = Some(first_leaves_at.saturating_add(others));
    }

    /// When everything that was handed out has left, at the earliest; zero when nothing was.
    pub(super) fn end_of_output(&self) -> Duration {
        let character = self.config.line.characters(1);
        self.leaving_at
            .map_or(Duration::ZERO, |at| at.saturating_add(character))
    }

    /// The payload of the job.
    pub(super) fn payload(&self) -> &[u8] {
        head(&self.tx, self.tx_len)
    }
}
