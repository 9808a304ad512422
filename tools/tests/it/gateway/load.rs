//! Many lines, a broker that comes and goes, noise.

use alloc::{collections::BTreeMap, sync::Arc};
use core::{
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};
use std::env;

use proto3964r::tokio::{Link, SendError};
use rumqttc::v5::mqttbytes::QoS;
use serde_json::Value;
use tempfile::TempDir;
use tokio::{net::TcpListener, task::JoinSet, time::sleep};

use super::{
    broker_or_skip,
    noise::Noise,
    partner::PARTNER,
    process::{Gateway, line, mqtt},
    subscriber::Subscriber,
    uart::{Pace, Uart},
};

const LINES: usize = 20;
/// Times that the broker is stopped, at least.
const STOPS: u32 = 4;
/// Lines whose bytes are damaged, one in this number.
const NOISY: usize = 4;
const NOISE: Noise = Noise {
    flipped: 2000,
    lost: 0,
    cut: 0,
};

/// Telegrams of all lines.
fn telegrams() -> usize {
    let number = env::var("GATEWAY_TELEGRAMS").map(|number| number.parse().unwrap());
    number.unwrap_or(10_000)
}

/// Sends telegrams with their numbers, each until it is acknowledged.
async fn send_all(link: &Link, count: u32) {
    for number in 0..count {
        let mut telegram = number.to_be_bytes().to_vec();
        telegram.extend(
            [0x10, 0x03, 0x02, 0xFF]
                .iter()
                .cycle()
                .take(number as usize % 20),
        );
        loop {
            match link.send(&telegram).await {
                Ok(()) => break,
                Err(SendError::Failed(_)) => {}
                Err(error) => panic!("{error}"),
            }
        }
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn nothing_is_lost_while_the_broker_stops_and_starts() {
    broker_stops_and_starts("5").await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn nothing_is_lost_over_3_1_1_while_the_broker_stops_and_starts() {
    broker_stops_and_starts("3.1.1").await;
}

async fn broker_stops_and_starts(protocol: &str) {
    let mut broker = broker_or_skip!();
    let count = u32::try_from(telegrams() / LINES).unwrap();
    let mqtt = mqtt(broker.port);
    let mut config = format!("name = \"hall\"\nstop_s = 60\n{mqtt}protocol = \"{protocol}\"\n");
    let mut partners = Vec::new();
    for index in 0..LINES {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        config += &line(&format!("line{index}"), port);
        let seed = u32::try_from(index).unwrap() + 1;
        partners.push(tokio::spawn(async move {
            let (stream, _) = listener.accept().await.unwrap();
            stream.set_nodelay(true).unwrap();
            let link = if index % NOISY == 0 {
                NOISE.link(stream, seed)
            } else {
                Link::new(stream, PARTNER)
            };
            send_all(&link, count).await;
            link
        }));
    }
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);

    let is_over = Arc::new(AtomicBool::new(false));
    let seen_over = Arc::clone(&is_over);
    let stops = tokio::spawn(async move {
        for stop in 1.. {
            sleep(Duration::from_millis(700)).await;
            broker.stop();
            sleep(Duration::from_millis(300)).await;
            broker.start_again();
            if stop >= STOPS && seen_over.load(Ordering::Relaxed) {
                println!("the broker was stopped {stop} times");
                break;
            }
        }
        broker
    });
    let mut heard = Heard::default();
    while !heard.is_all(LINES, count) {
        heard.take(&subscriber.next().await);
    }
    let mut links = Vec::new();
    for partner in partners {
        links.push(partner.await.unwrap());
    }
    is_over.store(true, Ordering::Relaxed);
    let _broker = stops.await.unwrap();
    gateway.ends();
    heard.assert_complete(count);
}

/// What came of a serial port, through both ends of a pseudo-terminal, while the broker stops and
/// starts, and commands go the other way.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn serial_lines_lose_nothing_in_both_directions() {
    const LINES: usize = 16;
    const TELEGRAMS: u32 = 40;
    const COMMANDS: u8 = 8;
    let mut broker = broker_or_skip!();
    let folder = TempDir::new().unwrap();
    let mut config = format!(
        "name = \"hall\"\nstop_s = 60\n{}command_max_age_s = 60\n",
        mqtt(broker.port)
    );
    let mut uarts = Vec::new();
    for index in 0..LINES {
        let name = format!("line{index}");
        let every = Duration::from_millis(if index % 2 == 0 { 1 } else { 16 });
        let baud = 115_200;
        let uart = Uart::new(&folder.path().join(&name), Pace { baud, every }).await;
        config += &uart.line(&name);
        uarts.push(uart);
    }
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let mut partners = JoinSet::new();
    for uart in uarts {
        gateway.logs(&format!("{} is open", uart.address));
        partners.spawn(async move {
            let receiving = async {
                for number in 0..COMMANDS {
                    let command = uart.link.receive().await.unwrap();
                    assert_eq!(command, [0xFF, number]);
                }
            };
            tokio::join!(send_all(&uart.link, TELEGRAMS), receiving);
        });
    }
    let mut heard = Heard::default();
    heard.take(&subscriber.next().await);
    broker.stop();
    sleep(Duration::from_millis(300)).await;
    broker.start_again();
    for number in 0..COMMANDS {
        for index in 0..LINES {
            let topic = format!("line3964r/hall/line{index}/command");
            let command = format!("{{\"id\": {number}, \"send\": \"FF {number:02X}\"}}");
            subscriber.publish(&topic, QoS::AtLeastOnce, command).await;
        }
    }
    let mut outcomes: BTreeMap<String, Vec<Value>> = BTreeMap::new();
    let are_all = |outcomes: &BTreeMap<_, Vec<_>>| {
        outcomes.values().map(Vec::len).sum::<usize>() == LINES * usize::from(COMMANDS)
    };
    while !heard.is_all(LINES, TELEGRAMS) || !are_all(&outcomes) {
        let message = subscriber.next().await;
        heard.take(&message);
        let (topic, payload) = message;
        if topic.ends_with("/outcome") {
            let outcome: Value = serde_json::from_slice(&payload).unwrap();
            assert_eq!(outcome["ok"], true, "{outcome}");
            let of_line = outcomes.entry(topic).or_default();
            // At least once.
            if of_line.last() != Some(&outcome["id"]) {
                of_line.push(outcome["id"].clone());
            }
        }
    }
    partners.join_all().await;
    gateway.ends();
    heard.assert_complete(TELEGRAMS);
    for of_line in outcomes.values() {
        assert!(
            of_line
                .iter()
                .map(Value::as_u64)
                .eq((0..COMMANDS).map(|id| Some(id.into())))
        );
    }
}

/// By line, the numbers of its telegrams by `seq`: what comes twice under one is one telegram.
#[derive(Default)]
struct Heard(BTreeMap<String, BTreeMap<u64, u32>>);

impl Heard {
    fn take(&mut self, (topic, payload): &(String, Vec<u8>)) {
        if !topic.ends_with("/telegram") {
            return;
        }
        let telegram: Value = serde_json::from_slice(payload).unwrap();
        let hex = telegram["hex"].as_str().unwrap().replace(' ', "");
        let number = u32::from_str_radix(&hex[..8], 16).unwrap();
        let line = telegram["line"].as_str().unwrap().to_owned();
        let of_line = self.0.entry(line).or_default();
        let known = of_line.insert(telegram["seq"].as_u64().unwrap(), number);
        assert!(known.is_none_or(|known| known == number));
    }

    /// Whether the last telegram of every line has come.
    fn is_all(&self, lines: usize, count: u32) -> bool {
        let is_full = |of_line: &&BTreeMap<_, u32>| of_line.values().any(|last| *last + 1 == count);
        self.0.values().filter(is_full).count() == lines
    }

    /// All numbers, in the order of their line, whatever the broker did; repeats of the line are
    /// neighbours.
    fn assert_complete(&self, count: u32) {
        for (line, of_line) in &self.0 {
            let mut numbers: Vec<_> = of_line.values().copied().collect();
            numbers.dedup();
            let other = (0..count).zip(&numbers).find(|(own, found)| own != *found);
            assert_eq!(
                (other, numbers.len()),
                (None, usize::try_from(count).unwrap()),
                "{line}"
            );
            let sequence = of_line.keys().copied();
            assert!(
                sequence.eq(1..=u64::try_from(of_line.len()).unwrap()),
                "{line}"
            );
        }
    }
}
