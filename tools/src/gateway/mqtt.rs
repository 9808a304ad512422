//! The connection to the broker: MQTT 5, everything at least once.

mod tls;
mod window;

use core::{pin::pin, sync::atomic::Ordering, time::Duration};

use anyhow::Result;
use log::{error, info, warn};
use rumqttc::{
    Outgoing, Transport,
    v5::{
        AsyncClient, ConnectionError, Event, EventLoop, Incoming, MqttOptions,
        mqttbytes::{
            QoS,
            v5::{ConnAck, LastWill, PubAck, PubAckReason, Publish},
        },
    },
};
use tokio_util::sync::CancellationToken;

use self::window::Window;
use super::{
    config::{Config, Mqtt},
    hub::Hub,
    outbox::{Message, Outbox},
};

/// Largest packet that is taken: the broker keeps larger ones to itself.
const MAX_PACKET: u32 = 64 * 1024;

/// Commands that the broker hands over before they are acknowledged.
const RECEIVE_MAX: u16 = 64;

/// From one attempt to connect to the next: doubled with each, between these.
const PAUSE: (Duration, Duration) = (Duration::from_millis(250), Duration::from_secs(15));

/// Bytes of a PUBLISH besides topic and payload, at most: header, lengths, identifier, properties.
const OVERHEAD: usize = 16;

/// The settings of the connection.
///
/// # Errors
/// Those of the files that the configuration names.
pub(crate) fn options(config: &Config, mqtt: &Mqtt, hub: &Hub) -> Result<MqttOptions> {
    let broker = &mqtt.broker;
    let mut options = MqttOptions::new(config.name.as_str(), &broker.host, broker.port);
    options.set_keep_alive(Duration::from_secs(mqtt.keep_alive_s.into()));
    options.set_clean_start(false);
    options.set_session_expiry_interval(Some(mqtt.session_expiry_s));
    options.set_max_packet_size(Some(MAX_PACKET));
    options.set_receive_maximum(Some(RECEIVE_MAX));
    options.set_outgoing_inflight_upper_limit(Window::SIZE);
    let will = LastWill::new(hub.status_topic(), "offline", QoS::AtLeastOnce, true, None);
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
    options: MqttOptions,
    hub: &Hub,
    outbox: &Outbox,
    finishing: &CancellationToken,
) {
    let mut pause = PAUSE.0;
    loop {
        let mut session = Session::new(&options, hub, outbox);
        let ended = session.work(finishing).await;
        let was_connected = hub.broker.is_connected.swap(false, Ordering::Relaxed);
        session.window.restore(outbox);
        let Err(error) = ended else {
            return;
        };
        if was_connected {
            pause = PAUSE.0;
        }
        warn!("broker: {error}; next attempt in {pause:?}");
        tokio::time::sleep(pause).await;
        pause = (2 * pause).min(PAUSE.1);
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
        }
    }

    /// # Errors
    /// The connection is lost, or was refused.
    async fn work(&mut self, finishing: &CancellationToken) -> Result<(), ConnectionError> {
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
                            publish(&self.client, &mut self.window, message, self.max_packet, self.outbox, self.hub);
                        }
                        () = finishing.cancelled(), if !finishing.is_cancelled() => {}
                    }
                }
            };
            match event {
                Event::Incoming(Incoming::ConnAck(answer)) => self.connected(&answer),
                Event::Incoming(Incoming::PubAck(answer)) => self.acknowledged(&answer),
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

    fn acknowledged(&mut self, answer: &PubAck) {
        let Some(message) = self.window.acknowledged(answer.pkid) else {
            return;
        };
        self.outbox.done(&message);
        match answer.reason {
            PubAckReason::Success | PubAckReason::NoMatchingSubscribers => {
                self.hub.broker.published.fetch_add(1, Ordering::Relaxed);
            }
            reason => {
                self.hub.broker.refused.fetch_add(1, Ordering::Relaxed);
                error!("broker: refused a message to {}: {reason:?}", message.topic);
            }
        }
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
            Some(line) => self.hub.command(line, &publish.payload, publish.dup),
            None => {}
        }
    }
}

fn publish(
    client: &AsyncClient,
    window: &mut Window,
    message: Message,
    max_packet: usize,
    outbox: &Outbox,
    hub: &Hub,
) {
    let Message {
        topic,
        payload,
        is_retained,
    } = &message;
    let len = topic.len() + payload.len() + OVERHEAD;
    if len > max_packet {
        error!("broker: takes packets up to {max_packet} bytes, not {len} for {topic}");
        hub.broker.refused.fetch_add(1, Ordering::Relaxed);
        outbox.done(&message);
        return;
    }
    let at_least_once = QoS::AtLeastOnce;
    drop(client.try_publish(topic, at_least_once, *is_retained, payload.clone()));
    window.push(message);
}
