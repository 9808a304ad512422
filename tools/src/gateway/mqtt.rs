//! The connection to the broker: MQTT 5, everything at least once.

mod tls;
mod window;

use core::{mem, pin::pin, sync::atomic::Ordering, time::Duration};

use anyhow::Result;
use log::{error, info, warn};
use rumqttc::{
    Outgoing, Transport,
    v5::{
        AsyncClient, ConnectionError, Event, EventLoop, Incoming, MqttOptions, StateError,
        mqttbytes::{
            QoS,
            v5::{
                ConnAck, DisconnectReasonCode, LastWill, PubAck, PubAckReason, Publish,
                PublishProperties,
            },
        },
    },
};
use thiserror::Error;
use tokio::time::Instant;
use tokio_util::sync::CancellationToken;

use self::window::Window;
use super::{
    config::{Config, Mqtt},
    hub::Hub,
    job::Reply,
    outbox::Outbox,
    store::Message,
};

/// Largest packet that is taken: the broker keeps larger ones to itself.
const MAX_PACKET: u32 = 64 * 1024;

/// Commands that the broker hands over before they are acknowledged.
const RECEIVE_MAX: u16 = 64;

/// From one attempt to connect to the next: doubled with each, between these.
const PAUSE: (Duration, Duration) = (Duration::from_millis(250), Duration::from_secs(15));

/// A connection that is closed for no reason so soon after another one is one too many.
const THEFT: Duration = Duration::from_secs(30);

/// Bytes of a PUBLISH besides topic and payload, at most: header, lengths, identifier, properties.
const OVERHEAD: usize = 16;

/// The settings of the connection.
///
/// # Errors
/// Those of the files that the configuration names.
pub(crate) fn options(config: &Config, mqtt: &Mqtt) -> Result<MqttOptions> {
    let broker = &mqtt.broker;
    let mut options = MqttOptions::new(config.name.as_str(), &broker.host, broker.port);
    options.set_keep_alive(Duration::from_secs(mqtt.keep_alive_s.into()));
    // The session holds nothing but commands, and those no longer than they are wanted.
    options.set_clean_start(mqtt.command_max_age_s == 0);
    options.set_session_expiry_interval(Some(mqtt.command_max_age_s));
    options.set_max_packet_size(Some(MAX_PACKET));
    options.set_receive_maximum(Some(RECEIVE_MAX));
    options.set_outgoing_inflight_upper_limit(Window::SIZE);
    let will = LastWill::new(
        config.status_topic(),
        "offline",
        QoS::AtLeastOnce,
        true,
        None,
    );
    options.set_last_will(will);
    if let Some(user) = &mqtt.user {
        options.set_credentials(user, mqtt.password()?);
    }
    if broker.is_tls {
        options.set_transport(Transport::Tls(tls::configuration(mqtt)?));
    }
    Ok(options)
}

/// Keeps the connection until `finishing` and everything is delivered.
pub(crate) async fn run(
    mut options: MqttOptions,
    hub: &Hub,
    outbox: &Outbox,
    finishing: &CancellationToken,
) {
    let max_age_s = options.session_expiry_interval().unwrap_or_default();
    let max_age = Duration::from_secs(max_age_s.into());
    let mut pause = PAUSE.0;
    let mut suspect = Suspect::default();
    // When the broker was last heard.
    let mut away_since = None;
    // When the broker closed a connection for no reason.
    let mut closed_at: Option<Instant> = None;
    loop {
        let mut session = Session::new(&options, hub, outbox);
        let ended = session.work(finishing).await;
        let heard_at = session.heard_at;
        let was_connected = hub.broker.is_connected.swap(false, Ordering::Relaxed);
        let Err(mut error) = ended else {
            return;
        };
        session.take_last_answers();
        let was_idle = session.window.is_empty();
        if was_connected {
            pause = PAUSE.0;
            if session.has_acknowledged
                && suspect.is_convicted(&session.window)
                && let Some(message) = session.window.take_first()
            {
                session.refused(
                    message,
                    &format!("{SUSPICIONS} times the end of a connection"),
                );
            }
        }
        session.window.restore(outbox);
        let is_closed = was_connected && was_idle && error.is_closed();
        let closed_before = mem::replace(&mut closed_at, is_closed.then(Instant::now));
        if error.is_theft() {
            error = Ended::Stolen(options.client_id());
            // Two that take it from each other are no help.
            pause = PAUSE.1;
        } else if is_closed && closed_before.is_some_and(|at| at.elapsed() < THEFT) {
            error = Ended::ClosedAgain(options.client_id());
        }
        warn!("broker: {error}; next attempt in {pause:?}");
        tokio::time::sleep(pause).await;
        pause = (2 * pause).min(PAUSE.1);
        if let Some(heard_at) = heard_at {
            away_since = Some(heard_at);
        }
        // A broker that has missed the end of the connection keeps commands for too long.
        let is_stale = away_since.is_some_and(|since| since.elapsed() >= max_age);
        options.set_clean_start(max_age.is_zero() || is_stale);
    }
}

/// Connections over which the broker answered others, and that ended with the same message
/// unanswered, before that is taken for the reason.
const SUSPICIONS: u32 = 5;

/// The first message that was unanswered when the connection ended, and how many times in a row.
/// Some brokers close the connection on what they do not take.
#[derive(Default)]
struct Suspect {
    /// By identifier, and by topic what is retained.
    message: Option<(u64, String)>,
    times: u32,
}

impl Suspect {
    fn is_convicted(&mut self, window: &Window) -> bool {
        let first = window.first();
        let message = first.map(|message| (message.id, message.topic.clone()));
        let before = if message == self.message {
            self.times
        } else {
            0
        };
        let times = if message.is_some() { before + 1 } else { 0 };
        *self = Self { message, times };
        times >= SUSPICIONS
    }
}

/// Why a connection has ended.
#[derive(Debug, Error)]
enum Ended {
    #[error(transparent)]
    Lost(#[from] ConnectionError),
    #[error("the quota is exceeded, messages wait")]
    Quota,
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
    /// Whether another client has connected under the same identifier.
    const fn is_theft(&self) -> bool {
        matches!(
            self,
            Self::Lost(ConnectionError::MqttState(StateError::ServerDisconnect {
                reason_code: DisconnectReasonCode::SessionTakenOver,
                ..
            }))
        )
    }

    /// Whether the broker has closed the connection without a word. In MQTT 3.1.1 there is none,
    /// and not every broker of MQTT 5 says it.
    const fn is_closed(&self) -> bool {
        matches!(
            self,
            Self::Lost(ConnectionError::MqttState(StateError::ConnectionAborted))
        )
    }
}

/// One connection.
struct Session<'h> {
    client: AsyncClient,
    event_loop: EventLoop,
    window: Window,
    hub: &'h Hub,
    outbox: &'h Outbox,
    /// Largest packet that the broker takes.
    max_packet: usize,
    is_connected: bool,
    /// The broker has acknowledged a message over this connection.
    has_acknowledged: bool,
    /// When the broker was last heard.
    heard_at: Option<Instant>,
}

impl<'h> Session<'h> {
    fn new(options: &MqttOptions, hub: &'h Hub, outbox: &'h Outbox) -> Self {
        // Room for a full window, the subscription and the farewell: `try_` never fails.
        let requests = usize::from(Window::SIZE) + 2;
        let (client, event_loop) = AsyncClient::new(options.clone(), requests);
        Self {
            client,
            event_loop,
            window: Window::default(),
            hub,
            outbox,
            max_packet: usize::MAX,
            is_connected: false,
            has_acknowledged: false,
            heard_at: None,
        }
    }

    /// # Errors
    /// The connection is lost, or was refused.
    async fn work(&mut self, finishing: &CancellationToken) -> Result<(), Ended> {
        let mut is_leaving = false;
        loop {
            let event = {
                let mut event = pin!(self.event_loop.poll());
                loop {
                    let is_done = || self.window.is_empty() && self.outbox.is_empty();
                    if finishing.is_cancelled() && self.is_connected && !is_leaving && is_done() {
                        drop(self.client.try_disconnect());
                        is_leaving = true;
                    }
                    tokio::select! {
                        event = &mut event => break event?,
                        message = self.outbox.next(), if self.is_connected && self.window.has_room() => {
                            let room = self.max_packet.saturating_sub(OVERHEAD);
                            if message.len() > room {
                                let reason = format!("{} bytes, the broker takes {room}", message.len());
                                refused(self.hub, self.outbox, message, &reason);
                            } else {
                                publish(&self.client, &message);
                                self.window.push(message);
                            }
                        }
                        () = finishing.cancelled(), if !finishing.is_cancelled() => {}
                    }
                }
            };
            if matches!(event, Event::Incoming(_)) {
                self.heard_at = Some(Instant::now());
            }
            match event {
                Event::Incoming(Incoming::ConnAck(answer)) => self.connected(&answer),
                Event::Incoming(Incoming::PubAck(answer)) => self.acknowledged(&answer)?,
                Event::Incoming(Incoming::Publish(publish)) => self.command(&publish),
                Event::Outgoing(Outgoing::Publish(id)) => self.window.numbered(id),
                Event::Outgoing(Outgoing::Disconnect) => return Ok(()),
                _ => {}
            }
        }
    }

    fn connected(&mut self, answer: &ConnAck) {
        let limit = answer
            .properties
            .as_ref()
            .and_then(|all| all.max_packet_size);
        if let Some(limit) = limit.and_then(|limit| usize::try_from(limit).ok()) {
            self.max_packet = limit;
        }
        self.is_connected = true;
        self.hub.broker.is_connected.store(true, Ordering::Relaxed);
        self.hub.broker.connects.fetch_add(1, Ordering::Relaxed);
        info!("broker: connected, {} messages wait", self.outbox.len());
        let commands = format!("{}/+/command", self.hub.topic);
        drop(self.client.try_subscribe(commands, QoS::AtLeastOnce));
    }

    /// # Errors
    /// The broker takes no more for now.
    fn acknowledged(&mut self, answer: &PubAck) -> Result<(), Ended> {
        if answer.reason == PubAckReason::QuotaExceeded {
            return Err(Ended::Quota);
        }
        let Some(message) = self.window.acknowledged(answer.pkid) else {
            return Ok(());
        };
        match answer.reason {
            PubAckReason::Success | PubAckReason::NoMatchingSubscribers => {
                self.outbox.done(&message);
                self.hub.broker.published.fetch_add(1, Ordering::Relaxed);
                self.has_acknowledged = true;
            }
            reason => self.refused(message, &format!("{reason:?}")),
        }
        Ok(())
    }

    /// Answers that came before the end of the connection, and were not handed out because of it.
    fn take_last_answers(&mut self) {
        for event in mem::take(&mut self.event_loop.state.events) {
            if let Event::Incoming(Incoming::PubAck(answer)) = event {
                self.acknowledged(&answer).ok();
            }
        }
    }

    fn refused(&self, message: Message, reason: &str) {
        refused(self.hub, self.outbox, message, reason);
    }

    fn command(&self, publish: &Publish) {
        let topic = String::from_utf8_lossy(&publish.topic);
        let line = topic
            .strip_prefix(&self.hub.topic)
            .and_then(|rest| rest.strip_prefix('/')?.strip_suffix("/command"));
        match line {
            Some(line) if publish.retain => {
                warn!("{line}: a retained command is not run: it would be with every connection");
            }
            Some(line) => {
                let reply = reply(publish);
                self.hub.command(line, &publish.payload, reply, publish.dup);
            }
            None => {}
        }
    }
}

fn publish(client: &AsyncClient, message: &Message) {
    let Message {
        topic,
        payload,
        correlation,
        is_retained,
        ..
    } = message;
    let properties = PublishProperties {
        correlation_data: correlation.clone(),
        ..PublishProperties::default()
    };
    let (qos, payload) = (QoS::AtLeastOnce, payload.clone());
    drop(client.try_publish_with_properties(topic, qos, *is_retained, payload, properties));
}

/// Where whoever sent a command wants to hear of it, if anything can be published there.
fn reply(publish: &Publish) -> Option<Reply> {
    let properties = publish.properties.as_ref()?;
    let topic = properties.response_topic.as_ref()?;
    if topic.is_empty() || topic.contains(['+', '#', '\0']) {
        warn!("`{}` is no topic for a response", topic.escape_default());
        return None;
    }
    Some(Reply {
        topic: topic.clone(),
        correlation: properties.correlation_data.clone(),
    })
}

/// The broker does not take a message. What is retained is not offered again until it is another.
fn refused(hub: &Hub, outbox: &Outbox, message: Message, reason: &str) {
    hub.broker.refused.fetch_add(1, Ordering::Relaxed);
    error!("broker: refused a message to {}: {reason}", message.topic);
    if message.is_retained {
        outbox.forget_retained(&message.topic);
        return;
    }
    if let Some(desk) = hub.line_of(&message.topic) {
        desk.counts.dead.fetch_add(1, Ordering::Relaxed);
    }
    outbox.refused(message, reason.to_owned());
}
