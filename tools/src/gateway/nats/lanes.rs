//! Messages that wait for the answer to the one before them.

use alloc::collections::{BTreeMap, VecDeque};

use super::subject;
use crate::gateway::store::Message;

/// Messages of which none may overtake another: those of a line; what is retained under a topic;
/// the answers to one who asked.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Lane {
    Line(String),
    Retained(String),
    /// A subject of somebody else.
    Other(String),
}

impl Lane {
    /// The lane of a message; `topic` is where all of the gateway begin.
    pub(super) fn of(topic: &str, message: &Message) -> Self {
        let own = message.topic.strip_prefix(topic);
        let Some(rest) = own.and_then(|rest| rest.strip_prefix('/')) else {
            return Self::Other(message.topic.clone());
        };
        if message.is_retained {
            return Self::Retained(message.topic.clone());
        }
        let line = rest.split_once('/').map_or(rest, |(line, _)| line);
        Self::Line(line.to_owned())
    }

    /// Whether its messages are for a stream.
    pub(super) const fn is_ours(&self) -> bool {
        !matches!(self, Self::Other(_))
    }

    /// Where a message of it goes.
    pub(super) fn subject(&self, message: &Message) -> String {
        match self {
            Self::Other(subject) => subject.clone(),
            Self::Line(_) | Self::Retained(_) => subject(&message.topic),
        }
    }

    /// By what a stream knows a message that it has already: run, line and number of a telegram or
    /// an area, as they stand in it, so that one that was stored twice is one; else run and place
    /// in the store.
    pub(super) fn message_id(&self, run: &str, message: &Message) -> Option<String> {
        match (self, message) {
            (Self::Line(line), Message { seq: Some(seq), .. }) => {
                Some(format!("{run}.{line}.{seq}"))
            }
            (Self::Line(_), Message { id: 1.., .. }) => Some(format!("{run}.{}", message.id)),
            _ => None,
        }
    }
}

/// Messages whose lanes are busy, by lane. A lane is there while a message of it is under way.
#[derive(Default)]
pub(super) struct Lanes {
    waiting: BTreeMap<Lane, VecDeque<Message>>,
    /// Messages, those under way included.
    len: usize,
}

impl Lanes {
    /// Messages of all lanes.
    pub(super) const SIZE: usize = 1000;

    pub(super) const fn have_room(&self) -> bool {
        self.len < Self::SIZE
    }

    pub(super) const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Takes a message; gives it back if it may leave at once.
    pub(super) fn push(&mut self, lane: &Lane, message: Message) -> Option<Message> {
        self.len += 1;
        if let Some(waiting) = self.waiting.get_mut(lane) {
            waiting.push_back(message);
            return None;
        }
        self.waiting.insert(lane.clone(), VecDeque::new());
        Some(message)
    }

    /// The message under way has been answered: the next one.
    pub(super) fn answered(&mut self, lane: &Lane) -> Option<Message> {
        self.len = self.len.saturating_sub(1);
        let next = self.waiting.get_mut(lane)?.pop_front();
        if next.is_none() {
            self.waiting.remove(lane);
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(topic: &str, seq: Option<u64>) -> Message {
        Message {
            id: 9,
            seq,
            topic: topic.to_owned(),
            ..Message::default()
        }
    }

    #[test]
    fn one_of_each_line_is_under_way() {
        let mut lanes = Lanes::default();
        let topics = ["p/g/a/telegram/x", "p/g/b/telegram", "p/g/a/outcome"];
        let [first, other, second] = topics.map(|topic| message(topic, None));
        let lane = |message: &Message| Lane::of("p/g", message);
        assert_eq!(
            lanes.push(&lane(&first), first.clone()),
            Some(first.clone())
        );
        assert_eq!(
            lanes.push(&lane(&other), other.clone()),
            Some(other.clone())
        );
        assert_eq!(lanes.push(&lane(&second), second.clone()), None);
        assert_eq!(lanes.answered(&lane(&first)), Some(second.clone()));
        assert_eq!(lanes.answered(&lane(&second)), None);
        assert!(!lanes.is_empty());
        assert_eq!(lanes.answered(&lane(&other)), None);
        assert!(lanes.is_empty());
        assert_eq!(
            lanes.push(&lane(&second), second.clone()),
            Some(second),
            "its lane is free"
        );
    }

    #[test]
    fn what_a_stream_knows_a_message_by() {
        let name = |message: &Message| {
            let lane = Lane::of("p/g", message);
            (lane.subject(message), lane.message_id("r", message))
        };
        for (message, subject, id) in [
            (
                message("p/g/a/telegram/x", Some(7)),
                "p.g.a.telegram.x",
                Some("r.a.7"),
            ),
            (message("p/g/a/outcome", None), "p.g.a.outcome", Some("r.9")),
            (message("_INBOX.1/2", None), "_INBOX.1/2", None),
        ] {
            assert_eq!(name(&message), (subject.to_owned(), id.map(str::to_owned)));
        }
        let status = Message {
            is_retained: true,
            id: 0,
            ..message("p/g/status", None)
        };
        assert_eq!(name(&status), ("p.g.status".to_owned(), None));
        let in_memory = Message {
            id: 0,
            ..message("p/g/a/outcome", None)
        };
        assert_eq!(name(&in_memory).1, None);
    }
}
