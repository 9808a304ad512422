//! Throughput of decoding, in bytes of pattern per second on one core.

#![expect(clippy::unwrap_used, reason = "a bench may stop at a wrong input")]

use core::hint::black_box;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pattern_codec::engraving::{
    Axis, Builder, Decoder, Format, JointPulses, Record, Statistics, Strictness,
};

/// Small enough for the second-level cache, so that decoding is measured and not memory.
const RECORDS: usize = 65_536;

/// A drawing: strokes of 60 cutting records, each after a travel of four FAST records. Counts and
/// signs come from a fixed linear congruential generator.
fn drawing(format: &Format) -> Vec<u8> {
    let mut state = 1_u32;
    let mut random = |limit: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let magnitude = i32::try_from((state >> 8) % (limit + 1)).unwrap();
        if state >> 31 == 0 {
            magnitude
        } else {
            -magnitude
        }
    };
    let mut bytes = Vec::with_capacity(3 * RECORDS);
    let mut builder = Builder::new();
    while bytes.len() < 3 * RECORDS {
        for axis in Axis::ALL {
            let travel = builder.fast(axis, random(5000)).unwrap();
            bytes.extend(travel.flat_map(|record| record.encode(format)));
        }
        for _ in 0..60 {
            let pulses = JointPulses {
                elbow: random(30),
                shoulder: random(30),
                disc: random(4),
            };
            let cut = builder.slow(pulses).unwrap();
            bytes.extend(cut.flat_map(|record| record.encode(format)));
        }
    }
    bytes
}

/// A cheap use of every record that the optimiser cannot drop.
fn used(sum: i32, record: Record) -> i32 {
    let pulses = record.pulses();
    sum.wrapping_add(pulses.elbow)
        .wrapping_add(pulses.shoulder)
        .wrapping_add(pulses.disc)
        .wrapping_add(pulses.vertical)
}

fn decode(criterion: &mut Criterion) {
    let strict = Format::default();
    let bytes = drawing(&strict);
    let mut group = criterion.benchmark_group("decode");
    group.throughput(Throughput::Bytes(bytes.len().try_into().unwrap()));
    for (name, strictness) in [
        ("strict", Strictness::Strict),
        ("lenient", Strictness::Lenient),
    ] {
        let format = strict.with_strictness(strictness);
        group.bench_function(format!("slice, {name}"), |bench| {
            bench.iter(|| {
                let format = black_box(format);
                let mut sum = 0;
                for located in format.records(black_box(&bytes)) {
                    sum = used(sum, located.unwrap().record);
                }
                sum
            });
        });
    }
    group.bench_function("chunks of 4096, strict", |bench| {
        bench.iter(|| {
            let mut decoder = Decoder::new(black_box(strict));
            let mut sum = 0;
            for mut chunk in black_box(&bytes).chunks(4096) {
                while let Some(located) = decoder.decode(&mut chunk) {
                    sum = used(sum, located.unwrap().record);
                }
            }
            (decoder.finish().unwrap(), sum)
        });
    });
    group.bench_function("slice with statistics, strict", |bench| {
        bench.iter(|| {
            let records = black_box(strict).records(black_box(&bytes));
            records
                .map(|located| located.unwrap().record)
                .collect::<Statistics>()
        });
    });
    group.finish();
}

fn encode(criterion: &mut Criterion) {
    let format = Format::default();
    let bytes = drawing(&format);
    let records: Vec<_> = format
        .records(&bytes)
        .map(|located| located.unwrap().record)
        .collect();
    let mut group = criterion.benchmark_group("encode");
    group.throughput(Throughput::Bytes(bytes.len().try_into().unwrap()));
    group.bench_function("records", |bench| {
        let mut out = bytes.clone();
        bench.iter(|| {
            let format = black_box(format);
            for (record, place) in black_box(&records).iter().zip(out.as_chunks_mut().0) {
                *place = record.encode(&format);
            }
            black_box(&mut out);
        });
    });
    group.finish();
}

criterion_group!(benches, decode, encode);
criterion_main!(benches);
