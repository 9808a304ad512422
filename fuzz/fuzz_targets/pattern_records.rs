//! Any bytes under any format: slice and stream agree, and what decodes is encoded canonically.
#![no_main]

use arbitrary::Unstructured;
use libfuzzer_sys::fuzz_target;
use pattern_codec::engraving::{
    Builder, DecodeError, DecodeErrorKind, Decoder, Format, Located, Statistics, Strictness,
};
use pose2pulse_fuzz::Cuts;

type Item = Result<Located, DecodeError>;

fuzz_target!(|data: &[u8]| {
    let mut u = Unstructured::new(data);
    let (Ok(format), Ok(cuts)) = (pose2pulse_fuzz::format(&mut u), u.arbitrary()) else {
        return;
    };
    let bytes = u.take_rest();
    let items: Vec<Item> = format.records(bytes).collect();
    size_hint_holds(&format, bytes, items.len());
    stream_agrees(&format, bytes, &cuts, &items);
    for located in items.iter().flatten() {
        is_canonical_once_encoded(&format, located);
    }
    sums_agree(&items);
});

fn size_hint_holds(format: &Format, bytes: &[u8], count: usize) {
    let (least, most) = format.records(bytes).size_hint();
    assert!(least <= count && most.is_some_and(|most| count <= most));
    if format.strictness == Strictness::Lenient {
        assert_eq!(count, least);
    }
}

/// The stream hands out the same, but for an incomplete record, which only its end can tell.
fn stream_agrees(format: &Format, bytes: &[u8], cuts: &Cuts, items: &[Item]) {
    let mut decoder = Decoder::new(*format);
    let mut streamed = Vec::new();
    for mut piece in cuts.of(bytes) {
        while let Some(item) = decoder.decode(&mut piece) {
            streamed.push(item);
        }
    }
    let end = decoder.finish();
    let truncated = |item: &&Item| {
        matches!(
            item,
            Err(DecodeError {
                kind: DecodeErrorKind::Truncated { .. },
                ..
            })
        )
    };
    let last_error = match items.last() {
        Some(Err(error)) if format.strictness == Strictness::Strict => Some(*error),
        Some(Err(error)) => Some(*error).filter(|_| items.last().as_ref().is_some_and(truncated)),
        _ => None,
    };
    assert_eq!(end, last_error.map_or(Ok(bytes.len() as u64), Err));
    let whole = items.len() - usize::from(items.last().as_ref().is_some_and(truncated));
    assert_eq!(streamed, items[..whole]);
}

fn is_canonical_once_encoded(format: &Format, located: &Located) {
    let encoded = located.record.encode(format);
    assert_eq!(format.decode(encoded), Ok(located.record));
    assert_eq!(format.canonical(located.bytes), Ok(encoded));
    assert_eq!(format.canonical(encoded), Ok(encoded));
    assert_eq!(located.is_canonical(format), located.bytes == encoded);
}

/// Positions and statistics are the sums of the records.
fn sums_agree(items: &[Item]) {
    let mut builder = Builder::new();
    let mut statistics = Statistics::default();
    let (mut sum, mut pulses, mut records) = ([0_i64; 4], [0_u64; 4], 0);
    for located in items.iter().flatten() {
        let moved = located.record.pulses();
        let moved = [moved.elbow, moved.shoulder, moved.disc, moved.vertical];
        if builder.track(located.record).is_err() {
            return;
        }
        statistics.add(located.record);
        records += 1;
        for (axis, moved) in moved.into_iter().enumerate() {
            sum[axis] += i64::from(moved);
            pulses[axis] += u64::from(moved.unsigned_abs());
        }
    }
    let at = builder.position();
    assert_eq!(
        [at.elbow, at.shoulder, at.disc, at.vertical].map(i64::from),
        sum
    );
    let counted = statistics.pulses;
    let counted = [
        counted.elbow,
        counted.shoulder,
        counted.disc,
        counted.vertical,
    ];
    assert_eq!((counted, statistics.records()), (pulses, records));
}
