//! MQTT 3.1.1.

use core::mem;

use anyhow::Result;
use rumqttc::{
    AsyncClient, ConnectReturnCode, ConnectionError, EventLoop, LastWill, MqttOptions, Outgoing,
    Publish, QoS, StateError,
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
    sparkplug::Packet,
    store::Message,
};

/// Largest packet that is taken, in bytes. The broker cannot be told: one that is larger ends the
/// connection. Above what a command may have, so that it takes more than a slip.
const MAX_PACKET: usize = 1024 * 1024;

/// Largest packet there is, in bytes: the length has 28 bits. What the broker takes it does not
/// say.
const NO_LIMIT: usize = 0x0FFF_FFFF;

/// The settings of the connection.
///
/// # Errors
/// Those of the files that the configuration names.
pub(super) fn options(config: &Config, mqtt: &Mqtt) -> Result<MqttOptions> {
    let broker = &mqtt.broker;
    let mut options = MqttOptions::new(config.name.as_str(), &broker.host, broker.port);
    options.set_keep_alive(keep_alive(mqtt));
    // A session would keep commands for good.
    options.set_clean_session(true);
    options.set_max_packet_size(MAX_PACKET, NO_LIMIT);
    options.set_inflight(Window::SIZE);
    options.set_last_will(LastWill::new(
        config.status_topic(),
        OFFLINE,
        QoS::AtLeastOnce,
        true,
    ));
    if let Some(user) = &mqtt.user {
        options.set_credentials(user, mqtt.password()?);
    }
    options.set_transport(transport(mqtt)?);
    Ok(options)
}

/// What the broker says when the connection is gone, in place of the gateway's status.
pub(super) fn set_will(options: &mut MqttOptions, Packet { topic, payload }: Packet) {
    options.set_last_will(LastWill::new(topic, payload, QoS::AtLeastOnce, false));
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
        drop(self.try_publish(
            &message.topic,
            QoS::AtLeastOnce,
            message.is_retained,
            message.payload.clone(),
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

impl From<rumqttc::Event> for Event {
    fn from(event: rumqttc::Event) -> Self {
        match event {
            rumqttc::Event::Incoming(packet) => Self::Incoming(match packet {
                rumqttc::Incoming::ConnAck(_) => Incoming::Connected { max_packet: None },
                // There is no other answer.
                rumqttc::Incoming::PubAck(answer) => Incoming::Acknowledged {
                    id: answer.pkid,
                    answer: Answer::Taken,
                },
                rumqttc::Incoming::SubAck(_) => Incoming::Subscribed,
                rumqttc::Incoming::Publish(publish) => Incoming::Command(command(publish)),
                _ => Incoming::Other,
            }),
            rumqttc::Event::Outgoing(Outgoing::Publish(id)) => Self::Sent(id),
            rumqttc::Event::Outgoing(Outgoing::Disconnect) => Self::Left,
            rumqttc::Event::Outgoing(_) => Self::Other,
        }
    }
}

fn command(publish: Publish) -> Command {
    Command {
        topic: publish.topic,
        payload: publish.payload,
        is_retained: publish.retain,
        may_be_duplicate: publish.dup,
        reply: None,
    }
}

impl From<ConnectionError> for Lost {
    fn from(error: ConnectionError) -> Self {
        let cause = match &error {
            ConnectionError::ConnectionRefused(ConnectReturnCode::RefusedProtocolVersion) => {
                Cause::Version
            }
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
