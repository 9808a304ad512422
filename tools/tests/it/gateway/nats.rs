//! NATS with `JetStream`: servers of the test's own, one or three, of which one is away now and then.

use alloc::{collections::BTreeMap, sync::Arc};
use core::{
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use async_nats::{
    Client, ConnectOptions,
    jetstream::{self, consumer::pull::OrderedConfig},
};
use futures_util::StreamExt as _;
use serde_json::Value;
use tempfile::TempDir;
use tokio::{
    net::TcpListener,
    time::{Instant, sleep, timeout},
};

use super::{
    broker::{PASSWORD, USER},
    nats_server::Cluster,
    partner::Partner,
    process::{Gateway, PATIENCE, hall, line, metric, metrics},
};
use crate::gateway::broker::free_ports;

/// Lines beside a cluster whose servers are killed.
const LINES: usize = 20;
/// Kills, one server after the other.
const KILLS: usize = 6;

/// A cluster, or an end of the test that is seen.
macro_rules! cluster_or_skip {
    ($servers:expr) => {
        match Cluster::start($servers, "").await {
            Some(cluster) => cluster,
            None => return,
        }
    };
}

fn nats(cluster: &Cluster) -> String {
    let (servers, replicas) = (cluster.servers(), cluster.len());
    format!(
        "[nats]\nservers = {servers:?}\nuser = \"{USER}\"\npassword = \"{PASSWORD}\"\nreplicas = {replicas}\n"
    )
}

async fn client(cluster: &Cluster) -> Client {
    let options = ConnectOptions::with_user_and_password(USER.to_owned(), PASSWORD.to_owned());
    let options = options.retry_on_initial_connect();
    options.connect(cluster.servers()).await.unwrap()
}

/// All messages of a stream: subject, identifier, payload.
async fn all(client: &Client, stream: &str) -> Vec<(String, String, Value)> {
    let context = jetstream::new(client.clone());
    let begin = Instant::now();
    let mut stream = loop {
        match context.get_stream(stream).await {
            Ok(stream) => break stream,
            Err(error) => assert!(begin.elapsed() < PATIENCE, "{error}"),
        }
        sleep(Duration::from_millis(100)).await;
    };
    let count = stream.info().await.unwrap().state.messages;
    let consumer = stream.create_consumer(OrderedConfig::default()).await;
    let mut messages = consumer.unwrap().messages().await.unwrap();
    let mut found = Vec::new();
    for _ in 0..count {
        let message = timeout(PATIENCE, messages.next()).await.expect("a message");
        let message = message.unwrap().unwrap();
        let headers = message.headers.as_ref();
        let id = headers.and_then(|headers| headers.get(async_nats::header::NATS_MESSAGE_ID));
        let id = id.map_or(String::new(), ToString::to_string);
        let payload = serde_json::from_slice(&message.payload).unwrap_or_default();
        found.push((message.subject.to_string(), id, payload));
    }
    found
}

#[tokio::test(flavor = "multi_thread")]
async fn telegrams_and_states_are_kept_and_requests_are_answered() {
    let cluster = cluster_or_skip!(1);
    let partner = Partner::new().await;
    let [port] = free_ports();
    let line = line("scale", partner.port);
    let config = hall(&[&nats(&cluster), &metrics(port), &line]);
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    gateway.logs("broker: connected to ");
    for number in 0..10 {
        scale.send(&[number]).await.unwrap();
    }
    let client = client(&cluster).await;
    let command = "line3964r.hall.scale.command";
    let asking = timeout(
        PATIENCE,
        client.request(command, r#"{"id": 7, "send": "41"}"#.into()),
    );
    let (answer, heard) = tokio::join!(asking, scale.receive());
    assert_eq!(heard.unwrap(), b"A");
    let outcome: Value = serde_json::from_slice(&answer.unwrap().unwrap().payload).unwrap();
    assert_eq!((&outcome["id"], &outcome["ok"]), (&7.into(), &true.into()));
    // Too large for the server: a dead letter, and what comes after it goes on.
    scale.send(&[0x41; 1500]).await.unwrap();
    scale.send(b"last").await.unwrap();
    gateway.logs("refused a message to line3964r/hall/scale/telegram: max payload size exceeded");
    let read = tokio::task::spawn_blocking(move || metric(port, "line3964r_nats_connected"));
    assert_eq!(read.await.unwrap(), 1);
    let (status, log) = gateway.stop();
    assert_eq!(status.code(), Some(1), "a dead letter:\n{log}");

    let messages = all(&client, "line3964r").await;
    let (outcomes, telegrams): (Vec<_>, Vec<_>) = messages
        .into_iter()
        .partition(|(subject, ..)| subject.ends_with("outcome"));
    assert_eq!(outcomes.len(), 1);
    assert_eq!(telegrams.len(), 11);
    for (number, (subject, id, telegram)) in (0_u64..).zip(&telegrams) {
        assert_eq!(subject, "line3964r.hall.scale.telegram");
        let (run, seq) = (telegram["run"].as_str().unwrap(), &telegram["seq"]);
        assert_eq!(*id, format!("{run}.scale.{seq}"));
        if number < 10 {
            assert_eq!(telegram["hex"], format!("{number:02X}"));
        }
    }
    let states = all(&client, "line3964r_state").await;
    let subjects: Vec<_> = states.iter().map(|(subject, ..)| &subject[..]).collect();
    for subject in ["line3964r.hall.status", "line3964r.hall.scale.status"] {
        let count = subjects.iter().filter(|it| **it == subject).count();
        assert_eq!(count, 1, "the last of each: {subjects:?}");
    }
}

/// A partner that numbers its telegrams, until it is over; how many it had acknowledged.
async fn send_numbers(listener: TcpListener, is_over: Arc<AtomicBool>) -> u32 {
    let (stream, _) = listener.accept().await.unwrap();
    stream.set_nodelay(true).unwrap();
    let link = proto3964r::tokio::Link::new(stream, super::partner::PARTNER);
    let mut number = 0_u32;
    while !is_over.load(Ordering::Relaxed) {
        // One that the gateway cannot keep in time is refused, and sent again.
        if link.send(&number.to_be_bytes()).await.is_ok() {
            number += 1;
        }
        sleep(Duration::from_millis(20)).await;
    }
    number
}

/// None lost, none twice, all in order: by the stream itself.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn servers_that_are_killed_in_turn_lose_and_double_nothing() {
    let mut cluster = cluster_or_skip!(3);
    let folder = TempDir::new().unwrap();
    let mut config = format!(
        "name = \"hall\"\nstop_s = 120\n{}[store]\npath = \"{}\"\n",
        nats(&cluster),
        folder.path().display()
    );
    let is_over = Arc::new(AtomicBool::new(false));
    let mut partners = Vec::new();
    for index in 0..LINES {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        config += &line(&format!("line{index}"), port);
        partners.push(tokio::spawn(send_numbers(listener, Arc::clone(&is_over))));
    }
    let gateway = Gateway::start(&config);
    gateway.logs("broker: connected to ");
    for kill in 0..KILLS {
        sleep(Duration::from_millis(1500)).await;
        // The next one is killed when this one has caught up: two of three are a majority.
        cluster.kill(kill % 3);
        sleep(Duration::from_millis(1500)).await;
        cluster.start_again(kill % 3).await;
    }
    is_over.store(true, Ordering::Relaxed);
    let mut sent = Vec::new();
    for partner in partners {
        sent.push(partner.await.unwrap());
    }
    let log = gateway.ends();

    let client = client(&cluster).await;
    let mut heard: BTreeMap<String, Vec<(u64, u32)>> = BTreeMap::new();
    for (subject, _, telegram) in all(&client, "line3964r").await {
        let line = subject.split('.').nth(2).unwrap().to_owned();
        let hex = telegram["hex"].as_str().unwrap().replace(' ', "");
        let number = u32::from_str_radix(&hex, 16).unwrap();
        let seq = telegram["seq"].as_u64().unwrap();
        heard.entry(line).or_default().push((seq, number));
    }
    for (index, sent) in sent.iter().enumerate() {
        let of_line = &heard[&format!("line{index}")];
        let seqs = of_line.iter().map(|(seq, _)| *seq);
        assert!(
            seqs.eq(1..=u64::try_from(of_line.len()).unwrap()),
            "line{index}: {of_line:?}"
        );
        // A telegram whose acknowledgement was late comes under two numbers.
        let mut numbers: Vec<_> = of_line.iter().map(|(_, number)| *number).collect();
        numbers.dedup();
        let count = u32::try_from(numbers.len()).unwrap();
        assert!(numbers.into_iter().eq(0..count), "line{index}");
        assert!(count >= *sent, "line{index}: {sent} sent");
    }
    let connects = log.matches("broker: connected to ").count();
    println!(
        "{} telegrams, {KILLS} kills, {connects} connections of the gateway",
        sent.iter().sum::<u32>()
    );
}
