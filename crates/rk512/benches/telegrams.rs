//! Speed of encoding, decoding and serving.
use core::{hint::black_box, time::Duration};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rk512::{Area, Command, Config, DataBlock, MAX_DATA, Memory, Message, Server, Telegram};

fn send() -> Option<Telegram> {
    let words = u16::try_from(MAX_DATA / 2).ok()?;
    let command = Command::send(Area::db(5, 0), words).ok()?;
    command.telegram(&[0x10; MAX_DATA]).ok()
}

fn telegrams(c: &mut Criterion) {
    let Some(telegram) = send() else { return };
    let mut group = c.benchmark_group("telegram with 128 bytes");
    group.throughput(Throughput::Bytes(128));
    group.bench_function("encode", |b| b.iter(|| black_box(send())));
    group.bench_function("decode", |b| {
        b.iter(|| Message::decode(black_box(&telegram)).is_ok());
    });
    let mut bytes = [0; MAX_DATA];
    let mut plc = Memory::new([DataBlock::db(5, &mut bytes)]);
    let mut server = Server::new(Config::DEFAULT);
    group.bench_function("serve", |b| {
        b.iter(|| {
            server.handle_block(black_box(&telegram), &mut plc);
            let reaction = server.poll_transmit();
            server.handle_delivered(Duration::ZERO);
            reaction
        });
    });
    group.finish();
}

criterion_group!(benches, telegrams);
criterion_main!(benches);
