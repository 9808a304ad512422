//! Instructions per data byte, counted by callgrind: the same on a busy machine as on an idle one.
//!
//! The bench runs itself under valgrind, twice per case with different numbers of telegrams; the
//! difference is the cost of the telegrams alone. It fails when a case costs more than its limit,
//! and says so when there is no valgrind.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    clippy::indexing_slicing,
    reason = "a bench fails loudly"
)]

#[path = "common/work.rs"]
mod work;

use core::hint::black_box;
use std::{
    env,
    process::{Command, ExitCode},
};

use proto3964r::{Check, frame};

const CASE: &str = "PROTO3964R_BENCH_CASE";
const ROUNDS: &str = "PROTO3964R_BENCH_ROUNDS";

/// Name, and the most instructions per payload byte on x86-64.
const CASES: [(&str, f64); 6] = [
    ("receive in one piece", 6.0),
    ("receive byte by byte", 25.0),
    ("send in one piece", 6.0),
    ("send byte by byte", 25.0),
    ("frame::encode", 6.0),
    ("frame::decode", 6.0),
];

fn run(case: &str, rounds: u32) {
    let payload = work::payload();
    let telegram = work::telegram(&payload);
    let mut station = work::station();
    let mut out = vec![0; frame::max_encoded_len(work::LEN)];
    for _ in 0..rounds {
        let len = match case {
            "receive in one piece" => work::receive_slice(&mut station, black_box(&telegram)),
            "receive byte by byte" => work::receive_bytes(&mut station, black_box(&telegram)),
            "send in one piece" => work::send_slice(&mut station, black_box(&payload), &mut out),
            "send byte by byte" => work::send_bytes(&mut station, black_box(&payload)),
            "frame::encode" => frame::encode(black_box(&payload), Check::Bcc, &mut out).unwrap(),
            "frame::decode" => frame::decode(black_box(&telegram[1..]), Check::Bcc, &mut out)
                .unwrap()
                .0
                .len(),
            other => panic!("no case {other}"),
        };
        assert!(black_box(len) >= work::LEN);
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
    let (few, many) = (20, 220);
    let difference = instructions(case, many) - instructions(case, few);
    difference as f64 / (f64::from(many - few) * work::LEN as f64)
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
    let mut code = ExitCode::SUCCESS;
    for (case, limit) in CASES {
        let cost = per_byte(case);
        let verdict = if cost <= limit { "ok" } else { "TOO MANY" };
        println!(
            "{case:22} {cost:6.2} instructions per payload byte, at most {limit:4.1}: {verdict}"
        );
        if cost > limit {
            code = ExitCode::FAILURE;
        }
    }
    code
}
