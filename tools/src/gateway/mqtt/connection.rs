//! One connection to a broker, of either version of MQTT.

use core::time::Duration;

use bytes::Bytes;
use thiserror::Error;

use super::window::Window;
use crate::gateway::{
    config::Mqtt,
    job::Reply,
    sparkplug::{Node, Packet},
    store::Message,
};

/// Requests that wait for a connection: a full window, the subscription and the farewell, so that
/// none is ever refused.
const REQUESTS: usize = Window::SIZE as usize + 2;

/// The same for an edge node: with each message of the window a birth may leave; births and deaths
/// of all devices, and what is subscribed to.
pub(super) fn requests(node: Option<&Node>) -> usize {
    node.map_or(REQUESTS, |node| 2 * REQUESTS + 2 * node.devices() + 8)
}

/// What the will says of the gateway.
pub(super) const OFFLINE: &str = "offline";

/// Waits for what happens on a connection.
pub(super) trait Connection {
    /// The next event. May be dropped and called again.
    ///
    /// # Errors
    /// The connection is lost, or was not made.
    async fn next(&mut self) -> Result<Event, Lost>;

    /// What came before the end of the connection, and was not handed out because of it.
    fn take_last(&mut self) -> Vec<Event>;
}

/// Hands packets to a connection, at least once.
pub(super) trait Sender {
    fn publish(&self, message: &Message);
    /// At most once: nothing is heard of it.
    fn publish_once(&self, packet: Packet);
    fn subscribe(&self, topics: String);
    fn disconnect(&self);
}

/// What happens on a connection.
pub(super) enum Event {
    /// The broker says something.
    Incoming(Incoming),
    /// A message has left under this packet identifier.
    Sent(u16),
    /// The farewell has left.
    Left,
    Other,
}

pub(super) enum Incoming {
    Connected {
        /// Largest packet that the broker takes, in bytes, where it says so.
        max_packet: Option<u32>,
    },
    Acknowledged {
        id: u16,
        answer: Answer,
    },
    Command(Command),
    /// A subscription has been answered.
    Subscribed,
    Other,
}

/// What the broker says to a message.
pub(super) enum Answer {
    Taken,
    /// It takes no more for now.
    Quota,
    /// It will never take it.
    Refused(String),
}

/// A message of a topic that was subscribed to.
pub(super) struct Command {
    pub(super) topic: String,
    pub(super) payload: Bytes,
    pub(super) is_retained: bool,
    pub(super) may_be_duplicate: bool,
    pub(super) reply: Option<Reply>,
}

/// Why a connection has ended, or was not made.
#[derive(Debug, Error)]
#[error("{message}")]
pub(super) struct Lost {
    pub(super) message: String,
    pub(super) cause: Cause,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    /// Another client has connected under the same identifier.
    Stolen,
    /// The broker says that it does not speak this version.
    Version,
    /// The broker has closed it without a word. In MQTT 3.1.1 there is none, and not every broker
    /// of MQTT 5 says it.
    Closed,
    /// What came is no packet of this version.
    Garbled,
    Other,
}

/// From one packet to the next.
pub(super) fn keep_alive(mqtt: &Mqtt) -> Duration {
    Duration::from_secs(mqtt.keep_alive_s.into())
}
