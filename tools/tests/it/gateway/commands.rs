//! Commands: how old they may be, and who hears of them.

use core::time::Duration;

use rumqttc::v5::mqttbytes::v5::PublishProperties;
use serde_json::{Value, json};
use tempfile::TempDir;

use super::{
    broker_or_skip,
    partner::Partner,
    process::{Gateway, hall, line, mqtt},
    subscriber::Subscriber,
};

const COMMAND: &str = "line3964r/hall/scale/command";
const STATUS: &str = "line3964r/hall/scale/status";

/// Published while the gateway is away, between two runs of it.
#[tokio::test(flavor = "multi_thread")]
async fn a_command_for_a_gateway_that_is_away_is_run_only_if_that_is_wanted() {
    let broker = broker_or_skip!();
    for (max_age_s, is_run) in [(0, false), (60, true)] {
        let partner = Partner::new().await;
        let folder = TempDir::new().unwrap();
        let config = format!(
            "name = \"hall\"\n{}command_max_age_s = {max_age_s}\n[store]\npath = \"{}\"\n{}",
            mqtt(broker.port),
            folder.path().display(),
            line("scale", partner.port)
        );
        let mut subscriber = Subscriber::new(broker.port).await;
        let gateway = Gateway::start(&config);
        let scale = partner.link().await;
        // Its subscription was before.
        scale.send(b"A").await.unwrap();
        subscriber.at("line3964r/hall/scale/telegram").await;
        drop((gateway, scale));
        let command = r#"{"id": 1, "send": "41"}"#;
        subscriber.command("scale", command).await;
        subscriber.at(COMMAND).await;

        let gateway = Gateway::start(&config);
        let scale = partner.link().await;
        gateway.logs("broker: connected");
        let received = tokio::time::timeout(Duration::from_secs(2), scale.receive()).await;
        assert_eq!(received.is_ok(), is_run, "{max_age_s} s");
        // One for a gateway that is there.
        let command = r#"{"id": 2, "send": "42"}"#;
        subscriber.command("scale", command).await;
        assert_eq!(scale.receive().await.unwrap(), b"B");
        drop(gateway);
        subscriber.at(STATUS).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_response_topic_has_the_outcome_with_its_correlation_data() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let config = hall(&[&mqtt(broker.port), &line("scale", partner.port)]);
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    assert_eq!(subscriber.at(STATUS).await, b"online");
    gateway.logs("broker: connected");
    for (topic, correlation, command) in [
        ("line3964r/reply/1", &b"\x00\xFF"[..], r#"{"send": "41"}"#),
        // What is refused is answered, too.
        ("line3964r/reply/2", b"x", r#"{"sned": "41"}"#),
    ] {
        let properties = PublishProperties {
            response_topic: Some(topic.to_owned()),
            correlation_data: Some(correlation.into()),
            ..PublishProperties::default()
        };
        subscriber.ask(COMMAND, properties, command).await;
        let reply = loop {
            let publish = subscriber.next_publish().await;
            if publish.topic == topic {
                break publish;
            }
        };
        let properties = reply.properties.unwrap();
        assert_eq!(properties.correlation_data.unwrap(), correlation);
        let outcome: Value = serde_json::from_slice(&reply.payload).unwrap();
        assert_eq!(outcome["ok"], json!(command.contains("send")));
    }
    assert_eq!(scale.receive().await.unwrap(), b"A");
    // No topic: nothing is published there, and the gateway goes on.
    let properties = PublishProperties {
        response_topic: Some("line3964r/+".to_owned()),
        ..PublishProperties::default()
    };
    subscriber
        .ask(COMMAND, properties, r#"{"send": "42"}"#)
        .await;
    assert_eq!(scale.receive().await.unwrap(), b"B");
    gateway.ends();
}
