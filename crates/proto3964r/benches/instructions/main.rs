//! Instructions per byte, counted by callgrind. It fails when a telegram of random bytes costs more
//! than its limit, any other telegram more than three times that, or noise more than three times
//! what a byte of a telegram may cost an interrupt handler.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    clippy::indexing_slicing,
    reason = "a bench fails loudly"
)]

mod floods;
mod work;

use core::hint::black_box;
use std::process::ExitCode;

use floods::{FLOODS, full_of};
use proto3964r::{Check, frame};
use test_support::instructions::{Limit, bench};
use work::Bench;

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

#[expect(clippy::cast_precision_loss, reason = "a telegram's length")]
fn limit<'a>(case: &'a str, most: f64) -> Limit<'a> {
    Limit {
        case,
        unit: "per byte",
        units: work::LEN as f64,
        rounds: [20, 120],
        most,
    }
}

fn main() -> ExitCode {
    let mut cases = Vec::new();
    for (way, most) in WAYS {
        cases.push((format!("{way}, random bytes"), most));
        cases.extend(DATA.map(|(what, _)| (format!("{way}, {what}"), MOST * most)));
        let floods = FLOODS.iter().filter(|_| way.starts_with("receive"));
        cases.extend(floods.map(|flood| (format!("{way}, {}", flood.name), NOISE)));
    }
    let limits: Vec<_> = cases
        .iter()
        .map(|(case, most)| limit(case, *most))
        .collect();
    bench(run, &limits)
}
