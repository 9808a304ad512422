//! Instructions per byte, counted by callgrind: the same on a busy machine as on an idle one.
//!
//! The bench runs itself under valgrind, twice per case with different numbers of rounds; the
//! difference is the cost of the rounds alone. It fails when a telegram of random bytes costs more
//! than its limit, any other telegram more than three times that, or noise more than three times
//! what a byte of a telegram may cost an interrupt handler; and says so when there is no valgrind.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    clippy::indexing_slicing,
    reason = "a bench fails loudly"
)]

#[path = "common/floods.rs"]
mod floods;
#[path = "common/work.rs"]
mod work;

use core::hint::black_box;
use std::{
    env,
    process::{Command, ExitCode},
};

use floods::{FLOODS, full_of};
use proto3964r::{Check, frame};
use work::Bench;

const CASE: &str = "PROTO3964R_BENCH_CASE";
const ROUNDS: &str = "PROTO3964R_BENCH_ROUNDS";

/// What a telegram goes through, and the most instructions per payload byte on x86-64.
const WAYS: [(&str, f64); 6] = [
    ("receive in one piece", 15.0),
    ("receive byte by byte", 45.0),
    ("send in one piece", 10.0),
    ("send byte by byte", 40.0),
    ("frame::encode", 10.0),
    ("frame::decode", 15.0),
];

/// Payloads that are not random, with many doubled DLEs.
const DATA: [(&str, &[u8]); 3] = [
    ("all 10h", &[0x10]),
    ("every other 10h", &[0x10, 0x41]),
    ("one 10h in three", &[0x41, 0x42, 0x10]),
];

/// No payload costs more than so many times the limit for random bytes.
const MOST: f64 = 3.0;

/// The most instructions per character of noise: three times those of a byte in a telegram.
const NOISE: f64 = 135.0;

/// A telegram with this payload, so many times.
fn telegrams(way: &str, payload: &[u8], rounds: u32) {
    let telegram = work::telegram(payload);
    let mut bench = Bench::new();
    let mut out = vec![0; frame::max_encoded_len(work::LEN)];
    for _ in 0..rounds {
        let len = match way {
            "receive in one piece" => bench.receive_slice(black_box(&telegram)),
            "receive byte by byte" => bench.receive_bytes(black_box(&telegram)),
            "send in one piece" => bench.send_slice(black_box(payload), &mut out),
            "send byte by byte" => bench.send_bytes(black_box(payload)),
            "frame::encode" => frame::encode(black_box(payload), Check::Bcc, &mut out).unwrap(),
            "frame::decode" => frame::decode(black_box(&telegram[1..]), Check::Bcc, &mut out)
                .unwrap()
                .0
                .len(),
            other => panic!("no way {other}"),
        };
        assert!(black_box(len) >= work::LEN);
    }
}

fn run(case: &str, rounds: u32) {
    let (way, what) = case.split_once(", ").unwrap();
    if let Some(flood) = FLOODS.iter().find(|flood| flood.name == what) {
        let (bench, characters) = (flood.bench(), full_of(flood.characters));
        for _ in 0..rounds {
            black_box(bench.meet(black_box(&characters), way == WAYS[0].0));
        }
    } else if let Some((_, bytes)) = DATA.iter().find(|(data, _)| *data == what) {
        telegrams(way, &full_of(bytes), rounds);
    } else {
        telegrams(way, &work::random(), rounds);
    }
}

/// Instructions of a whole run, from callgrind's report.
fn instructions(case: &str, rounds: u32) -> u64 {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe().unwrap())
        .env(CASE, case)
        .env(ROUNDS, rounds.to_string())
        .output()
        .unwrap();
    let report = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{report}");
    let collected = report
        .lines()
        .find_map(|line| line.split("Collected :").nth(1));
    collected
        .unwrap_or_else(|| panic!("{report}"))
        .trim()
        .parse()
        .unwrap()
}

#[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
fn per_byte(case: &str) -> f64 {
    let (few, many) = (20, 120);
    let difference = instructions(case, many) - instructions(case, few);
    difference as f64 / (f64::from(many - few) * work::LEN as f64)
}

/// Prints the cost of a case; whether it is within the limit.
fn judge(way: &str, what: &str, limit: f64) -> bool {
    let case = format!("{way}, {what}");
    let cost = per_byte(&case);
    let verdict = if cost <= limit { "ok" } else { "TOO MANY" };
    println!("{case:43} {cost:6.2} instructions per byte, at most {limit:5.1}: {verdict}");
    cost <= limit
}

fn main() -> ExitCode {
    if let (Ok(case), Ok(rounds)) = (env::var(CASE), env::var(ROUNDS)) {
        run(&case, rounds.parse().unwrap());
        return ExitCode::SUCCESS;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        eprintln!("skipped: there is no valgrind to count instructions with");
        return ExitCode::SUCCESS;
    }
    let mut all_good = true;
    for (way, limit) in WAYS {
        all_good &= judge(way, "random bytes", limit);
        for (what, _) in DATA {
            all_good &= judge(way, what, MOST * limit);
        }
        for flood in FLOODS.iter().filter(|_| way.starts_with("receive")) {
            all_good &= judge(way, flood.name, NOISE);
        }
    }
    if all_good {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
