//! What was acknowledged to a partner reaches the broker: whoever is killed, and whatever is
//! refused.

use alloc::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};
use core::{
    sync::atomic::{AtomicBool, AtomicU32, Ordering},
    time::Duration,
};
use std::{env, fs, sync::OnceLock};

use proto3964r::{
    Cause,
    tokio::{Link, SendError},
};
use serde_json::Value;
use tempfile::TempDir;
use tokio::{
    net::TcpListener,
    task::spawn_blocking,
    time::{Instant, sleep},
};

use super::{
    broker::Broker,
    broker_or_skip,
    listeners::{free_ports, listen},
    partner::{PARTNER, Partner},
    process::{Gateway, PATIENCE, hall, line, metric, mqtt},
    subscriber::Subscriber,
};

const LINES: usize = 20;

/// How many times the gateway is killed.
fn kills() -> u32 {
    env::var("GATEWAY_KILLS").map_or(20, |kills| kills.parse().unwrap())
}

/// A partner that sends numbers, each until it is acknowledged, to every gateway that connects.
async fn send_numbers(
    listener: TcpListener,
    is_over: Arc<AtomicBool>,
    sent: Arc<AtomicU32>,
) -> u32 {
    let mut number = 0_u32;
    loop {
        let (stream, _) = listener.accept().await.unwrap();
        stream.set_nodelay(true).unwrap();
        let link = Link::new(stream, PARTNER);
        loop {
            match link.send(&number.to_be_bytes()).await {
                Ok(()) => {
                    number += 1;
                    sent.fetch_add(1, Ordering::Relaxed);
                }
                Err(SendError::Failed(_)) => {}
                Err(_) => break,
            }
            if is_over.load(Ordering::Relaxed) {
                // Those before it.
                return number;
            }
        }
    }
}

/// What the broker was handed of one line: by number, the `seq`s that it came under.
#[derive(Default)]
struct Heard {
    lines: BTreeMap<String, BTreeMap<u32, BTreeSet<u64>>>,
    runs: BTreeSet<String>,
    /// More than once under the same number.
    published_twice: usize,
    /// Under another number, and marked.
    marked: usize,
}

impl Heard {
    fn take(&mut self, (topic, payload): &(String, Vec<u8>)) {
        if !topic.ends_with("/telegram") {
            return;
        }
        let telegram: Value = serde_json::from_slice(payload).unwrap();
        self.runs
            .insert(telegram["run"].as_str().unwrap().to_owned());
        let hex = telegram["hex"].as_str().unwrap().replace(' ', "");
        let number = u32::from_str_radix(&hex, 16).unwrap();
        let line = telegram["line"].as_str().unwrap().to_owned();
        let seqs = self
            .lines
            .entry(line)
            .or_default()
            .entry(number)
            .or_default();
        let is_known = !seqs.is_empty();
        if !seqs.insert(telegram["seq"].as_u64().unwrap()) {
            self.published_twice += 1;
        } else if is_known {
            assert_eq!(telegram["possible_repeat"], true, "{telegram}");
            self.marked += 1;
        }
    }

    /// How many were acknowledged and have not come.
    fn lost(&self, acknowledged: &[u32]) -> usize {
        let of_lines = (0..LINES).zip(acknowledged).map(|(index, &count)| {
            let of_line = self.lines.get(&format!("line{index}"));
            let came = of_line.map_or(0, |of_line| of_line.range(..count).count());
            count as usize - came
        });
        of_lines.sum()
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_killed_gateway_loses_nothing_that_it_acknowledged() {
    let broker = broker_or_skip!();
    let folder = TempDir::new().unwrap();
    let store = folder.path().display();
    let mut config = format!(
        "name = \"hall\"\n{}protocol = \"5\"\n[store]\npath = \"{store}\"\n",
        mqtt(broker.port)
    );
    let (is_over, sent) = (
        Arc::new(AtomicBool::new(false)),
        Arc::new(AtomicU32::new(0)),
    );
    let mut partners = Vec::new();
    for index in 0..LINES {
        let listener = listen();
        let port = listener.local_addr().unwrap().port();
        config += &line(&format!("line{index}"), port);
        let sending = send_numbers(listener, Arc::clone(&is_over), Arc::clone(&sent));
        partners.push(tokio::spawn(sending));
    }
    let mut subscriber = Subscriber::new(broker.port).await;
    let acknowledged = Arc::new(OnceLock::<Vec<u32>>::new());
    let due = Arc::clone(&acknowledged);
    let hearing = tokio::spawn(async move {
        let (mut heard, mut silent_s) = (Heard::default(), 0);
        loop {
            match subscriber.next_within(Duration::from_secs(1)).await {
                Some(message) => {
                    heard.take(&message);
                    silent_s = 0;
                }
                None => silent_s += 1,
            }
            // A repeat may follow, and what has not come for long is lost.
            if let Some(due) = due.get()
                && silent_s > 0
                && (silent_s >= 10 || heard.lost(due) == 0)
            {
                return heard;
            }
        }
    });
    let mut random = 0x2545_F491_u32;
    for kill in 0..kills() {
        let gateway = Gateway::start(&config);
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        // Half of them while the broker hangs.
        let hangs = kill % 2 == 1;
        sleep(Duration::from_millis(150 + u64::from(random % 300))).await;
        if hangs {
            broker.hang();
            sleep(Duration::from_millis(100)).await;
        }
        drop(gateway); // SIGKILL
        if hangs {
            broker.go_on();
        }
    }
    let gateway = Gateway::start(&config);
    gateway.logs("broker: connected");
    let before = sent.load(Ordering::Relaxed);
    let begin = Instant::now();
    while sent.load(Ordering::Relaxed) < before + u32::try_from(LINES).unwrap() {
        assert!(begin.elapsed() < PATIENCE, "{}", gateway.log());
        sleep(Duration::from_millis(10)).await;
    }
    is_over.store(true, Ordering::Relaxed);
    let mut counts = Vec::new();
    for partner in partners {
        counts.push(partner.await.unwrap());
    }
    let acknowledged = acknowledged.get_or_init(|| counts);
    let heard = hearing.await.unwrap();
    gateway.ends();
    println!(
        "{} telegrams, {} kills: {} published twice, {} marked as possible repeats",
        acknowledged.iter().sum::<u32>(),
        kills(),
        heard.published_twice,
        heard.marked
    );
    assert_eq!(heard.lost(acknowledged), 0, "lost");
    assert_eq!(heard.runs.len(), 1, "one store, one run");
}

/// A broker that takes no telegrams of one line, and says so.
#[tokio::test(flavor = "multi_thread")]
async fn what_the_broker_may_not_take_is_a_dead_letter_and_no_success() {
    let acl = "user plant\ntopic readwrite line3964r/hall/+/status\ntopic readwrite line3964r/hall/good/health\ntopic readwrite line3964r/hall/status\n\
               topic readwrite line3964r/hall/good/#\ntopic read line3964r/#\ntopic read homeassistant/#\n";
    let Some(broker) = Broker::start_with("max_packet_size 2000\n", Some(acl)) else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let (good, bad) = (Partner::new().await, Partner::new().await);
    let [port] = free_ports();
    let config = format!(
        "name = \"hall\"\n{}[store]\npath = \"{}\"\n[metrics]\nlisten = \"127.0.0.1:{port}\"\n{}{}",
        mqtt(broker.port),
        folder.path().display(),
        line("good", good.port),
        line("bad", bad.port)
    );
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let (good, bad) = (good.link().await, bad.link().await);
    bad.send(b"forbidden").await.unwrap();
    good.send(&[0; 1500]).await.unwrap();
    good.send(b"fine").await.unwrap();
    let telegram = subscriber.json_at("line3964r/hall/good/telegram").await;
    assert_eq!(telegram["hex"], "66 69 6E 65");
    // By its answer, or by the end of the connection that mosquitto 2.0.11 makes of it.
    gateway.logs("refused a message to line3964r/hall/bad/telegram: ");
    let read = move |name: &'static str| spawn_blocking(move || metric(port, name));
    for name in [
        "line3964r_line_dead_letters_total{line=\"bad\"}",
        "line3964r_line_dead_letters_total{line=\"good\"}",
    ] {
        assert_eq!(read(name).await.unwrap(), 1, "{name}");
    }
    let (status, log) = gateway.stop();
    assert_eq!(status.code(), Some(1), "{log}");
    assert!(log.contains("2 messages that the broker refused"), "{log}");
    let letters = fs::read_to_string(folder.path().join("dead-letters.jsonl")).unwrap();
    let mut letters = letters.lines().map(|letter| -> Value {
        let letter: Value = serde_json::from_str(letter).unwrap();
        serde_json::from_str(letter["payload"].as_str().unwrap()).unwrap()
    });
    let hex: BTreeSet<_> = letters
        .by_ref()
        .map(|letter| letter["hex"].to_string().len())
        .collect();
    // In hexadecimal, with spaces and quotation marks.
    assert_eq!(hex, BTreeSet::from([9 * 3 + 1, 1500 * 3 + 1]));
}

/// There is no room: NAK, until there is.
#[tokio::test(flavor = "multi_thread")]
async fn a_full_store_is_nak_and_no_lie() {
    let mut broker = broker_or_skip!();
    let partner = Partner::new().await;
    let config = hall(&[
        &mqtt(broker.port),
        "[store]\nmax_bytes = 1000\n",
        &line("scale", partner.port),
    ]);
    // Before the gateway is there: what it delivers at once waits for this session.
    let mut subscriber = Subscriber::new(broker.port).await;
    broker.stop();
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    let mut taken = 0;
    let failure = loop {
        match scale.send(&[taken]).await {
            Ok(()) => taken += 1,
            Err(SendError::Failed(failure)) => break failure,
            Err(error) => panic!("{error}"),
        }
    };
    assert_eq!(failure.cause, Cause::Nak);
    assert!((2..20).contains(&taken), "{taken}");
    gateway.logs("scale: not stored: the store is full");
    broker.start_again();
    // As soon as the broker has the first of them.
    while scale.send(&[taken]).await.is_err() {}
    for number in 0..=taken {
        let telegram = subscriber.json_at("line3964r/hall/scale/telegram").await;
        assert_eq!(telegram["hex"], format!("{number:02X}"));
        // The number of one that was refused was kept for it.
        assert_eq!(telegram["seq"], u64::from(number) + 1);
    }
    gateway.ends();
}

/// In memory, the gateway says at the start and at the end what that costs.
#[tokio::test(flavor = "multi_thread")]
async fn without_a_store_what_waits_is_said_to_be_lost() {
    let mut broker = broker_or_skip!();
    let partner = Partner::new().await;
    let config = format!(
        "name = \"hall\"\nstop_s = 0.5\n{}[store]\nsync = \"none\"\n{}",
        mqtt(broker.port),
        line("scale", partner.port)
    );
    broker.stop();
    let gateway = Gateway::start(&config);
    gateway.logs("messages are kept in memory, 10000 at most");
    let scale = partner.link().await;
    scale.send(b"A").await.unwrap();
    let (status, log) = gateway.stop();
    assert_eq!(status.code(), Some(1), "{log}");
    assert!(log.contains("1 messages were not delivered"), "{log}");
}
