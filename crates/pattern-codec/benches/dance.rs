//! Throughput of the dancer's frames: five minutes of eight motors to bytes, to a C header and
//! back.

#![expect(clippy::unwrap_used, reason = "a bench may stop at a wrong input")]

use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pattern_codec::dance::{Data, DataHeader, Packing};

const FRAMES: usize = 1500;

/// Speeds that rise and fall in turn on every motor, with rests between.
fn dance() -> Vec<[i8; 8]> {
    let rise = [5, 28, 47, 63, 75, 85, 92, 97, 99, 100];
    let wave: Vec<i8> = rise
        .into_iter()
        .chain(rise.into_iter().rev())
        .chain([0; 10])
        .collect();
    let frames = (0..FRAMES).map(|frame| {
        let speed = |motor: usize| wave.get((frame + 4 * motor) % wave.len()).copied();
        [0, 1, 2, 3, 4, 5, 6, 7].map(|motor| speed(motor).unwrap())
    });
    frames.collect()
}

fn bytes(c: &mut Criterion) {
    let frames = dance();
    let mut group = c.benchmark_group("dance bytes");
    group.throughput(Throughput::Elements(FRAMES.try_into().unwrap()));
    for packing in Packing::ALL {
        let bytes: Vec<u8> = packing.encode(frames.iter().copied()).collect();
        group.bench_function(format!("encode {}", packing.name()), |b| {
            b.iter(|| packing.encode(black_box(&frames).iter().copied()).count());
        });
        group.bench_function(format!("decode {}", packing.name()), |b| {
            b.iter(|| {
                let frames = packing.decode::<8, _>(black_box(&bytes).iter().copied());
                frames
                    .map(Result::unwrap)
                    .map(|frame| i32::from(frame[7]))
                    .sum::<i32>()
            });
        });
    }
    group.finish();
}

fn header(c: &mut Criterion) {
    let frames = dance();
    let mut text = String::new();
    let header = DataHeader {
        packing: Packing::MaskedRuns,
        ..DataHeader::DEFAULT
    };
    header.write(frames.iter().copied(), &mut text).unwrap();
    let mut group = c.benchmark_group("dance header");
    group.throughput(Throughput::Bytes(text.len().try_into().unwrap()));
    group.bench_function("write", |b| {
        b.iter(|| {
            let mut text = String::with_capacity(text.len());
            header
                .write(black_box(&frames).iter().copied(), &mut text)
                .unwrap();
            text.len()
        });
    });
    group.bench_function("read and check", |b| {
        b.iter(|| Data::<8>::read(black_box(&text)).unwrap().bytes());
    });
    group.finish();
}

criterion_group!(benches, bytes, header);
criterion_main!(benches);
