//! MQTT 3.1.1: found where the broker takes no other, and configured.

use alloc::sync::Arc;
use core::{
    sync::atomic::{AtomicUsize, Ordering},
    time::Duration,
};
use std::fs;

use rumqttc::{AsyncClient, Event, Incoming, MqttOptions, QoS, v5};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _, copy_bidirectional},
    net::TcpStream,
    time::{sleep, timeout},
};

use super::{
    broker::{Broker, PASSWORD, USER},
    broker_or_skip,
    listeners::listen,
    nats_server::Cluster,
    partner::Partner,
    process::{Gateway, PATIENCE, hall, line, mqtt},
    subscriber::Subscriber,
};

/// Where the protocol level is in a CONNECT whose length has two bytes, as that of a gateway has.
const LEVEL: usize = 9;

/// A front of the broker that says this to a CONNECT of MQTT 5 and closes the connection, as often
/// as it shall.
async fn front(broker: u16, answer: &'static [u8], times: usize) -> (u16, Arc<AtomicUsize>) {
    let listener = listen();
    let port = listener.local_addr().unwrap().port();
    let refused = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&refused);
    tokio::spawn(async move {
        while let Ok((mut client, _)) = listener.accept().await {
            let mut connect = [0; 1024];
            let len = client.read(&mut connect).await.unwrap();
            // A length of one byte puts the level one byte further in front.
            let level = connect[if connect[1] < 0x80 { LEVEL - 1 } else { LEVEL }];
            if level == 5 && counted.load(Ordering::Relaxed) < times {
                counted.fetch_add(1, Ordering::Relaxed);
                client.write_all(answer).await.unwrap();
                continue;
            }
            let mut server = TcpStream::connect(("127.0.0.1", broker)).await.unwrap();
            server.write_all(&connect[..len]).await.unwrap();
            tokio::spawn(async move { copy_bidirectional(&mut client, &mut server).await.ok() });
        }
    });
    (port, refused)
}

#[tokio::test(flavor = "multi_thread")]
async fn a_broker_without_5_is_found_out() {
    let broker = broker_or_skip!();
    for (answer, refusals) in [
        // As NATS 2.9 says it, as aedes does, and as MQTT 5 wants it.
        (&[0x20, 2, 0, 1][..], 2),
        (&[], 2),
        (&[0x20, 3, 0, 0x84, 0], 1),
    ] {
        let (port, refused) = front(broker.port, answer, usize::MAX).await;
        let partner = Partner::new().await;
        let mut subscriber = Subscriber::new(broker.port).await;
        let config = hall(&[
            &mqtt(port),
            "command_max_age_s = 60\n",
            &line("scale", partner.port),
        ]);
        let gateway = Gateway::start(&config);
        let scale = partner.link().await;
        gateway.logs("broker: connected by MQTT 3.1.1");
        gateway.logs("MQTT 3.1.1 has no command_max_age_s");
        // A connection that takes too long on a busy computer is made again.
        assert!(refused.load(Ordering::Relaxed) >= refusals, "{answer:02X?}");
        scale.send(b"A").await.unwrap();
        let telegram = subscriber.json_at("line3964r/hall/scale/telegram").await;
        assert_eq!(telegram["hex"], "41");
        // The response topic is lost on the way, the outcome is not.
        let properties = v5::mqttbytes::v5::PublishProperties {
            response_topic: Some("line3964r/answers".to_owned()),
            ..Default::default()
        };
        let command = r#"{"id": 7, "send": "42"}"#;
        subscriber
            .ask("line3964r/hall/scale/command", properties, command)
            .await;
        assert_eq!(scale.receive().await.unwrap(), b"B");
        let outcome = subscriber.outcome("scale").await;
        assert_eq!((&outcome["id"], &outcome["ok"]), (&json!(7), &json!(true)));
        drop(gateway); // killed: the will
        while subscriber.at("line3964r/hall/status").await != b"offline" {}
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_broker_of_5_that_is_silent_for_a_while_is_one_of_5() {
    let broker = broker_or_skip!();
    let (port, refused) = front(broker.port, &[], 1).await;
    let partner = Partner::new().await;
    let config = hall(&[&mqtt(port), &line("scale", partner.port)]);
    let gateway = Gateway::start(&config);
    gateway.logs("broker: connected by MQTT 5");
    assert_eq!(refused.load(Ordering::Relaxed), 1);
    assert!(gateway.log().contains("MQTT 3.1.1 is taken"));
}

/// The end of the connection is the only answer to what mosquitto does not take.
#[tokio::test(flavor = "multi_thread")]
async fn what_ends_connections_of_3_1_1_is_a_dead_letter() {
    let Some(broker) = Broker::start_with("max_packet_size 2000\n", None) else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let partner = Partner::new().await;
    let config = format!(
        "name = \"hall\"\n{}protocol = \"3.1.1\"\n[store]\npath = \"{}\"\n{}",
        mqtt(broker.port),
        folder.path().display(),
        line("scale", partner.port)
    );
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    gateway.logs("broker: connected by MQTT 3.1.1");
    let mut sent = Vec::new();
    for number in 0..20_u8 {
        let len = if number % 10 == 5 { 1500 } else { 1 };
        scale.send(&vec![number; len]).await.unwrap();
        if len == 1 {
            sent.push(format!("{number:02X}"));
        }
    }
    let mut heard: Vec<String> = Vec::new();
    while heard.len() < sent.len() {
        let telegram = subscriber.json_at("line3964r/hall/scale/telegram").await;
        let hex = telegram["hex"].as_str().unwrap().to_owned();
        // At least once.
        if !heard.contains(&hex) {
            heard.push(hex);
        }
    }
    assert_eq!(heard, sent);
    let (status, log) = gateway.stop();
    assert_eq!(status.code(), Some(1), "{log}");
    let reason = "5 times the end of a connection";
    assert_eq!(log.matches(reason).count(), 2, "{log}");
    let letters = fs::read_to_string(folder.path().join("dead-letters.jsonl")).unwrap();
    for (letter, number) in letters.lines().zip(["05", "0F"]) {
        let letter: Value = serde_json::from_str(letter).unwrap();
        assert_eq!(letter["reason"], reason);
        let payload: Value = serde_json::from_str(letter["payload"].as_str().unwrap()).unwrap();
        assert!(payload["hex"].as_str().unwrap().starts_with(number));
    }
    assert_eq!(letters.lines().count(), 2);
}

/// A command that is too large for the gateway ends the connection, and does not come again.
#[tokio::test(flavor = "multi_thread")]
async fn a_packet_that_is_too_large_ends_one_connection() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let config = hall(&[
        &mqtt(broker.port),
        "protocol = \"3.1.1\"\n",
        &line("scale", partner.port),
    ]);
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    // Its subscription was before.
    scale.send(b"A").await.unwrap();
    subscriber.at("line3964r/hall/scale/telegram").await;
    let command = "line3964r/hall/scale/command";
    let (qos, large) = (v5::mqttbytes::QoS::AtLeastOnce, vec![b'x'; 2 << 20]);
    subscriber.publish(command, qos, large).await;
    gateway.logs("payload size limit exceeded");
    scale.send(b"B").await.unwrap();
    while subscriber.json_at("line3964r/hall/scale/telegram").await["hex"] != "42" {}
    subscriber.publish(command, qos, r#"{"send": "43"}"#).await;
    assert_eq!(scale.receive().await.unwrap(), b"C");
    let log = gateway.ends();
    assert_eq!(log.matches("broker: connected").count(), 2, "{log}");
}

/// NATS 2.9, which speaks 3.1.1 alone.
#[tokio::test(flavor = "multi_thread")]
async fn nats() {
    let Some(server) = Cluster::start(1, "").await else {
        return;
    };
    let port = server.mqtt_port();
    let mut options = MqttOptions::new("subscriber", "127.0.0.1", port);
    options.set_credentials(USER, PASSWORD);
    let (client, mut events) = AsyncClient::new(options, 10);
    client
        .try_subscribe("line3964r/#", QoS::AtLeastOnce)
        .unwrap();
    let mut next = async || loop {
        match timeout(PATIENCE, events.poll()).await.expect("a message") {
            Ok(Event::Incoming(packet)) => break packet,
            Ok(Event::Outgoing(_)) => {}
            Err(_) => sleep(Duration::from_millis(50)).await,
        }
    };
    while !matches!(next().await, Incoming::SubAck(_)) {}

    let partner = Partner::new().await;
    let config = hall(&[&mqtt(port), &line("scale", partner.port)]);
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    gateway.logs("broker: connected by MQTT 3.1.1");
    for number in 0..100 {
        scale.send(&[number]).await.unwrap();
    }
    let command = r#"{"id": 1, "send": "41"}"#;
    let topic = "line3964r/hall/scale/command";
    client
        .try_publish(topic, QoS::AtLeastOnce, false, command)
        .unwrap();
    let (mut telegrams, mut outcomes) = (Vec::new(), Vec::new());
    let hearing = async {
        while telegrams.len() < 100 || outcomes.is_empty() {
            if let Incoming::Publish(publish) = next().await {
                let kept = match publish.topic.as_str() {
                    "line3964r/hall/scale/telegram" => &mut telegrams,
                    "line3964r/hall/scale/outcome" => &mut outcomes,
                    _ => continue,
                };
                kept.push(serde_json::from_slice::<Value>(&publish.payload).unwrap());
            }
        }
    };
    let (_, command) = tokio::join!(hearing, scale.receive());
    assert_eq!(command.unwrap(), b"A");
    for (number, telegram) in telegrams.iter().enumerate() {
        assert_eq!(telegram["hex"], format!("{number:02X}"));
    }
    assert_eq!(outcomes[0]["ok"], true);
    gateway.ends();
}
