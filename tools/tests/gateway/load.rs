//! Many lines, a broker that comes and goes, noise.

use alloc::collections::BTreeMap;
use core::time::Duration;
use std::env;

use proto3964r::tokio::{Link, SendError};
use serde_json::Value;
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _, duplex, split},
    net::TcpListener,
    time::sleep,
};

use super::{
    broker_or_skip,
    gateway::{Gateway, line, mqtt},
    partner::PARTNER,
    subscriber::Subscriber,
};

const LINES: usize = 20;
/// Lines whose bytes are damaged, one in this number.
const NOISY: usize = 4;
const ONE_BYTE_IN: u32 = 2000;

/// Telegrams of all lines.
fn telegrams() -> usize {
    let number = env::var("GATEWAY_TELEGRAMS").map(|number| number.parse().unwrap());
    number.unwrap_or(10_000)
}

/// A partner whose line is damaged on the way: one bit of a byte now and then.
async fn noisy_link(listener: &TcpListener, mut random: u32) -> Link {
    let (stream, _) = listener.accept().await.unwrap();
    stream.set_nodelay(true).unwrap();
    let (here, there) = duplex(4096);
    let (from_gateway, to_gateway) = stream.into_split();
    let (from_partner, to_partner) = split(there);
    let mut next = move || {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        random
    };
    let seed = next();
    tokio::spawn(damage(from_gateway, to_partner, seed));
    tokio::spawn(damage(from_partner, to_gateway, seed ^ 0x5555_5555));
    Link::new(here, PARTNER)
}

async fn damage(
    mut from: impl tokio::io::AsyncRead + Unpin,
    mut to: impl tokio::io::AsyncWrite + Unpin,
    mut random: u32,
) {
    let mut piece = [0; 256];
    while let Ok(len @ 1..) = from.read(&mut piece).await {
        for byte in &mut piece[..len] {
            random ^= random << 13;
            random ^= random >> 17;
            random ^= random << 5;
            if random.is_multiple_of(ONE_BYTE_IN) {
                *byte ^= 1 << (random >> 29);
            }
        }
        if to.write_all(&piece[..len]).await.is_err() {
            return;
        }
    }
}

/// Sends telegrams with their numbers, each until it is acknowledged.
async fn send_all(link: Link, count: u32) -> Link {
    for number in 0..count {
        let mut telegram = number.to_be_bytes().to_vec();
        telegram.extend([0x10, 0x03, 0x02].iter().cycle().take(number as usize % 20));
        loop {
            match link.send(&telegram).await {
                Ok(()) => break,
                Err(SendError::Failed(_)) => {}
                Err(error) => panic!("{error}"),
            }
        }
    }
    link
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn nothing_is_lost_while_the_broker_stops_and_starts() {
    let mut broker = broker_or_skip!();
    let count = u32::try_from(telegrams() / LINES).unwrap();
    let mut config = format!("name = \"hall\"\nstop_s = 60\n{}", mqtt(broker.port));
    let mut partners = Vec::new();
    for index in 0..LINES {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        config += &line(&format!("line{index}"), port);
        let seed = u32::try_from(index).unwrap() + 1;
        partners.push(tokio::spawn(async move {
            let link = if index % NOISY == 0 {
                noisy_link(&listener, seed).await
            } else {
                let (stream, _) = listener.accept().await.unwrap();
                stream.set_nodelay(true).unwrap();
                Link::new(stream, PARTNER)
            };
            send_all(link, count).await
        }));
    }
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);

    let stops = tokio::spawn(async move {
        for _ in 0..4 {
            sleep(Duration::from_millis(700)).await;
            broker.stop();
            sleep(Duration::from_millis(300)).await;
            broker.start_again();
        }
        broker
    });
    // By line, the numbers by `seq`: what comes twice under one is one telegram.
    let mut heard: BTreeMap<String, BTreeMap<u64, u32>> = BTreeMap::new();
    let is_all = |heard: &BTreeMap<String, BTreeMap<u64, u32>>| {
        let full = heard
            .values()
            .filter(|of_line| of_line.values().any(|last| *last + 1 == count));
        full.count() == LINES
    };
    while !is_all(&heard) {
        let (topic, payload) = subscriber.next().await;
        if topic.ends_with("/telegram") {
            let telegram: Value = serde_json::from_slice(&payload).unwrap();
            let hex = telegram["hex"].as_str().unwrap().replace(' ', "");
            let number = u32::from_str_radix(&hex[..8], 16).unwrap();
            let of_line = heard
                .entry(telegram["line"].as_str().unwrap().to_owned())
                .or_default();
            let known = of_line.insert(telegram["seq"].as_u64().unwrap(), number);
            assert!(known.is_none_or(|known| known == number));
        }
    }
    let mut links = Vec::new();
    for partner in partners {
        links.push(partner.await.unwrap());
    }
    let _broker = stops.await.unwrap();
    let (status, log) = gateway.stop();
    assert!(status.success(), "{log}");
    for (line, of_line) in &heard {
        // In the order of the line, whatever the broker did; repeats of the line are neighbours.
        let mut numbers: Vec<_> = of_line.values().copied().collect();
        numbers.dedup();
        assert!(numbers.into_iter().eq(0..count), "{line}");
        let sequence = of_line.keys().copied();
        assert!(
            sequence.eq(1..=u64::try_from(of_line.len()).unwrap()),
            "{line}"
        );
    }
}
