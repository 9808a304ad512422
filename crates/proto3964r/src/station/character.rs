//! A character comes in: what the manual wants of it in each state.

use core::time::Duration;

use super::{Station, state::State};
use crate::{
    ascii::{DLE, NAK, STX},
    config::{Config, Line},
    event::{Abandoned, Cause, CharacterError},
    frame::encoded_len,
};

/// A character as the procedure sees it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Symbol {
    Stx,
    Dle,
    Nak,
    /// Anything else, or damaged.
    Other,
}

impl Symbol {
    const fn of(byte: u8, damage: Option<CharacterError>) -> Self {
        match (byte, damage) {
            (STX, None) => Self::Stx,
            (DLE, None) => Self::Dle,
            (NAK, None) => Self::Nak,
            _ => Self::Other,
        }
    }
}

impl<const N: usize, const T: usize> Station<N, T> {
    /// One character, in any state.
    pub(super) fn character(&mut self, now: Duration, byte: u8, damage: Option<CharacterError>) {
        use Symbol::{Dle, Nak, Other, Stx};
        let symbol = Symbol::of(byte, damage);
        match (&self.state, symbol) {
            (State::Receiving { .. } | State::Spoiled { .. }, _) => {
                self.block_character(now, byte, damage);
            }
            // A block whose end came too soon goes on, since the partner cannot have heard our NAK:
            // an STX in its data is none.
            (State::AwaitRepeat { goes_on: true, .. }, Stx) if !self.may_be_answer(now) => {}
            // The partner wants to send: DLE, or a wait for the receive buffer.
            (State::Idle | State::AwaitRepeat { .. } | State::Settling { .. }, Stx) => {
                self.asked_to_receive(now);
            }
            // NAK in idle is never answered: two stations would go on for ever.
            (State::Idle, Nak) => {}
            (State::Idle, _) => self.noise(now, byte),
            // Noise or NAK is waited out: the silence begins again.
            (State::Noise { .. } | State::Interrupted { .. } | State::Settling { .. }, _) => {
                self.await_silence(now);
            }
            // The answer is held. STX: the partner has waited for it long enough. NAK is its last
            // word. Nothing else has a meaning before the answer.
            (State::Held { .. }, Stx) => self.asked_again(now),
            (State::Held { .. }, Nak) => self.abandon(now, Abandoned::ByPartner),
            (State::Held { .. }, Dle | Other) => {}
            // NAK has been sent for the block before. NAK is the partner's last word, STX must not
            // be missed because of noise before it.
            (State::AwaitRepeat { .. }, Nak) => self.abandon(now, Abandoned::ByPartner),
            (State::AwaitRepeat { .. }, Dle | Other) => self.goes_on(),
            // Another STX does not prolong the wait for a buffer, NAK ends it.
            (State::AwaitBuffer { .. }, Stx) => {}
            (State::AwaitBuffer { .. }, Nak) => self.go_idle(now),
            (State::AwaitBuffer { .. }, _) => self.noise(now, byte),
            // The partner cannot have seen our DLE: it asks again, or its NAK crosses our DLE.
            // Anything else is the block, of a partner that does not wait for DLE.
            (State::Invited { .. }, Stx | Nak) if !self.may_be_answer(now) => {}
            (State::Invited { .. }, _) => {
                self.begin_block(now);
                self.block_character(now, byte, damage);
            }
            // STX is not on the line: nothing answers it, and a partner that asks is served first.
            // But the STX of the attempt before may still be answered, and after a wrong answer
            // just now be in conflict.
            (State::Request { .. }, Dle) if self.job.connection_attempts > 1 => {
                self.send_block(now);
            }
            (State::Request { burst, .. }, Stx)
                if now < burst.until && self.job.connection_attempts > 1 =>
            {
                self.conflict(now);
            }
            (State::Request { .. }, Stx) => self.give_way(now),
            (State::Request { .. }, _) => self.extend_burst(now, symbol == Nak),
            // The answer to STX: DLE, or STX in an initialization conflict. Anything else is a
            // wrong one: STX again. What comes too soon is none, and a burst is one wrong answer.
            (State::AwaitDle { .. }, Stx) => self.conflict(now),
            (State::AwaitDle { .. }, Dle) if self.may_be_answer(now) => self.connected(now),
            (State::AwaitDle { .. }, Dle) => self.answered_too_soon(now),
            (State::AwaitDle { burst, .. }, _) if burst.has(now, symbol == Nak) => {
                self.extend_burst(now, symbol == Nak);
            }
            (State::AwaitDle { .. }, _) => self.wrong_answer_to_stx(now, wrong(byte, damage)),
            // The block goes out: NAK breaks it off, anything else too, until the line is silent
            // (0704h, 0706h).
            (State::Sending { .. }, Nak) => self.broken_off(now),
            (State::Sending { .. }, Dle) => self.interrupted(now, self.dle_too_soon()),
            (State::Sending { .. }, _) => self.interrupted(now, wrong(byte, damage)),
            // The answer to the block: DLE is the acknowledgement, unless it comes before the
            // block can have ended. NAK and anything else: all again from STX.
            (State::AwaitAck { .. }, Dle) if self.may_be_acknowledgement(now) => self.sent(now),
            (State::AwaitAck { .. }, Nak) => self.broken_off(now),
            (State::AwaitAck { .. }, Dle) => self.interrupted(now, self.dle_too_soon()),
            (State::AwaitAck { .. }, Other | Stx) => {
                self.wrong_answer_to_block(now, wrong(byte, damage));
            }
        }
    }

    /// What DLE before the end of the block says of the line, if that has a rate.
    fn dle_too_soon(&self) -> Cause {
        match self.config.line {
            Line::Instant => Cause::Unexpected(DLE),
            Line::Paced { .. } | Line::Buffered { .. } => Cause::TooSoon,
        }
    }

    /// Whether a character can be the answer to what was handed out last.
    ///
    /// STX and the answer take a character each. A UART reports a character half a bit before its
    /// end, on both sides, and clocks differ: 1.86 characters after STX was handed out are the
    /// least, 1.5 pass here.
    pub(super) fn may_be_answer(&self, now: Duration) -> bool {
        let half_character = self.config.line.characters(1) / 2;
        self.replies.is_empty() && now >= self.end_of_output().saturating_add(half_character)
    }

    /// Whether DLE can be the answer to the end of the block: likewise, with 1/32 of the
    /// block for clocks that differ.
    fn may_be_acknowledgement(&self, now: Duration) -> bool {
        let Config { line, check, .. } = self.config;
        let earliest = self.end_of_output().saturating_add(line.characters(1) / 2);
        now >= earliest || {
            let block = line.characters(encoded_len(self.payload(), check));
            now.saturating_add(block / 32) >= earliest
        }
    }
}

/// What is wrong with a character in place of an answer.
fn wrong(byte: u8, damage: Option<CharacterError>) -> Cause {
    match (byte, damage) {
        (NAK, None) => Cause::Nak,
        (byte, None) => Cause::Unexpected(byte),
        (_, Some(error)) => Cause::Line(error),
    }
}
