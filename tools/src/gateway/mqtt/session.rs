//! What is published and heard over one connection.

use core::{pin::pin, sync::atomic::Ordering};

use log::{info, warn};
use thiserror::Error;
use tokio::time::Instant;
use tokio_util::sync::CancellationToken;

use super::{
    connection::{Answer, Cause, Command, Connection, Event, Incoming, Lost, Sender},
    edge::Edge,
    version::Version,
    window::{Name, Window},
};
use crate::gateway::{hub::Hub, outbox::Outbox, sparkplug::Node, store::Message};

/// Bytes of a PUBLISH besides topic and payload, at most: header, lengths, identifier, properties.
const OVERHEAD: usize = 16;

/// Why a connection has ended.
#[derive(Debug, Error)]
pub(super) enum Ended {
    #[error(transparent)]
    Lost(#[from] Lost),
    #[error("the quota is exceeded, messages wait")]
    Quota,
    #[error("the primary host is gone, messages wait")]
    NoHost,
    #[error(
        "another client has taken the identifier `{0}`: there is a second gateway of this name"
    )]
    Stolen(String),
    #[error(
        "closed by the broker again, which does not say why: has another client the identifier `{0}`?"
    )]
    ClosedAgain(String),
}

impl Ended {
    pub(super) const fn cause(&self) -> Cause {
        match self {
            Self::Lost(lost) => lost.cause,
            _ => Cause::Other,
        }
    }
}

/// What a connection is for.
#[derive(Clone)]
pub(super) enum Purpose {
    /// To see that the broker takes it.
    Trial,
    /// For everything; up to this message one at a time.
    Work { careful_until: Option<Name> },
}

impl Purpose {
    fn answered(&mut self, message: &Message) {
        if let Self::Work { careful_until } = self
            && let Some((id, topic)) = careful_until
            && (message.id > *id || *topic == message.topic)
        {
            *careful_until = None;
        }
    }
}

/// What there is of a connection besides the connection.
pub(super) struct Session<'h> {
    pub(super) window: Window,
    hub: &'h Hub,
    outbox: &'h Outbox,
    version: Version,
    purpose: Purpose,
    /// As an edge node of Sparkplug B.
    edge: Option<Edge>,
    /// Largest packet that the broker takes.
    max_packet: usize,
    pub(super) is_connected: bool,
    /// The broker has answered to something over this connection.
    pub(super) has_answered: bool,
    /// The broker has acknowledged a message over this connection.
    pub(super) has_acknowledged: bool,
    /// When the broker was last heard.
    pub(super) heard_at: Option<Instant>,
}

impl<'h> Session<'h> {
    pub(super) fn new(
        hub: &'h Hub,
        outbox: &'h Outbox,
        version: Version,
        purpose: Purpose,
        node: Option<Node>,
    ) -> Self {
        Self {
            window: Window::default(),
            hub,
            outbox,
            version,
            purpose,
            edge: node.map(Edge::new),
            max_packet: usize::MAX,
            is_connected: false,
            has_answered: false,
            has_acknowledged: false,
            heard_at: None,
        }
    }

    /// The edge node, for the next connection.
    pub(super) fn take_node(&mut self) -> Option<Node> {
        self.edge.take().map(Edge::into_node)
    }

    /// Uses a connection to its end, and takes the answers that came before it.
    ///
    /// # Errors
    /// The connection is lost, or was refused.
    pub(super) async fn run(
        &mut self,
        (sender, mut connection): (impl Sender, impl Connection),
        finishing: &CancellationToken,
    ) -> Result<(), Ended> {
        let ended = self.work(&sender, &mut connection, finishing).await;
        if ended.is_err() {
            for event in connection.take_last() {
                if let Event::Incoming(Incoming::Acknowledged { id, answer }) = event {
                    self.acknowledged(id, answer).ok();
                }
            }
        }
        ended
    }

    /// # Errors
    /// The connection is lost, or was refused.
    async fn work(
        &mut self,
        sender: &impl Sender,
        connection: &mut impl Connection,
        finishing: &CancellationToken,
    ) -> Result<(), Ended> {
        let mut is_leaving = false;
        loop {
            let event = {
                let mut event = pin!(connection.next());
                loop {
                    if self.is_connected && !is_leaving && self.is_over(finishing) {
                        if let Some(edge) = &mut self.edge {
                            edge.leave(sender);
                        }
                        sender.disconnect();
                        is_leaving = true;
                    }
                    tokio::select! {
                        event = &mut event => break event?,
                        message = self.outbox.next(), if self.has_room() => {
                            self.publish(sender, message);
                        }
                        () = finishing.cancelled(), if !finishing.is_cancelled() => {}
                    }
                }
            };
            match event {
                Event::Incoming(incoming) => self.heard(incoming, sender)?,
                // Those of an edge node have none.
                Event::Sent(_) if self.edge.is_some() => {}
                Event::Sent(id) => self.window.numbered(id),
                Event::Left if self.has_no_host() => return Err(Ended::NoHost),
                Event::Left => return Ok(()),
                Event::Other => {}
            }
        }
    }

    fn has_no_host(&self) -> bool {
        self.edge.as_ref().is_some_and(Edge::has_no_host)
    }

    fn is_over(&self, finishing: &CancellationToken) -> bool {
        match self.purpose {
            Purpose::Trial => true,
            Purpose::Work { .. } if self.has_no_host() => true,
            Purpose::Work { .. } => {
                finishing.is_cancelled() && self.window.is_empty() && self.outbox.is_empty()
            }
        }
    }

    fn has_room(&self) -> bool {
        match self.purpose {
            _ if !self.is_connected => false,
            _ if self.edge.as_ref().is_some_and(|edge| !edge.is_born()) => false,
            Purpose::Trial => false,
            Purpose::Work {
                careful_until: Some(_),
            } => self.window.is_empty(),
            Purpose::Work { .. } => self.window.has_room(),
        }
    }

    fn publish(&mut self, sender: &impl Sender, message: Message) {
        let room = self.max_packet.saturating_sub(OVERHEAD);
        if let Some(edge) = &mut self.edge {
            match edge.publish(sender, &message, room) {
                Ok(()) => {
                    self.window.push(message);
                    edge.fence(sender, self.window.len());
                }
                Err(reason) => self.hub.refused(self.outbox, message, &reason),
            }
            return;
        }
        if message.len() > room {
            let reason = format!("{} bytes, the broker takes {room}", message.len());
            self.hub.refused(self.outbox, message, &reason);
        } else {
            sender.publish(&message);
            self.window.push(message);
        }
    }

    /// # Errors
    /// The broker takes no more for now.
    fn heard(&mut self, incoming: Incoming, sender: &impl Sender) -> Result<(), Ended> {
        self.heard_at = Some(Instant::now());
        self.has_answered |= self.is_connected;
        match incoming {
            Incoming::Connected { max_packet } => self.connected(max_packet, sender),
            Incoming::Acknowledged { id, answer } => self.acknowledged(id, answer)?,
            Incoming::Command(command) => self.command(command, sender),
            Incoming::Subscribed => self.subscribed(sender),
            Incoming::Other => {}
        }
        Ok(())
    }

    fn connected(&mut self, max_packet: Option<u32>, sender: &impl Sender) {
        if let Some(limit) = max_packet.and_then(|limit| usize::try_from(limit).ok()) {
            self.max_packet = limit;
        }
        self.is_connected = true;
        if matches!(self.purpose, Purpose::Trial) {
            return;
        }
        self.hub.broker.is_connected.store(true, Ordering::Relaxed);
        self.hub.broker.connects.fetch_add(1, Ordering::Relaxed);
        let (version, waiting) = (self.version, self.outbox.len());
        info!("broker: connected by {version}, {waiting} messages wait");
        match &mut self.edge {
            Some(edge) => edge.subscribe(sender),
            None => sender.subscribe(format!("{}/+/command", self.hub.topic)),
        }
    }

    /// What an edge node has published before it has been taken.
    fn subscribed(&mut self, sender: &impl Sender) {
        let Some(edge) = &mut self.edge else {
            return;
        };
        for _ in 0..edge.subscribed(sender) {
            if let Some(message) = self.window.take_first() {
                self.purpose.answered(&message);
                self.outbox.done(&message);
                self.hub.broker.published.fetch_add(1, Ordering::Relaxed);
                self.has_acknowledged = true;
            }
        }
        edge.fence(sender, self.window.len());
    }

    /// # Errors
    /// The broker takes no more for now.
    fn acknowledged(&mut self, id: u16, answer: Answer) -> Result<(), Ended> {
        if matches!(answer, Answer::Quota) {
            return Err(Ended::Quota);
        }
        let Some(message) = self.window.acknowledged(id) else {
            return Ok(());
        };
        self.purpose.answered(&message);
        match answer {
            Answer::Refused(reason) => self.hub.refused(self.outbox, message, &reason),
            Answer::Taken | Answer::Quota => {
                self.outbox.done(&message);
                self.hub.broker.published.fetch_add(1, Ordering::Relaxed);
                self.has_acknowledged = true;
            }
        }
        Ok(())
    }

    fn command(&mut self, command: Command, sender: &impl Sender) {
        let Command {
            topic,
            payload,
            is_retained,
            may_be_duplicate,
            reply,
        } = command;
        if let Some(edge) = &mut self.edge {
            edge.hear(sender, self.hub, &topic, &payload, is_retained);
            return;
        }
        let line = topic
            .strip_prefix(&self.hub.topic)
            .and_then(|rest| rest.strip_prefix('/')?.strip_suffix("/command"));
        match line {
            Some(line) if is_retained => {
                warn!("{line}: a retained command is not run: it would be with every connection");
            }
            Some(line) => self.hub.command(line, &payload, reply, may_be_duplicate),
            None => {}
        }
    }
}
