//! Time of a score to frames: four times as many moves take four times as long.

#![expect(clippy::unwrap_used, reason = "a bench may stop at a wrong input")]

use core::fmt::Write;
use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dancer::{Law, Score};

/// Two motors that turn there and back in frames of 0.2 s, one after the other.
fn score(moves: u32) -> String {
    let mut text = String::new();
    for name in ["left", "right"] {
        writeln!(text, "[[motor]]\nname = '{name}'\nhalf_step_deg = 0.9").unwrap();
    }
    for number in 0..moves {
        let name = if number % 2 == 0 { "left" } else { "right" };
        let (at_s, deg) = (
            f64::from(number / 2) * 0.4,
            if number % 4 < 2 { 18 } else { -18 },
        );
        writeln!(
            text,
            "[[move]]\nmotor = '{name}'\nat_s = {at_s}\nfor_s = 0.4\nturn_deg = {deg}"
        )
        .unwrap();
    }
    text
}

fn moves(c: &mut Criterion) {
    let mut group = c.benchmark_group("score");
    group.sample_size(20);
    for moves in [2000, 8000, 32_000] {
        let text = score(moves);
        let read: Score = text.parse().unwrap();
        group.throughput(Throughput::Elements(moves.into()));
        group.bench_function(format!("read {moves} moves"), |b| {
            b.iter(|| black_box(&text).parse::<Score>().unwrap().frames());
        });
        for law in [Law::Reset, Law::CarrySigned] {
            group.bench_function(format!("compile {moves} moves, {law:?}"), |b| {
                b.iter(|| black_box(&read).compile::<8>(law).unwrap().landings.len());
            });
        }
    }
    group.finish();
}

criterion_group!(benches, moves);
criterion_main!(benches);
