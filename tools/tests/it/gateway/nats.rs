//! NATS with `JetStream`: servers of the test's own, one or three, of which one is away now and
//! then.

use alloc::{collections::BTreeMap, sync::Arc};
use core::{
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};
use std::env;

use async_nats::{
    Client, ConnectOptions,
    jetstream::{
        self,
        consumer::pull::{Ordered, OrderedConfig},
    },
};
use futures_util::StreamExt as _;
use rk512::{Area, DataBlock, Memory, tokio::Client as Plc};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::{
    net::TcpListener,
    time::{Instant, sleep, timeout},
};

use super::{
    broker::{PASSWORD, USER},
    listeners::{free_ports, listen},
    nats_server::Cluster,
    partner::{PARTNER, Partner},
    process::{Gateway, PATIENCE, hall, line, metric, metrics},
};

/// One area of the partner, two of the gateway's own.
const AREAS: &str = "procedure = \"rk512\"
[[line.area]]
name = \"oven\"
start = \"DB 10.0\"
length = 1
[[line.area]]
name = \"orders\"
start = \"DB 20.0\"
length = 2
served = true
field = [{ name = \"pieces\", offset = 2, type = \"u16be\" }]
[[line.area]]
name = \"setpoints\"
start = \"DB 21.0\"
length = 1
served = true
writable = true
field = [{ name = \"speed\", offset = 0, type = \"i16be\" }]
";

/// Lines beside a cluster whose servers are killed.
const LINES: usize = 20;
/// Kills, one server after the other.
fn kills() -> usize {
    env::var("NATS_KILLS").map_or(3, |kills| kills.parse().unwrap())
}

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

/// A stream's number of messages, and where to read them.
async fn opened(client: &Client, stream: &str) -> Result<(u64, Ordered), async_nats::Error> {
    let mut stream = jetstream::new(client.clone()).get_stream(stream).await?;
    let count = stream.info().await?.state.messages;
    let consumer = stream.create_consumer(OrderedConfig::default()).await?;
    Ok((count, consumer.messages().await?))
}

/// All messages of a stream: subject, identifier, payload.
async fn all(client: &Client, stream: &str) -> Vec<(String, String, Value)> {
    let begin = Instant::now();
    let (count, mut messages) = loop {
        // Servers that have just been started look for a leader.
        match opened(client, stream).await {
            Ok(opened) => break opened,
            Err(error) => assert!(begin.elapsed() < PATIENCE, "{error}"),
        }
        sleep(Duration::from_millis(100)).await;
    };
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

/// As through MQTT: what the partner sends is told, what commands write it fetches, and each
/// command has its outcome.
#[tokio::test(flavor = "multi_thread")]
async fn areas_that_are_served_are_told_and_written() {
    let cluster = cluster_or_skip!(1);
    let partner = Partner::new().await;
    let folder = TempDir::new().unwrap();
    let store = format!("[store]\npath = \"{}\"\n", folder.path().display());
    let config = hall(&[&nats(&cluster), &store, &line("plc", partner.port), AREAS]);
    let gateway = Gateway::start(&config);
    gateway.logs("broker: connected to ");
    let db10 = Box::leak(vec![0, 7].into_boxed_slice());
    let stream = partner.stream().await;
    let memory = Memory::new([DataBlock::db(10, db10)]);
    let plc = Plc::with_source(stream, PARTNER, rk512::Config::DEFAULT, memory, |_| {});
    plc.send(Area::db(20, 0), &[0, 1, 0, 42]).await.unwrap();
    plc.send(Area::db(20, 1), &[0, 43]).await.unwrap();

    let client = client(&cluster).await;
    let ask = async |command: &'static str| -> Value {
        let request = client.request("line3964r.hall.plc.command", command.into());
        let answer = timeout(PATIENCE, request).await.expect("an answer");
        serde_json::from_slice(&answer.unwrap().payload).unwrap()
    };
    for (command, error) in [
        (
            r#"{"id": 1, "write": "setpoints", "fields": {"speed": -5}}"#,
            Value::Null,
        ),
        (r#"{"id": 2, "fetch": "orders"}"#, Value::Null),
        (r#"{"id": 3, "fetch": "oven"}"#, Value::Null),
        (
            r#"{"id": 4, "write": "orders", "hex": "00"}"#,
            json!("`orders` is not writable"),
        ),
    ] {
        let outcome = ask(command).await;
        assert_eq!(outcome["ok"], error.is_null(), "{command}: {outcome}");
        assert_eq!(outcome["error"], error, "{command}: {outcome}");
    }
    let fetched = plc.fetch(Area::db(21, 0), 1).await.unwrap();
    assert_eq!(fetched, (-5_i16).to_be_bytes());
    gateway.ends();

    // What it holds outlives the gateway.
    let gateway = Gateway::start(&config);
    let again = Plc::new(partner.stream().await, PARTNER, rk512::Config::DEFAULT);
    assert_eq!(
        again.fetch(Area::db(20, 0), 2).await.unwrap(),
        [0, 1, 0, 43]
    );
    gateway.ends();

    let (mut areas, mut outcomes) = (Vec::new(), Vec::new());
    for (subject, id, told) in all(&client, "line3964r").await {
        match subject.strip_prefix("line3964r.hall.plc.area.") {
            Some(area) => {
                let run = told["run"].as_str().unwrap();
                assert_eq!(id, format!("{run}.plc.{}", told["seq"]), "{told}");
                areas.push((area.to_owned(), told["hex"].as_str().unwrap().to_owned()));
            }
            None if subject == "line3964r.hall.plc.outcome" => outcomes.push(told["id"].clone()),
            None => panic!("{subject}: {told}"),
        }
    }
    let expected = [
        ("orders", "00 01 00 2A"),
        ("orders", "00 01 00 2B"),
        ("setpoints", "FF FB"),
        ("orders", "00 01 00 2B"),
        ("oven", "00 07"),
    ];
    let expected = expected.map(|(area, hex)| (area.to_owned(), hex.to_owned()));
    assert_eq!(areas, expected);
    assert_eq!(outcomes, [1, 2, 3, 4].map(Value::from));
}

/// A partner that numbers its telegrams, until it is over; how many it had acknowledged.
async fn send_numbers(listener: TcpListener, is_over: Arc<AtomicBool>) -> u32 {
    let (stream, _) = listener.accept().await.unwrap();
    stream.set_nodelay(true).unwrap();
    let link = proto3964r::tokio::Link::new(stream, PARTNER);
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
        let listener = listen();
        let port = listener.local_addr().unwrap().port();
        config += &line(&format!("line{index}"), port);
        partners.push(tokio::spawn(send_numbers(listener, Arc::clone(&is_over))));
    }
    let gateway = Gateway::start(&config);
    gateway.logs("broker: connected to ");
    for kill in 0..kills() {
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
        "{} telegrams, {} kills, {connects} connections of the gateway",
        sent.iter().sum::<u32>(),
        kills()
    );
}
