//! A bad line is seen from outside.

use core::time::Duration;

use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _},
    net::TcpStream,
    task::spawn_blocking,
};

use super::{
    broker_or_skip,
    listeners::{free_ports, listen},
    partner::Partner,
    process::{Gateway, hall, line, metric, metrics, mqtt},
    subscriber::Subscriber,
};

const STX: u8 = 0x02;
const DLE: u8 = 0x10;
const NAK: u8 = 0x15;

/// Every second block of a partner has a wrong BCC.
#[tokio::test(flavor = "multi_thread")]
async fn blocks_that_are_answered_nak_are_counted_by_their_cause() {
    const BLOCKS: u64 = 10;
    let broker = broker_or_skip!();
    let listener = listen();
    let [port] = free_ports();
    let line = line("scale", listener.local_addr().unwrap().port());
    let config = hall(&[&mqtt(broker.port), &metrics(port), &line]);
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let (mut scale, _) = listener.accept().await.unwrap();
    assert_eq!(scale.read_u8().await.unwrap(), NAK, "at the start");
    for number in 0..u8::try_from(BLOCKS).unwrap() {
        for (damage, answer) in [(1, NAK), (0, DLE)] {
            scale.write_u8(STX).await.unwrap();
            assert_eq!(scale.read_u8().await.unwrap(), DLE);
            let letter = 0x41 + number;
            let bcc = letter ^ 0x10 ^ 0x03 ^ damage;
            scale.write_all(&[letter, 0x10, 0x03, bcc]).await.unwrap();
            assert_eq!(scale.read_u8().await.unwrap(), answer);
        }
    }
    let name = "line3964r_line_faults_total{line=\"scale\",fault=\"bcc\"}";
    let counted = spawn_blocking(move || metric(port, name)).await.unwrap();
    assert_eq!(counted, BLOCKS);
    loop {
        let health = subscriber.json_at("line3964r/hall/scale/health").await;
        if health["received"] == BLOCKS {
            assert_eq!(health["faults"]["bcc"], BLOCKS);
            assert_eq!(health["last_fault"]["fault"], "bcc");
            let text = health["last_fault"]["text"].as_str().unwrap();
            assert!(text.starts_with("rejected: "), "{text}");
            break;
        }
    }
    gateway.ends();
}

/// Who connects to the metrics and asks nothing takes no more than a few files.
#[tokio::test(flavor = "multi_thread")]
async fn clients_of_the_metrics_do_not_take_the_files_of_lines() {
    /// What the gateway has open by itself is about half of it.
    const FILES: u32 = 32;
    let partner = Partner::new().await;
    let [port] = free_ports();
    let tcp = "[tcp]\nlisten = \"127.0.0.1:0\"\n";
    let config = hall(&[tcp, &metrics(port), &line("scale", partner.port)]);
    let gateway = Gateway::start_with_files(FILES, &config);
    drop(partner.link().await);
    let mut clients = Vec::new();
    for _ in 0..2 * FILES {
        clients.push(TcpStream::connect(("127.0.0.1", port)).await.unwrap());
    }
    // The line is opened again all the same.
    let opened = tokio::time::timeout(Duration::from_secs(20), partner.link()).await;
    let scale = opened.unwrap_or_else(|_| panic!("not opened:\n{}", gateway.log()));
    scale.send(b"A").await.unwrap();
    drop(clients);
    let name = "line3964r_line_received_total{line=\"scale\"}";
    let received = spawn_blocking(move || metric(port, name)).await.unwrap();
    assert_eq!(received, 1);
    let log = gateway.ends();
    assert!(!log.contains("Too many"), "{log}");
}
