//! What is refused, and that lines go on meanwhile.

use alloc::collections::BTreeSet;
use core::time::Duration;

use rumqttc::v5::mqttbytes::QoS;
use serde_json::json;
use tokio::{net::TcpStream, task::spawn_blocking};

use super::{
    broker::{PASSWORD, USER},
    broker_or_skip,
    listeners::free_ports,
    partner::Partner,
    process::{Gateway, hall, line, metric, mqtt},
    subscriber::Subscriber,
};

#[tokio::test(flavor = "multi_thread")]
async fn a_wrong_password_is_refused_and_the_line_goes_on() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let mqtt = mqtt(broker.port).replace(PASSWORD, "guessed");
    let gateway = Gateway::start(&format!(
        "name = \"hall\"\nstop_s = 1\n{mqtt}{}",
        line("scale", partner.port)
    ));
    let scale = partner.link().await;
    gateway.logs("Connection refused, return code: `NotAuthorized`");
    scale.send(b"still here").await.unwrap();
    let log = gateway.ends();
    // The telegram waits for the next start, and that is said.
    assert!(log.contains("1 messages wait in the store"), "{log}");
}

#[tokio::test(flavor = "multi_thread")]
async fn certificates() {
    let broker = broker_or_skip!();
    let mut subscriber = Subscriber::new(broker.port).await;
    let partner = Partner::new().await;
    let config = |authority: std::path::PathBuf| {
        let (port, authority) = (broker.tls_port, authority.display());
        format!(
            "name = \"hall\"\nstop_s = 1\n[mqtt]\nbroker = \"mqtts://127.0.0.1:{port}\"\nuser = \"{USER}\"\n\
             password = \"{PASSWORD}\"\nca_file = \"{authority}\"\n{}",
            line("scale", partner.port)
        )
    };
    let wrong = Gateway::start(&config(broker.other_authority()));
    let scale = partner.link().await;
    wrong.logs("invalid peer certificate");
    scale.send(b"still here").await.unwrap();
    drop((wrong, scale));

    let _right = Gateway::start(&config(broker.authority()));
    let scale = partner.link().await;
    scale.send(b"over TLS").await.unwrap();
    let telegram = subscriber.json_at("line3964r/hall/scale/telegram").await;
    assert_eq!(telegram["hex"], "6F 76 65 72 20 54 4C 53");
}

#[tokio::test(flavor = "multi_thread")]
async fn oversized_payloads_and_a_flood_of_commands() {
    /// Above what a line takes, and above what the gateway takes from the broker.
    const OVERSIZED: [usize; 2] = [20 * 1024, 1024 * 1024];
    const FLOOD: usize = 3000;
    let broker = broker_or_skip!();
    let mut subscriber = Subscriber::new(broker.port).await;
    let partner = Partner::new().await;
    let config = hall(&[&mqtt(broker.port), &line("scale", partner.port)]);
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    assert_eq!(
        subscriber.at("line3964r/hall/scale/status").await,
        b"online"
    );
    let (command, outcome) = (
        "line3964r/hall/scale/command",
        "line3964r/hall/scale/outcome",
    );

    for len in OVERSIZED {
        let payload = format!("{{\"send_text\": \"{}\"}}", "x".repeat(len));
        subscriber.publish(command, QoS::AtLeastOnce, payload).await;
    }
    let refused = subscriber.json_at(outcome).await;
    assert_eq!(refused["error"], "a command of 20497 bytes, at most 16384");
    gateway.logs("command refused: a command of 20497 bytes, at most 16384");

    // The partner takes them one by one, and sends all the while.
    let receiving = async {
        // Each once: on a busy computer an acknowledgement may come too late, and all comes again.
        let mut received = BTreeSet::new();
        // On a busy computer the first one takes its time.
        let mut patience = Duration::from_secs(60);
        while let Ok(Ok(telegram)) = tokio::time::timeout(patience, scale.receive()).await {
            received.insert(telegram);
            patience = Duration::from_secs(5);
        }
        received.len()
    };
    let sending = async {
        for number in 0..100_u8 {
            scale.send(&[number]).await.unwrap();
        }
    };
    let flooding = async {
        for number in 0..FLOOD {
            let payload = format!(r#"{{"id": 1, "send_text": "{number}"}}"#);
            subscriber.publish(command, QoS::AtMostOnce, payload).await;
        }
    };
    let (received, (), ()) = tokio::join!(receiving, sending, flooding);
    let (mut telegrams, mut done, mut too_many) = (Vec::new(), 0, 0);
    while telegrams.len() < 100 || done < received {
        let (topic, payload) = subscriber.next().await;
        let event: serde_json::Value = serde_json::from_slice(&payload).unwrap_or_default();
        if topic.ends_with("/telegram") {
            telegrams.push(event["hex"].as_str().unwrap().to_owned());
        } else if topic == outcome && event["ok"] == json!(true) {
            done += 1;
        } else if topic == outcome {
            assert_eq!(event["error"], "too many commands wait");
            too_many += 1;
        }
    }
    telegrams.dedup();
    let all: Vec<_> = (0..100).map(|number| format!("{number:02X}")).collect();
    assert_eq!(telegrams, all);
    assert!(
        too_many > 0 && done == received,
        "{too_many} {done} {received}"
    );
    gateway.logs("command refused: too many commands wait");
    gateway.ends();
}

#[tokio::test(flavor = "multi_thread")]
async fn connections_beyond_what_the_system_allows() {
    /// What the gateway has open by itself is about half of it.
    const FILES: u32 = 24;
    /// In a second, where one attempt every 0.1 s is logged.
    const MOST_LOGGED: usize = 50;
    let partner = Partner::new().await;
    let [port, metrics] = free_ports();
    let gateway = Gateway::start_with_files(
        FILES,
        &format!(
            "name = \"hall\"\n[tcp]\nlisten = \"127.0.0.1:{port}\"\n[metrics]\nlisten = \"127.0.0.1:{metrics}\"\n{}",
            line("scale", partner.port)
        ),
    );
    let scale = partner.link().await;
    let mut connections = Vec::new();
    for _ in 0..FILES {
        connections.push(TcpStream::connect(("127.0.0.1", port)).await.unwrap());
    }
    let error = "tcp: Too many open files";
    gateway.logs(error);
    scale.send(b"still here").await.unwrap();
    tokio::time::sleep(Duration::from_secs(1)).await;
    let logged = gateway.log().matches(error).count();
    assert!(logged < MOST_LOGGED, "{logged}");
    drop(connections);
    let received = "line3964r_line_received_total{line=\"scale\"}";
    let received = spawn_blocking(move || metric(metrics, received)).await;
    assert_eq!(received.unwrap(), 1);
}
