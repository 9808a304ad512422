//! pattern-codec: engraving records.

use std::hint::black_box;

use no_panic::no_panic;
use pattern_codec::engraving::{
    Axis, Builder, DecodeError, Decoder, Format, JointPulses, Located, PositionOverflow, Record,
    Records,
};

#[no_panic]
#[inline(never)]
fn records_next(records: &mut Records<'_>) -> Option<Result<Located, DecodeError>> {
    records.next()
}

#[no_panic]
#[inline(never)]
fn decode(decoder: &mut Decoder, input: &mut &[u8]) -> Option<Result<Located, DecodeError>> {
    decoder.decode(input)
}

#[no_panic]
#[inline(never)]
fn decoder_finish(decoder: Decoder) -> Result<u64, DecodeError> {
    decoder.finish()
}

#[no_panic]
#[inline(never)]
fn encode(record: Record, format: &Format) -> [u8; Record::LEN] {
    record.encode(format)
}

#[no_panic]
#[inline(never)]
fn track(builder: &mut Builder, record: Record) -> Result<(), PositionOverflow> {
    builder.track(record)
}

/// Records of a rapid, a cutting and a homing motion.
#[no_panic]
#[inline(never)]
fn motion_next(records: &mut impl Iterator<Item = Record>) -> Option<Record> {
    records.next()
}

pub fn run() {
    let format = black_box(Format::default());
    let bytes = black_box([0x02, 0x0F, 0x9E, 0x7F, 0x01, 0x00].as_slice());
    let _ = black_box(records_next(&mut black_box(format.records(bytes))));
    let mut decoder = black_box(Decoder::new(format));
    let _ = black_box(decode(&mut decoder, &mut black_box(bytes)));
    let _ = black_box(decoder_finish(black_box(decoder)));
    let mut builder = black_box(Builder::new());
    let pulses = JointPulses {
        elbow: 45,
        shoulder: -90,
        disc: 6,
    };
    let fast = builder.fast(black_box(Axis::Vertical), black_box(-70_000));
    if let Some(record) = fast.ok().and_then(|fast| motion_next(&mut black_box(fast))) {
        black_box(encode(black_box(record), &format));
        let _ = black_box(track(&mut builder, black_box(record)));
    }
    if let Ok(slow) = builder.slow(black_box(pulses)) {
        black_box(motion_next(&mut black_box(slow)));
    }
    if let Ok(home) = builder.home(black_box(Axis::ALL)) {
        black_box(motion_next(&mut black_box(home)));
    }
}
