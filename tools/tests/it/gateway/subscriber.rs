//! A client of the broker, whose session outlives a stop of either.

use core::time::Duration;

use rumqttc::v5::{
    AsyncClient, Event, Incoming, MqttOptions,
    mqttbytes::{
        QoS,
        v5::{Publish, PublishProperties},
    },
};
use serde_json::Value;
use tokio::{
    sync::mpsc,
    task::JoinHandle,
    time::{sleep, timeout},
};

use super::{
    broker::{PASSWORD, USER},
    process::PATIENCE,
};

const TOPICS: [&str; 3] = ["line3964r/#", "homeassistant/#", "spBv1.0/#"];

/// Hears everything below them.
pub(crate) struct Subscriber {
    client: AsyncClient,
    heard: mpsc::UnboundedReceiver<Publish>,
    task: JoinHandle<()>,
}

impl Drop for Subscriber {
    /// The next one has its identifier: this one must not take the connection back.
    fn drop(&mut self) {
        self.task.abort();
    }
}

impl Subscriber {
    /// Connected, and subscribed.
    pub(crate) async fn new(port: u16) -> Self {
        let mut options = MqttOptions::new("subscriber", "127.0.0.1", port);
        options.set_credentials(USER, PASSWORD);
        options.set_clean_start(false);
        options.set_session_expiry_interval(Some(3600));
        // It hears its own commands, too large ones among them.
        options.set_max_packet_size(Some(4 << 20));
        let (client, mut events) = AsyncClient::new(options, 1000);
        let (sender, heard) = mpsc::unbounded_channel();
        let (subscribed, mut is_subscribed) = mpsc::unbounded_channel();
        for topics in TOPICS {
            client.try_subscribe(topics, QoS::AtLeastOnce).unwrap();
        }
        let task = tokio::spawn(async move {
            loop {
                match events.poll().await {
                    Ok(Event::Incoming(Incoming::Publish(publish))) => {
                        if sender.send(publish).is_err() {
                            return;
                        }
                    }
                    Ok(Event::Incoming(Incoming::SubAck(_))) => drop(subscribed.send(())),
                    Ok(_) => {}
                    Err(_) => sleep(Duration::from_millis(50)).await,
                }
            }
        });
        for _ in TOPICS {
            is_subscribed.recv().await.unwrap();
        }
        Self {
            client,
            heard,
            task,
        }
    }

    /// The next message as it came.
    pub(crate) async fn next_publish(&mut self) -> Publish {
        let heard = timeout(PATIENCE, self.heard.recv()).await;
        heard.expect("a message").unwrap()
    }

    /// The next message: topic and payload.
    pub(crate) async fn next(&mut self) -> (String, Vec<u8>) {
        let publish = self.next_publish().await;
        (
            String::from_utf8(publish.topic.to_vec()).unwrap(),
            publish.payload.to_vec(),
        )
    }

    /// The next message, if one comes within this time.
    pub(crate) async fn next_within(&mut self, time: Duration) -> Option<(String, Vec<u8>)> {
        let publish = timeout(time, self.heard.recv()).await.ok()??;
        let topic = String::from_utf8(publish.topic.to_vec()).unwrap();
        Some((topic, publish.payload.to_vec()))
    }

    /// The next message of this topic; others are passed over.
    pub(crate) async fn at(&mut self, topic: &str) -> Vec<u8> {
        loop {
            let (heard, payload) = self.next().await;
            if heard == topic {
                return payload;
            }
        }
    }

    pub(crate) async fn json_at(&mut self, topic: &str) -> Value {
        serde_json::from_slice(&self.at(topic).await).unwrap()
    }

    pub(crate) async fn publish(&self, topic: &str, qos: QoS, payload: impl Into<Vec<u8>>) {
        let payload: Vec<u8> = payload.into();
        self.client
            .publish(topic, qos, false, payload)
            .await
            .unwrap();
    }

    /// A command for a line of the gateway `hall`.
    pub(crate) async fn command(&self, line: &str, command: impl Into<Vec<u8>>) {
        let topic = format!("line3964r/hall/{line}/command");
        self.publish(&topic, QoS::AtLeastOnce, command).await;
    }

    /// The next outcome of a command for it.
    pub(crate) async fn outcome(&mut self, line: &str) -> Value {
        let topic = format!("line3964r/hall/{line}/outcome");
        self.json_at(&topic).await
    }

    /// Publishes what wants an answer.
    pub(crate) async fn ask(&self, topic: &str, properties: PublishProperties, payload: &str) {
        let (qos, payload) = (QoS::AtLeastOnce, payload.to_owned());
        let published = self
            .client
            .publish_with_properties(topic, qos, false, payload, properties);
        published.await.unwrap();
    }
}
