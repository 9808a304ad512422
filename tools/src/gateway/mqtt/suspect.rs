//! Which message the broker ends connections with.

use core::mem;

use super::window::{Name, Window};

/// Connections over which the broker answered others, and that ended with the same message
/// unanswered, before that is taken for the reason.
pub(super) const SUSPICIONS: u32 = 5;

/// From here on messages leave one at a time, up to this one: what the broker had answered is lost
/// with some connections, so that the first without an answer need not be the reason.
const CAREFUL: u32 = 2;

/// The first message that was unanswered when the connection ended, and how many times in a row.
/// Some brokers close the connection on what they do not take; in MQTT 3.1.1 there is no other way.
#[derive(Default)]
pub(super) struct Suspect {
    message: Option<Name>,
    times: u32,
    /// Those of them over which the broker answered something else.
    answered: u32,
    is_careful: bool,
}

impl Suspect {
    /// Whether a connection that ended with this window unanswered is one too many for its first
    /// message. `has_answered`: the broker answered something else over it.
    pub(super) fn is_convicted(&mut self, window: &Window, has_answered: bool) -> bool {
        let before = mem::take(self);
        self.message = window.first_name();
        if self.message.is_none() {
            return false;
        }
        if self.message == before.message {
            (self.times, self.answered) = (before.times, before.answered);
        }
        self.times += 1;
        self.answered += u32::from(has_answered);
        self.is_careful = before.is_careful || self.times >= CAREFUL;
        let is_convicted = self.answered >= SUSPICIONS;
        if is_convicted {
            *self = Self::default();
        }
        is_convicted
    }

    /// The message up to which one at a time shall leave.
    pub(super) fn careful_until(&self) -> Option<Name> {
        self.message.clone().filter(|_| self.is_careful)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gateway::store::Message;

    fn window(ids: &[u64]) -> Window {
        let mut window = Window::default();
        for &id in ids {
            window.push(Message {
                id,
                topic: "t".to_owned(),
                ..Message::default()
            });
        }
        window
    }

    #[test]
    fn one_too_many_is_the_fifth_of_the_same() {
        let mut suspect = Suspect::default();
        for times in 1..=5 {
            assert_eq!(suspect.careful_until().is_some(), times > 2);
            assert_eq!(suspect.is_convicted(&window(&[1, 2]), true), times == 5);
        }
        assert!(suspect.careful_until().is_none());
        assert!(!suspect.is_convicted(&window(&[2]), true));
    }

    #[test]
    fn a_broker_that_answers_nothing_convicts_nobody() {
        let mut suspect = Suspect::default();
        for _ in 0..20 {
            assert!(!suspect.is_convicted(&window(&[1]), false));
        }
        assert!(!suspect.is_convicted(&window(&[1]), true));
    }

    /// The answer to an innocent message is lost with each end, unless it leaves alone.
    #[test]
    fn who_is_behind_the_first_is_found() {
        let mut suspect = Suspect::default();
        for _ in 0..2 {
            assert!(!suspect.is_convicted(&window(&[1, 2]), true));
        }
        assert_eq!(suspect.careful_until(), Some((1, "t".to_owned())));
        for times in 1..=5 {
            assert_eq!(suspect.is_convicted(&window(&[2]), true), times == 5);
            let until = suspect.careful_until().map(|(id, _)| id);
            assert_eq!(until, (times < 5).then_some(2));
        }
        assert!(!suspect.is_convicted(&window(&[]), true));
        assert!(suspect.careful_until().is_none());
    }
}
