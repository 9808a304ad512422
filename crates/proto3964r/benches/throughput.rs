//! Bytes per second through a station and through the frame codec.
#![expect(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    reason = "a bench fails loudly"
)]

#[path = "instructions/work.rs"]
mod work;

use core::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use proto3964r::{Check, frame};

fn throughput(criterion: &mut Criterion) {
    let payload = work::random();
    let telegram = work::telegram(&payload);
    let mut bench = work::Bench::new();
    let mut out = vec![0; frame::max_encoded_len(work::LEN)];
    let mut group = criterion.benchmark_group("1024 random bytes");
    group.throughput(Throughput::Bytes(1024));
    group.bench_function("receive in one piece", |b| {
        b.iter(|| bench.receive_slice(black_box(&telegram)));
    });
    group.bench_function("receive byte by byte", |b| {
        b.iter(|| bench.receive_bytes(black_box(&telegram)));
    });
    group.bench_function("send in one piece", |b| {
        b.iter(|| bench.send_slice(black_box(&payload), &mut out));
    });
    group.bench_function("send byte by byte", |b| {
        b.iter(|| bench.send_bytes(black_box(&payload)));
    });
    group.bench_function("frame::encode", |b| {
        b.iter(|| frame::encode(black_box(&payload), Check::Bcc, &mut out).unwrap());
    });
    let mut buffer = vec![0; work::LEN];
    group.bench_function("frame::decode", |b| {
        b.iter(|| {
            frame::decode(black_box(&telegram[1..]), Check::Bcc, &mut buffer)
                .unwrap()
                .0
                .len()
        });
    });
    group.finish();
}

criterion_group!(benches, throughput);
criterion_main!(benches);
