//! MQTT 5.

use core::mem;

use anyhow::Result;
use log::warn;
use rumqttc::{
    Outgoing,
    v5::{
        self, AsyncClient, ConnectionError, EventLoop, MqttOptions, StateError,
        mqttbytes::{
            QoS,
            v5::{
                ConnectReturnCode, DisconnectReasonCode, LastWill, PubAck, PubAckReason, Publish,
                PublishProperties,
            },
        },
    },
};

use super::{
    connection::{
        Answer, Cause, Command, Connection, Event, Incoming, Lost, OFFLINE, Sender, keep_alive,
    },
    transport,
    window::Window,
};
use crate::gateway::{
    config::{Config, Mqtt},
    job::Reply,
    sparkplug::Packet,
    store::Message,
};

/// Largest packet that is taken, in bytes: the broker keeps larger ones to itself.
const MAX_PACKET: u32 = 64 * 1024;

/// Commands that the broker hands over before they are acknowledged.
const RECEIVE_MAX: u16 = 64;

/// The settings of the connection.
///
/// # Errors
/// Those of the files that the configuration names.
pub(super) fn options(config: &Config, mqtt: &Mqtt) -> Result<MqttOptions> {
    let broker = &mqtt.broker;
    let mut options = MqttOptions::new(config.name.as_str(), &broker.host, broker.port);
    options.set_keep_alive(keep_alive(mqtt));
    // The session holds nothing but commands, and those no longer than they are wanted.
    options.set_clean_start(mqtt.command_max_age_s == 0);
    options.set_session_expiry_interval(Some(mqtt.command_max_age_s));
    options.set_max_packet_size(Some(MAX_PACKET));
    options.set_receive_maximum(Some(RECEIVE_MAX));
    options.set_outgoing_inflight_upper_limit(Window::SIZE);
    options.set_last_will(LastWill::new(
        config.status_topic(),
        OFFLINE,
        QoS::AtLeastOnce,
        true,
        None,
    ));
    if let Some(user) = &mqtt.user {
        options.set_credentials(user, mqtt.password()?);
    }
    options.set_transport(transport(mqtt)?);
    Ok(options)
}

/// What the broker says when the connection is gone, in place of the gateway's status.
pub(super) fn set_will(options: &mut MqttOptions, Packet { topic, payload }: Packet) {
    options.set_last_will(LastWill::new(topic, payload, QoS::AtLeastOnce, false, None));
}

pub(super) fn connection(options: &MqttOptions, requests: usize) -> (AsyncClient, EventLoop) {
    AsyncClient::new(options.clone(), requests)
}

impl Connection for EventLoop {
    async fn next(&mut self) -> Result<Event, Lost> {
        Ok(self.poll().await?.into())
    }

    fn take_last(&mut self) -> Vec<Event> {
        let last = mem::take(&mut self.state.events);
        last.into_iter().map(Event::from).collect()
    }
}

impl Sender for AsyncClient {
    fn publish(&self, message: &Message) {
        let properties = PublishProperties {
            correlation_data: message.correlation.clone(),
            ..PublishProperties::default()
        };
        drop(self.try_publish_with_properties(
            &message.topic,
            QoS::AtLeastOnce,
            message.is_retained,
            message.payload.clone(),
            properties,
        ));
    }

    fn publish_once(&self, Packet { topic, payload }: Packet) {
        drop(self.try_publish(topic, QoS::AtMostOnce, false, payload));
    }

    fn subscribe(&self, topics: String) {
        drop(self.try_subscribe(topics, QoS::AtLeastOnce));
    }

    fn disconnect(&self) {
        drop(self.try_disconnect());
    }
}

impl From<v5::Event> for Event {
    fn from(event: v5::Event) -> Self {
        match event {
            v5::Event::Incoming(packet) => Self::Incoming(match packet {
                v5::Incoming::ConnAck(answer) => Incoming::Connected {
                    max_packet: answer.properties.and_then(|all| all.max_packet_size),
                },
                v5::Incoming::PubAck(answer) => acknowledged(&answer),
                v5::Incoming::SubAck(_) => Incoming::Subscribed,
                v5::Incoming::Publish(publish) => Incoming::Command(command(publish)),
                _ => Incoming::Other,
            }),
            v5::Event::Outgoing(Outgoing::Publish(id)) => Self::Sent(id),
            v5::Event::Outgoing(Outgoing::Disconnect) => Self::Left,
            v5::Event::Outgoing(_) => Self::Other,
        }
    }
}

fn acknowledged(answer: &PubAck) -> Incoming {
    Incoming::Acknowledged {
        id: answer.pkid,
        answer: match answer.reason {
            PubAckReason::Success | PubAckReason::NoMatchingSubscribers => Answer::Taken,
            PubAckReason::QuotaExceeded => Answer::Quota,
            reason => Answer::Refused(format!("{reason:?}")),
        },
    }
}

fn command(publish: Publish) -> Command {
    Command {
        topic: String::from_utf8_lossy(&publish.topic).into_owned(),
        is_retained: publish.retain,
        may_be_duplicate: publish.dup,
        reply: reply(&publish),
        payload: publish.payload,
    }
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

impl From<ConnectionError> for Lost {
    fn from(error: ConnectionError) -> Self {
        let cause = match &error {
            ConnectionError::ConnectionRefused(
                ConnectReturnCode::UnsupportedProtocolVersion
                | ConnectReturnCode::RefusedProtocolVersion,
            ) => Cause::Version,
            ConnectionError::MqttState(StateError::ServerDisconnect {
                reason_code: DisconnectReasonCode::SessionTakenOver,
                ..
            }) => Cause::Stolen,
            ConnectionError::MqttState(StateError::ConnectionAborted) => Cause::Closed,
            ConnectionError::MqttState(StateError::Deserialization(_))
            | ConnectionError::NotConnAck(_) => Cause::Garbled,
            _ => Cause::Other,
        };
        Self {
            message: error.to_string(),
            cause,
        }
    }
}
