//! How the gateway finds its broker, and who takes its place there.

use core::time::Duration;

use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _, copy_bidirectional},
    net::{TcpListener, TcpStream},
    time::timeout,
};

use super::{
    broker_or_skip,
    listeners::listen,
    partner::Partner,
    process::{Gateway, line, mqtt},
    subscriber::Subscriber,
};

/// The broker behind an address of IPv6.
#[tokio::test(flavor = "multi_thread")]
async fn a_broker_on_ipv6() {
    let broker = broker_or_skip!();
    let Ok(listener) = TcpListener::bind("[::1]:0").await else {
        eprintln!("skipped: this machine has no IPv6");
        return;
    };
    let (front, port) = (listener.local_addr().unwrap(), broker.port);
    tokio::spawn(async move {
        while let Ok((mut client, _)) = listener.accept().await {
            let mut server = TcpStream::connect(("127.0.0.1", port)).await.unwrap();
            tokio::spawn(async move { copy_bidirectional(&mut client, &mut server).await.ok() });
        }
    });
    let mqtt = mqtt(port).replace(&format!("127.0.0.1:{port}"), &front.to_string());
    let partner = Partner::new().await;
    let mut subscriber = Subscriber::new(port).await;
    let line = line("scale", partner.port);
    let gateway = Gateway::start(&format!("name = \"hall\"\n{mqtt}{line}"));
    partner.link().await.send(b"A").await.unwrap();
    let telegram = subscriber.json_at("line3964r/hall/scale/telegram").await;
    assert_eq!(telegram["hex"], "41");
    gateway.ends();
}

/// A broker that says why it closes the connection.
#[tokio::test(flavor = "multi_thread")]
async fn a_stolen_identifier_is_named() {
    /// MQTT 5: the connection is accepted, and ended because another client has the identifier.
    const ANSWERS: [u8; 9] = [0x20, 3, 0, 0, 0, 0xE0, 2, 0x8E, 0];
    /// Far below the 15 s for which the thief is left alone.
    const PEACE: Duration = Duration::from_secs(2);
    let listener = listen();
    let port = listener.local_addr().unwrap().port();
    let partner = Partner::new().await;
    let line = line("scale", partner.port);
    let gateway = Gateway::start(&format!("name = \"hall\"\n{}{line}", mqtt(port)));
    let (mut client, _) = listener.accept().await.unwrap();
    assert_ne!(client.read(&mut [0; 512]).await.unwrap(), 0, "CONNECT");
    client.write_all(&ANSWERS).await.unwrap();
    gateway.logs("another client has taken the identifier `hall`");
    assert!(timeout(PEACE, listener.accept()).await.is_err());
}

/// Mosquitto 2.0 does not say why.
#[tokio::test(flavor = "multi_thread")]
async fn two_gateways_of_one_name_are_suspected() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let (mqtt, line) = (mqtt(broker.port), line("scale", partner.port));
    let config = format!("name = \"hall\"\n{mqtt}{line}");
    let first = Gateway::start(&config);
    first.logs("broker: connected");
    let _second = Gateway::start(&config);
    first.logs("has another client the identifier `hall`?");
}
