//! What waits to be fetched: replies by the line, events by the user.

use crate::{
    ascii::{DLE, NAK},
    event::{Abandoned, Failure, Rejection},
};

/// First in, first out.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Queue<T, const SLOTS: usize>([Option<T>; SLOTS]);

impl<T: Copy, const SLOTS: usize> Queue<T, SLOTS> {
    const EMPTY: Self = Self([None; SLOTS]);

    /// Appends an item if one of the first `slots` slots is free.
    fn push(&mut self, item: T, slots: usize) -> bool {
        let free = self.0.iter_mut().take(slots).find(|slot| slot.is_none());
        free.is_some_and(|slot| {
            *slot = Some(item);
            true
        })
    }

    fn pop(&mut self) -> Option<T> {
        if self.is_empty() {
            return None;
        }
        self.0.rotate_left(1);
        self.0.last_mut()?.take()
    }

    fn is_empty(&self) -> bool {
        self.0.first().is_none_or(Option::is_none)
    }
}

/// What goes to the partner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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

const REPLIES: usize = 4;

/// Replies that the line has not taken yet, oldest first.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Replies(Queue<Reply, REPLIES>);

impl Replies {
    pub(super) const EMPTY: Self = Self(Queue::EMPTY);

    /// Appends a reply; one too many displaces the oldest, for which nobody waits any more.
    pub(super) fn push(&mut self, reply: Reply) {
        if !self.0.push(reply, REPLIES) {
            self.0.pop();
            self.0.push(reply, REPLIES);
        }
    }

    pub(super) fn pop(&mut self) -> Option<Reply> {
        self.0.pop()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// An [`Event`](crate::Event) without what the station itself still knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Note {
    Received { len: u16 },
    Sent,
    Failed(Failure),
    Rejected(Rejection),
    Abandoned(Abandoned),
    Conflict(u8),
    SamePriority,
    Break,
}

const NOTES: usize = 5;
/// There is never more than one telegram and one outcome: two slots are kept for them.
const FOR_DIAGNOSIS: usize = NOTES - 2;

/// Events that wait to be polled, oldest first.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Notes(Queue<Note, NOTES>);

impl Notes {
    pub(super) const EMPTY: Self = Self(Queue::EMPTY);

    /// Appends a telegram or an outcome, for which there is always room.
    pub(super) fn result(&mut self, note: Note) {
        self.0.push(note, NOTES);
    }

    /// Appends anything else, unless nobody has polled for long.
    pub(super) fn diagnosis(&mut self, note: Note) {
        self.0.push(note, FOR_DIAGNOSIS);
    }

    pub(super) fn pop(&mut self) -> Option<Note> {
        self.0.pop()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replies_come_out_in_order_and_the_oldest_goes_first() {
        use Reply::{Dle, Nak};
        let mut replies = Replies::EMPTY;
        for reply in [Nak, Dle, Nak, Dle, Dle] {
            replies.push(reply);
        }
        for reply in [Dle, Nak, Dle, Dle] {
            assert_eq!(replies.pop(), Some(reply));
        }
        assert!(replies.is_empty());
        assert_eq!(replies.pop(), None);
    }

    #[test]
    fn results_have_room_after_any_diagnosis() {
        let mut notes = Notes::EMPTY;
        for count in 0..4 {
            notes.diagnosis(Note::Conflict(count));
        }
        notes.result(Note::Received { len: 1 });
        notes.result(Note::Sent);
        assert_eq!(notes.pop(), Some(Note::Conflict(0)));
        let rest = core::iter::from_fn(|| notes.pop());
        assert!(rest.eq([
            Note::Conflict(1),
            Note::Conflict(2),
            Note::Received { len: 1 },
            Note::Sent
        ]));
    }
}
