//! A day's worth of load, by hand: memory, disk, losses and duplicates for
//! docs/book/src/fleet.md.
//!
//! `cargo test --release -p line3964r --test it gateway::day -- --ignored --nocapture`

use alloc::sync::Arc;
use core::{
    str,
    sync::atomic::{AtomicBool, AtomicU32, Ordering},
    time::Duration,
};
use std::{env, fs, path::Path};

use proto3964r::tokio::SendError;
use serde::Deserialize;
use tempfile::TempDir;
use tokio::{
    net::TcpListener,
    sync::mpsc,
    time::{Instant, sleep},
};

use super::{
    broker::Broker,
    listeners::listen,
    noise::{Noise, Random},
    process::{Gateway, line, mqtt},
    subscriber::Subscriber,
};

/// From one row of the table to the next.
const ROW: Duration = Duration::from_secs(30);
/// From one thing that happens to the broker or the gateway to the next, at most.
const CALM_MS: u32 = 20_000;

fn number(name: &str, default: u32) -> u32 {
    env::var(name).map_or(default, |number| number.parse().unwrap())
}

/// What all partners share.
struct Load {
    /// Telegrams that have been acknowledged to partners.
    sent: AtomicU32,
    failed: AtomicU32,
    is_over: AtomicBool,
}

/// The number and what confirms it: BCC does not see two bits that hide each other.
fn telegram(number: u32) -> [u8; 8] {
    let check = number.wrapping_mul(0x9E37_79B1) ^ 0x5A5A_A5A5;
    let both = u64::from(number) << 32 | u64::from(check);
    both.to_be_bytes()
}

fn number_of(hex: &str) -> Option<u32> {
    let bytes = hex.split(' ').map(|byte| u8::from_str_radix(byte, 16));
    let bytes: Vec<_> = bytes.collect::<Result<_, _>>().unwrap();
    let (first, _) = bytes.split_first_chunk()?;
    let number = u32::from_be_bytes(*first);
    (telegram(number) == *bytes).then_some(number)
}

/// Faults of a line as they are drawn: half of the lines have none.
fn draw(random: &mut Random) -> Noise {
    let mut one_in = |least: u32| match random.draw() % 6 {
        0 => least * (1 + random.draw() % 10),
        _ => 0,
    };
    Noise {
        flipped: one_in(2_000),
        lost: one_in(2_000),
        cut: one_in(20_000),
    }
}

/// Sends numbers, each until it is acknowledged, to whoever connects, over lines whose faults are
/// drawn anew with each connection. How many there were.
async fn send_numbers(listener: TcpListener, load: Arc<Load>, seed: u32) -> u32 {
    let mut random = Random(seed);
    let mut number = 0;
    loop {
        let (stream, _) = listener.accept().await.unwrap();
        stream.set_nodelay(true).unwrap();
        let noise = draw(&mut random);
        let link = noise.link(stream, random.draw());
        while !load.is_over.load(Ordering::Relaxed) {
            match link.send(&telegram(number)).await {
                Ok(()) => {
                    number += 1;
                    load.sent.fetch_add(1, Ordering::Relaxed);
                }
                Err(SendError::Failed(_)) => drop(load.failed.fetch_add(1, Ordering::Relaxed)),
                Err(_) => break,
            }
        }
        if load.is_over.load(Ordering::Relaxed) {
            return number;
        }
    }
}

/// What is read of a telegram.
#[derive(Deserialize)]
struct Told<'t> {
    run: &'t str,
    seq: usize,
    hex: &'t str,
    #[serde(default)]
    possible_repeat: bool,
}

/// What came of one line under a `seq`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Came {
    Nothing,
    Number {
        number: u32,
        is_marked: bool,
    },
    /// What BCC took for right.
    Damaged,
}

#[derive(Default)]
struct Heard {
    /// By line and `seq`.
    lines: Vec<Vec<Came>>,
    run: Option<String>,
    messages: u64,
    /// More than once under the same number.
    published_twice: u64,
}

/// What a line has in the end.
#[derive(Default)]
struct Tally {
    lost: u32,
    /// Came again on the line, under a number of its own, and marked.
    marked: u32,
    unmarked: u32,
    damaged: u32,
    misplaced: u32,
}

impl Heard {
    fn take(&mut self, topic: &str, payload: &[u8]) {
        let Some(line) = topic
            .strip_prefix("line3964r/hall/line")
            .and_then(|rest| rest.strip_suffix("/telegram"))
        else {
            return;
        };
        let told: Told<'_> = serde_json::from_slice(payload).unwrap();
        let run = self.run.get_or_insert_with(|| told.run.to_owned());
        assert_eq!(run, told.run, "one store, one run");
        self.messages += 1;
        let line: usize = line.parse().unwrap();
        if self.lines.len() <= line {
            self.lines.resize(line + 1, Vec::new());
        }
        let of_line = &mut self.lines[line];
        if of_line.len() < told.seq {
            of_line.resize(told.seq, Came::Nothing);
        }
        let came = number_of(told.hex).map_or(Came::Damaged, |number| Came::Number {
            number,
            is_marked: told.possible_repeat,
        });
        let place = &mut of_line[told.seq - 1];
        if *place != Came::Nothing {
            assert!(
                *place == came,
                "line {line}: two telegrams under {}",
                told.seq
            );
            self.published_twice += 1;
        }
        *place = came;
    }

    fn tally(&self, line: usize, acknowledged: u32) -> Tally {
        let mut tally = Tally::default();
        let mut next = 0;
        for came in self.lines.get(line).into_iter().flatten() {
            match *came {
                Came::Nothing => tally.lost += 1,
                Came::Damaged => tally.damaged += 1,
                Came::Number { number, .. } if number == next => next += 1,
                // In place of the one before came what was damaged.
                Came::Number { number, .. } if number == next + 1 && tally.damaged > 0 => next += 2,
                Came::Number { number, is_marked } if number + 1 == next => {
                    tally.marked += u32::from(is_marked);
                    tally.unmarked += u32::from(!is_marked);
                }
                Came::Number { .. } => tally.misplaced += 1,
            }
        }
        tally.lost += acknowledged.saturating_sub(next);
        tally
    }
}

/// What all files of a folder take, in MB.
fn megabytes_in(folder: &Path) -> f64 {
    let files = fs::read_dir(folder).unwrap();
    let bytes: u64 = files
        .map(|file| file.unwrap().metadata().unwrap().len())
        .sum();
    f64::from(u32::try_from(bytes / 1000).unwrap()) / 1e3
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
#[ignore = "takes an hour"]
async fn a_day_of_load() {
    let (telegrams, lines) = (
        number("GATEWAY_TELEGRAMS", 10_000_000),
        number("GATEWAY_LINES", 200),
    );
    let kills = number("GATEWAY_KILLS_ONE_IN", 8);
    let most = Duration::from_secs(number("GATEWAY_SECONDS", u32::MAX).into());
    let mut broker = Broker::start().expect("a broker");
    let folder = TempDir::new().unwrap();
    let mut config = format!(
        "name = \"hall\"\nstop_s = 60\n{}[store]\npath = \"{}\"\n",
        mqtt(broker.port),
        folder.path().display()
    );
    let load = Arc::new(Load {
        sent: AtomicU32::new(0),
        failed: AtomicU32::new(0),
        is_over: AtomicBool::new(false),
    });
    let mut partners = Vec::new();
    for index in 0..lines {
        let listener = listen();
        let port = listener.local_addr().unwrap().port();
        config += &line(&format!("line{index}"), port);
        let sending = send_numbers(listener, Arc::clone(&load), index + 1);
        partners.push(tokio::spawn(sending));
    }
    let mut subscriber = Subscriber::new(broker.port).await;
    let (heard_so_far, mut messages) = mpsc::unbounded_channel();
    let shared = Arc::clone(&load);
    let hearing = tokio::spawn(async move {
        let mut heard = Heard::default();
        // None for long after the partners have ended means that all have come.
        loop {
            let was_over = shared.is_over.load(Ordering::Relaxed);
            let Some((topic, payload)) = subscriber.next_within(Duration::from_secs(10)).await
            else {
                if was_over {
                    return heard;
                }
                continue;
            };
            heard.take(&topic, &payload);
            if heard.messages.is_multiple_of(1000) {
                heard_so_far.send(heard.messages).ok();
            }
        }
    });

    let begin = Instant::now();
    let mut gateway = Gateway::start(&config);
    let (mut random, mut next_row, mut heard) = (Random(0x2545_F491), begin, 0);
    let (mut stopped, mut hung, mut killed) = (0, 0, 0);
    println!(
        "| s | acknowledged | at the subscriber | failed jobs | MB of the gateway | its CPU, s | MB on disk |"
    );
    println!("|---|---|---|---|---|---|---|");
    let is_enough = || load.sent.load(Ordering::Relaxed) >= telegrams || begin.elapsed() >= most;
    while !is_enough() {
        let calm = Duration::from_millis((1000 + random.draw() % CALM_MS).into());
        let until = Instant::now() + calm;
        while Instant::now() < until && !is_enough() {
            sleep(Duration::from_millis(200)).await;
            while let Ok(messages) = messages.try_recv() {
                heard = messages;
            }
            if Instant::now() >= next_row {
                next_row += ROW;
                println!(
                    "| {} | {} | {heard} | {} | {:.1} | {:.1} | {:.1} |",
                    begin.elapsed().as_secs(),
                    load.sent.load(Ordering::Relaxed),
                    load.failed.load(Ordering::Relaxed),
                    gateway.resident_mb(),
                    gateway.cpu_s(),
                    megabytes_in(folder.path()),
                );
            }
        }
        if kills != 0 && random.draw().is_multiple_of(kills) {
            killed += 1;
            drop(gateway); // SIGKILL
            gateway = Gateway::start(&config);
        } else if random.draw().is_multiple_of(2) {
            stopped += 1;
            broker.stop();
            sleep(Duration::from_millis((random.draw() % 2000).into())).await;
            broker.start_again();
        } else {
            hung += 1;
            broker.hang();
            sleep(Duration::from_millis((random.draw() % 2000).into())).await;
            broker.go_on();
        }
    }
    load.is_over.store(true, Ordering::Relaxed);
    let took = begin.elapsed();
    let mut acknowledged = Vec::new();
    for partner in partners {
        acknowledged.push(partner.await.unwrap());
    }
    let heard = hearing.await.unwrap();
    let disk = megabytes_in(folder.path());
    gateway.ends();
    let mut all = Tally::default();
    for (line, &acknowledged) in acknowledged.iter().enumerate() {
        let tally = heard.tally(line, acknowledged);
        all.lost += tally.lost;
        all.marked += tally.marked;
        all.unmarked += tally.unmarked;
        all.damaged += tally.damaged;
        all.misplaced += tally.misplaced;
    }
    let count: u32 = acknowledged.iter().sum();
    println!(
        "{count} telegrams of {lines} lines in {took:?}, {:.0} a second; broker stopped {stopped} times, hung {hung} times, gateway killed {killed} times",
        f64::from(count) / took.as_secs_f64()
    );
    println!(
        "{} messages: {} lost, {} out of order, {} published twice under one number, {} came again and are marked, {} came again and are not, {} damaged that BCC took; {:.1} MB on disk",
        heard.messages,
        all.lost,
        all.misplaced,
        heard.published_twice,
        all.marked,
        all.unmarked,
        all.damaged,
        disk
    );
    assert_eq!((all.lost, all.misplaced), (0, 0));
}
