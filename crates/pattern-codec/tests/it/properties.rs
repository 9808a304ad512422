//! Properties of the engraving records: round trips, any bytes, splits.

use pattern_codec::engraving::{
    Axis, Builder, DecodeError, DecodeErrorKind, Decoder, Format, Located, PerAxis, Record,
    Statistics, Strictness,
};
use proptest::prelude::*;

use crate::common::{axes, formats, joint_pulses, per_axis, records};

/// Bytes near the interesting values, so that long sequences are accepted as well.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![
        3 => (0_u8..=30, any::<bool>()).prop_map(|(count, sign)| count | u8::from(sign) << 7),
        1 => any::<u8>(),
    ];
    prop::collection::vec(byte, 0..100)
}

/// The stream decoder's answer for the same bytes in pieces, with the end as last item.
fn in_chunks(format: Format, bytes: &[u8], cuts: &[usize]) -> Vec<Result<Located, DecodeError>> {
    let mut decoder = Decoder::new(format);
    let mut items = Vec::new();
    let mut rest = bytes;
    let mut cuts = cuts.iter().cycle();
    while !rest.is_empty() {
        let at = (*cuts.next().unwrap()).min(rest.len());
        let (mut chunk, behind) = rest.split_at(at);
        rest = behind;
        while let Some(item) = decoder.decode(&mut chunk) {
            items.push(item);
        }
    }
    if let Err(error) = decoder.finish()
        && items.last() != Some(&Err(error))
    {
        items.push(Err(error));
    }
    items
}

proptest! {
    #[test]
    fn decode_of_encode_is_the_sequence(
        format in formats(),
        sequence in prop::collection::vec(records(), 0..50),
    ) {
        let encoded: Vec<_> = sequence.iter().map(|record| record.encode(&format)).collect();
        for (bytes, record) in encoded.iter().zip(&sequence) {
            prop_assert_eq!(format.decode(*bytes), Ok(*record));
            prop_assert_eq!(format.canonical(*bytes), Ok(*bytes));
        }
        let bytes = encoded.concat();
        for (index, located) in format.records(&bytes).enumerate() {
            let located = located.unwrap();
            prop_assert_eq!(located.offset, 3 * index as u64);
            prop_assert_eq!(located.record, sequence[index]);
            prop_assert!(located.is_canonical(&format));
        }
        prop_assert_eq!(format.records(&bytes).count(), sequence.len());
    }

    #[test]
    fn any_bytes_are_records_or_an_error_in_their_place(
        format in formats(),
        bytes in bytes(),
    ) {
        let items: Vec<_> = format.records(&bytes).collect();
        for (index, item) in items.iter().enumerate() {
            let start = 3 * index;
            match item {
                Ok(located) => {
                    prop_assert_eq!(located.offset, start as u64);
                    prop_assert_eq!(&located.bytes[..], &bytes[start..start + 3]);
                    let encoded = located.record.encode(&format);
                    prop_assert_eq!(format.canonical(located.bytes), Ok(encoded));
                    prop_assert_eq!(format.decode(encoded), Ok(located.record));
                }
                Err(error) => {
                    let offset = usize::try_from(error.offset).unwrap();
                    prop_assert!((start..start + 3).contains(&offset));
                    let value = match error.kind {
                        DecodeErrorKind::SlowCount { byte, .. }
                        | DecodeErrorKind::SlowAxisBits { byte, .. } => byte,
                        DecodeErrorKind::Truncated { first, present } => {
                            prop_assert_eq!(bytes.len() - offset, usize::from(present));
                            first
                        }
                        other => panic!("{other}"),
                    };
                    prop_assert_eq!(value, bytes[offset]);
                }
            }
        }
        let all = bytes.len().div_ceil(3);
        let failed = items.last().is_some_and(Result::is_err);
        prop_assert!(items.len() == all || (failed && format.strictness == Strictness::Strict));
        let (least, most) = format.records(&bytes).size_hint();
        prop_assert!((least..=most.unwrap()).contains(&items.len()));
    }

    #[test]
    fn chunks_of_any_size_give_the_same_records(
        format in formats(),
        bytes in bytes(),
        cuts in prop::collection::vec(1_usize..9, 1..9),
    ) {
        let items: Vec<_> = format.records(&bytes).collect();
        prop_assert_eq!(in_chunks(format, &bytes, &cuts), items);
    }

    #[test]
    fn a_fast_motion_sums_exactly(axis in axes(), pulses in any::<i32>()) {
        let mut builder = Builder::new();
        let records = builder.fast(axis, pulses).unwrap();
        let parts = pulses.unsigned_abs().div_ceil(65_535);
        prop_assert_eq!(records.size_hint().0, parts as usize);
        let mut arm = Builder::new();
        for record in records {
            prop_assert!(record.pulses() != PerAxis::default());
            arm.track(record).unwrap();
        }
        prop_assert_eq!(*arm.position().get(axis), pulses);
        prop_assert_eq!(arm, builder);
    }

    #[test]
    fn a_slow_motion_sums_exactly_and_stays_on_the_line(pulses in joint_pulses(20_000)) {
        let mut builder = Builder::new();
        let records = builder.slow(pulses).unwrap();
        let totals = builder.position();
        let most = Axis::ALL.map(|axis| totals.get(axis).unsigned_abs()).into_iter().max();
        let parts = most.unwrap().div_ceil(30);
        prop_assert_eq!(records.size_hint().0, parts as usize);
        let (n, mut k) = (i64::from(parts), 0);
        let mut arm = Builder::new();
        for record in records {
            prop_assert!(record.pulses() != PerAxis::default());
            arm.track(record).unwrap();
            k += 1;
            for axis in Axis::ALL {
                let total = i64::from(*totals.get(axis));
                let ideal_times_n = k * total;
                let off_times_n = n * i64::from(*arm.position().get(axis)) - ideal_times_n;
                prop_assert!(2 * off_times_n.abs() <= n, "{axis} part {k} of {n}");
                let part = i64::from(*record.pulses().get(axis)).abs();
                let floor = total.abs() / n;
                prop_assert!(part == floor || part == floor + 1);
            }
        }
        prop_assert_eq!(k, n);
        prop_assert_eq!(arm, builder);
    }

    #[test]
    fn homing_ends_at_zero_from_anywhere(
        position in any::<[i32; 4]>(),
        order in Just(Axis::ALL).prop_shuffle(),
    ) {
        let start = per_axis(position);
        let mut builder = Builder::at(start);
        let records = builder.home(order).unwrap();
        let count = records.clone().count();
        prop_assert_eq!(records.size_hint(), (count, Some(count)));
        let mut arm = Builder::at(start);
        let mut moved = Vec::new();
        for record in records {
            let Record::Fast(fast) = record else { panic!("homing is rapid") };
            arm.track(record).unwrap();
            moved.push(fast.axis());
        }
        moved.dedup();
        let expected: Vec<_> = order.into_iter().filter(|axis| *start.get(*axis) != 0).collect();
        prop_assert_eq!(moved, expected);
        prop_assert_eq!(arm, Builder::new());
        prop_assert_eq!(builder, Builder::new());
    }

    #[test]
    fn statistics_agree_with_the_records(
        sequence in prop::collection::vec(records(), 0..50),
    ) {
        let statistics: Statistics = sequence.iter().copied().collect();
        prop_assert_eq!(statistics.bytes(), 3 * sequence.len() as u64);
        for axis in Axis::ALL {
            let sum: u64 = sequence
                .iter()
                .map(|record| u64::from(record.pulses().get(axis).unsigned_abs()))
                .sum();
            prop_assert_eq!(*statistics.pulses.get(axis), sum);
        }
    }
}
