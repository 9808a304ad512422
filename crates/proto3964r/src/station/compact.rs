//! The station's small stores, in as few bytes as they take.

use crate::{
    ascii::{DLE, NAK},
    event::{Abandoned, Phase, Rejection},
};

/// A fact that no state carries.
#[derive(Clone, Copy)]
pub(super) struct Flag(u8);

impl Flag {
    /// STX is queued behind the replies.
    pub(super) const STX: Self = Self(1);
    /// What was handed out and is not on the line yet must not go there.
    pub(super) const DISCARD: Self = Self(1 << 1);
    /// The receive buffer holds a telegram that has not been polled.
    pub(super) const RX_FULL: Self = Self(1 << 2);
    /// The job gave way to the partner, and no telegram has come of it yet.
    pub(super) const YIELDED: Self = Self(1 << 3);
    /// A collision was seen in this setup attempt.
    pub(super) const COLLIDED: Self = Self(1 << 4);
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Flags(u8);

impl Flags {
    #[inline]
    pub(super) const fn has(self, flag: Flag) -> bool {
        self.0 & flag.0 != 0
    }

    pub(super) fn set(&mut self, flag: Flag) {
        self.0 |= flag.0;
    }

    #[inline]
    pub(super) fn clear(&mut self, flag: Flag) {
        self.0 &= !flag.0;
    }

    /// Clears the flag and tells whether it was set.
    #[inline]
    pub(super) fn take(&mut self, flag: Flag) -> bool {
        let had = self.has(flag);
        self.clear(flag);
        had
    }
}

/// What the partner is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reply {
    Dle,
    Nak,
}

impl Reply {
    pub(super) const fn character(self) -> u8 {
        match self {
            Self::Dle => DLE,
            Self::Nak => NAK,
        }
    }
}

/// Replies that the line has not taken yet, oldest first: one bit each behind a leading 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Replies(u8);

impl Replies {
    pub(super) const EMPTY: Self = Self(1);
    const FULL: u8 = 1 << 7;

    #[inline]
    pub(super) fn is_empty(self) -> bool {
        self == Self::EMPTY
    }

    /// Appends a reply; an eighth one displaces the oldest, for which nobody waits any more.
    pub(super) fn push(&mut self, reply: Reply) {
        if self.0 >= Self::FULL {
            self.pop();
        }
        self.0 = self.0 << 1 | u8::from(reply == Reply::Nak);
    }

    pub(super) fn pop(&mut self) -> Option<Reply> {
        if self.is_empty() {
            return None;
        }
        let leading = Self::FULL >> self.0.leading_zeros();
        let oldest = leading >> 1;
        let reply = if self.0 & oldest == 0 {
            Reply::Dle
        } else {
            Reply::Nak
        };
        self.0 = self.0 & !leading | oldest;
        Some(reply)
    }
}

/// An [`Event`](crate::Event) without what the station itself still knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Note {
    Received,
    Sent,
    Failed(Phase),
    Rejected(Rejection),
    Abandoned(Abandoned),
    Collision(u8),
    SamePriority,
    Break,
}

const SLOTS: usize = 5;
/// There is never more than one telegram and one outcome: two slots are kept for them.
const FOR_DIAGNOSIS: usize = SLOTS - 2;

/// Events that wait to be polled, oldest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Notes([Option<Note>; SLOTS]);

impl Notes {
    /// Appends a note if one of the first `slots` slots is free.
    fn push(&mut self, note: Note, slots: usize) -> bool {
        let free = self.0.iter_mut().take(slots).find(|slot| slot.is_none());
        free.is_some_and(|slot| {
            *slot = Some(note);
            true
        })
    }

    /// Appends a telegram or an outcome, for which there is always room.
    pub(super) fn result(&mut self, note: Note) {
        self.push(note, SLOTS);
    }

    /// Appends anything else; `false` without room.
    pub(super) fn diagnosis(&mut self, note: Note) -> bool {
        self.push(note, FOR_DIAGNOSIS)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.first().is_none_or(Option::is_none)
    }

    pub(super) fn pop(&mut self) -> Option<Note> {
        self.0.rotate_left(1);
        self.0.last_mut()?.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replies_come_out_in_order() {
        let mut replies = Replies::EMPTY;
        for reply in [
            Reply::Nak,
            Reply::Dle,
            Reply::Nak,
            Reply::Dle,
            Reply::Dle,
            Reply::Nak,
            Reply::Nak,
        ] {
            replies.push(reply);
        }
        replies.push(Reply::Dle);
        for reply in [
            Reply::Dle,
            Reply::Nak,
            Reply::Dle,
            Reply::Dle,
            Reply::Nak,
            Reply::Nak,
            Reply::Dle,
        ] {
            assert_eq!(replies.pop(), Some(reply));
        }
        assert_eq!(replies.pop(), None);
    }

    #[test]
    fn results_have_room_behind_any_diagnosis() {
        let mut notes = Notes::default();
        assert_eq!(
            [0, 1, 2, 3].map(|n| notes.diagnosis(Note::Collision(n))),
            [true, true, true, false]
        );
        notes.result(Note::Received);
        notes.result(Note::Sent);
        assert_eq!(notes.pop(), Some(Note::Collision(0)));
        let rest = core::iter::from_fn(|| notes.pop());
        assert!(rest.eq([
            Note::Collision(1),
            Note::Collision(2),
            Note::Received,
            Note::Sent
        ]));
    }
}
