//! What is under way to the broker.

use alloc::collections::VecDeque;

use crate::gateway::{outbox::Outbox, store::Message};

/// What tells a message from others: by identifier, and by topic what is retained.
pub(super) type Name = (u64, String);

/// Messages without an acknowledgement, in the order in which they were handed over.
#[derive(Default)]
pub(super) struct Window(VecDeque<UnderWay>);

struct UnderWay {
    /// The packet identifier, when the message has left.
    id: Option<u16>,
    message: Message,
}

impl Window {
    /// Messages at once.
    pub(super) const SIZE: u16 = 100;

    pub(super) fn has_room(&self) -> bool {
        self.0.len() < usize::from(Self::SIZE)
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn push(&mut self, message: Message) {
        self.0.push_back(UnderWay { id: None, message });
    }

    /// The first without an identifier has left under this one.
    pub(super) fn numbered(&mut self, id: u16) {
        if let Some(message) = self.0.iter_mut().find(|message| message.id.is_none()) {
            message.id = Some(id);
        }
    }

    pub(super) fn acknowledged(&mut self, id: u16) -> Option<Message> {
        let index = self.0.iter().position(|message| message.id == Some(id))?;
        self.0
            .remove(index)
            .map(|acknowledged| acknowledged.message)
    }

    /// The first message.
    pub(super) fn first(&self) -> Option<&Message> {
        self.0.front().map(|first| &first.message)
    }

    /// What tells the first message from others.
    pub(super) fn first_name(&self) -> Option<Name> {
        self.first()
            .map(|message| (message.id, message.topic.clone()))
    }

    pub(super) fn take_first(&mut self) -> Option<Message> {
        self.0.pop_front().map(|first| first.message)
    }

    /// The connection is lost: back into the queue.
    pub(super) fn restore(self, outbox: &Outbox) {
        outbox.restore(self.0.into_iter().map(|message| message.message));
    }
}
