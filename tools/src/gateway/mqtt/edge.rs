//! An edge node of Sparkplug B on one connection.
//!
//! Its messages leave at most once, as Sparkplug has it, so that no broker answers. That the broker
//! has taken them is known from its answer to a subscription that follows them, since it takes the
//! packets of a connection in their order.

use core::mem;

use log::{info, warn};

use super::connection::Sender;
use crate::gateway::{
    hub::Hub,
    sparkplug::{Heard, Node},
    store::Message,
};

pub(super) struct Edge {
    node: Node,
    stage: Stage,
    /// A subscription has not been answered, and so many messages are before it.
    fenced: Option<usize>,
    /// The births are wanted once more, when what is under way has been taken.
    is_rebirth: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// So many subscriptions have not been answered.
    Subscribing(usize),
    /// The primary host is not online.
    Waiting,
    Born,
    /// The primary host has gone.
    NoHost,
}

impl Edge {
    pub(super) const fn new(node: Node) -> Self {
        Self {
            node,
            stage: Stage::Subscribing(0),
            fenced: None,
            is_rebirth: false,
        }
    }

    pub(super) fn is_born(&self) -> bool {
        self.stage == Stage::Born
    }

    pub(super) fn has_no_host(&self) -> bool {
        self.stage == Stage::NoHost
    }

    /// The connection is there.
    pub(super) fn subscribe(&mut self, sender: &impl Sender) {
        let topics = self.node.subscriptions();
        self.stage = Stage::Subscribing(topics.len());
        topics.into_iter().for_each(|topic| sender.subscribe(topic));
    }

    /// A subscription has been answered: so many messages have been taken.
    pub(super) fn subscribed(&mut self, sender: &impl Sender) -> usize {
        if let Stage::Subscribing(left) = self.stage {
            self.stage = match left {
                0 | 1 => Stage::Waiting,
                _ => Stage::Subscribing(left - 1),
            };
            self.begin(sender);
            return 0;
        }
        let taken = self.fenced.take().unwrap_or_default();
        if mem::take(&mut self.is_rebirth) {
            self.give_birth_again(sender);
        }
        taken
    }

    /// For the next connection.
    pub(super) fn into_node(self) -> Node {
        self.node
    }

    /// Publishes the births, if it is time.
    fn begin(&mut self, sender: &impl Sender) {
        if self.stage == Stage::Waiting && self.node.may_be_born() {
            self.stage = Stage::Born;
            self.give_birth(sender);
        } else if self.stage == Stage::Waiting {
            info!("broker: the primary host is not online, messages wait");
        }
    }

    fn give_birth(&mut self, sender: &impl Sender) {
        for packet in self.node.births() {
            sender.publish_once(packet);
        }
    }

    /// And not once more before the broker has taken these: there is room for one of each.
    fn give_birth_again(&mut self, sender: &impl Sender) {
        info!("broker: the births are published again");
        self.give_birth(sender);
        self.fenced = Some(0);
        sender.subscribe(self.node.fence());
    }

    /// # Errors
    /// A message that no metric has a place for, or that is larger than `room`.
    pub(super) fn publish(
        &mut self,
        sender: &impl Sender,
        message: &Message,
        room: usize,
    ) -> Result<(), String> {
        // Longer than what it becomes: the bytes are hexadecimal here.
        if message.len() > room {
            let len = message.len();
            return Err(format!("{len} bytes, the broker takes {room}"));
        }
        for packet in self.node.packets(message)? {
            sender.publish_once(packet);
        }
        Ok(())
    }

    /// Has the broker answer to all that was published, unless it is asked already.
    pub(super) fn fence(&mut self, sender: &impl Sender, published: usize) {
        if published > 0 && self.fenced.is_none() {
            self.fenced = Some(published);
            sender.subscribe(self.node.fence());
        } else if published == 0 && self.stage == Stage::Born {
            for packet in self.node.deaths() {
                sender.publish_once(packet);
            }
        }
    }

    /// The connection is closed in order.
    pub(super) fn leave(&mut self, sender: &impl Sender) {
        if matches!(self.stage, Stage::Born | Stage::NoHost) {
            sender.publish_once(self.node.death());
        }
    }

    pub(super) fn hear(
        &mut self,
        sender: &impl Sender,
        hub: &Hub,
        topic: &str,
        payload: &[u8],
        is_retained: bool,
    ) {
        match self.node.hear(topic, payload) {
            Ok(Heard::Host) if self.node.may_be_born() => self.begin(sender),
            Ok(Heard::Host) if self.stage == Stage::Born => self.stage = Stage::NoHost,
            Ok(Heard::Host | Heard::Nothing) => {}
            Ok(_) if is_retained => {
                warn!("{topic}: a retained command is not run: it would be with every connection");
            }
            Ok(Heard::Rebirth) if self.fenced.is_some() => self.is_rebirth = true,
            Ok(Heard::Rebirth) if self.stage == Stage::Born => self.give_birth_again(sender),
            Ok(Heard::Rebirth) => {}
            Ok(Heard::Commands { line, commands }) => {
                for command in commands {
                    hub.command(&line, command.as_bytes(), None, false);
                }
            }
            Err(error) => warn!("{}: {error}", topic.escape_default()),
        }
    }
}
