//! The cases that [Engraver 2000] leaves to decide, one test each.

use pattern_codec::engraving::{
    Axis, AxisCodeError, AxisCodes, ByteOrder, DecodeErrorKind, Decoder, Fast, Format, PerAxis,
    Slow, Strictness,
};

use crate::common::{fast, joints, per_axis, slow};

const STRICT: Format = Format::new();
const LENIENT: Format = Format::new().with_strictness(Strictness::Lenient);

#[test]
fn fast_has_direction_axis_and_mark_in_byte_0_and_the_count_behind() {
    for (axis, pulses, bytes) in [
        (Axis::Elbow, 1, [0x1F, 0x00, 0x01]),
        (Axis::Elbow, -1, [0x9F, 0x00, 0x01]),
        (Axis::Shoulder, 256, [0x3F, 0x01, 0x00]),
        (Axis::Disc, -4097, [0xDF, 0x10, 0x01]),
        (Axis::Vertical, 65_535, [0x7F, 0xFF, 0xFF]),
        (Axis::Vertical, -65_535, [0xFF, 0xFF, 0xFF]),
    ] {
        assert_eq!(fast(axis, pulses).encode(&STRICT), bytes);
        assert_eq!(STRICT.decode(bytes), Ok(fast(axis, pulses)));
    }
}

#[test]
fn slow_stands_in_the_order_disc_elbow_shoulder() {
    for ((disc, elbow, shoulder), bytes) in [
        ((1, 2, 3), [0x01, 0x02, 0x03]),
        ((-1, 2, -3), [0x81, 0x02, 0x83]),
        ((30, -30, 0), [0x1E, 0x9E, 0x00]),
    ] {
        let record = slow(elbow, shoulder, disc);
        assert_eq!(record.encode(&STRICT), bytes);
        assert_eq!(STRICT.decode(bytes), Ok(record));
    }
}

#[test]
fn axis_codes_are_a_setting() {
    let codes = per_axis([3, 0, 1, 2]);
    let format = STRICT.with_axis_codes(AxisCodes::new(codes).unwrap());
    for axis in Axis::ALL {
        let bytes = fast(axis, 7).encode(&format);
        assert_eq!(bytes, [codes.get(axis) << 5 | 0x1F, 0, 7]);
        assert_eq!(format.decode(bytes), Ok(fast(axis, 7)));
    }
}

#[test]
fn default_axis_codes_are_those_that_new_makes() {
    let codes = AxisCodes::default();
    assert_eq!(AxisCodes::new(codes.codes()), Ok(codes));
}

#[test]
fn axis_codes_must_fit_and_differ() {
    let good = AxisCodes::default().codes();
    let too_large = AxisCodes::new(PerAxis { disc: 4, ..good }).unwrap_err();
    assert_eq!(
        too_large,
        AxisCodeError::TooLarge {
            axis: Axis::Disc,
            code: 4
        }
    );
    assert_eq!(too_large.to_string(), "disc: axis code 4 is above 3");
    let repeated = AxisCodes::new(PerAxis {
        vertical: 1,
        ..good
    });
    assert_eq!(
        repeated.unwrap_err().to_string(),
        "shoulder and vertical: both have the axis code 1"
    );
}

#[test]
fn byte_order_is_a_setting() {
    let format = STRICT.with_byte_order(ByteOrder::LittleEndian);
    let bytes = fast(Axis::Elbow, 0x1234).encode(&format);
    assert_eq!(bytes, [0x1F, 0x34, 0x12]);
    assert_eq!(format.decode(bytes), Ok(fast(Axis::Elbow, 0x1234)));
    assert_eq!(STRICT.decode(bytes), Ok(fast(Axis::Elbow, 0x3412)));
}

#[test]
fn more_than_one_record_holds_cannot_be_built() {
    for pulses in [65_536, -65_536, i32::MAX, i32::MIN] {
        let error = Fast::new(Axis::Shoulder, pulses).unwrap_err();
        assert_eq!(
            (error.axis, error.pulses, error.max),
            (Axis::Shoulder, pulses, 65_535)
        );
    }
    for pulses in [31, -31, 256, -226, i32::MAX, i32::MIN] {
        for axis in [Axis::Disc, Axis::Elbow, Axis::Shoulder] {
            let only = |this| if this == axis { pulses } else { 30 };
            let error = Slow::new(joints(
                only(Axis::Elbow),
                only(Axis::Shoulder),
                only(Axis::Disc),
            ))
            .unwrap_err();
            assert_eq!((error.axis, error.pulses, error.max), (axis, pulses, 30));
        }
    }
    let error = Fast::new(Axis::Vertical, -70_000).unwrap_err();
    assert_eq!(
        error.to_string(),
        "vertical: -70000 pulses do not fit into one record, which holds at most 65535 in either direction"
    );
}

#[test]
fn the_fast_mark_counts_only_in_the_first_byte() {
    let bytes = [0x01, 0x02, 0x03, 0x00, 0x9F, 0x00, 0x00, 0x00, 0x1F];
    for format in [STRICT, LENIENT] {
        let mut records = format.records(&bytes);
        assert!(records.next().unwrap().is_ok());
        let error = records.next().unwrap().unwrap_err();
        assert_eq!(error.offset, 4);
        assert_eq!(
            error.kind,
            DecodeErrorKind::SlowCount {
                axis: Axis::Elbow,
                byte: 0x9F
            }
        );
        assert_eq!(
            error.to_string(),
            "pattern byte 4: 0x9F has 31 pulses for elbow in a SLOW record, which holds at most 30"
        );
    }
    // A FAST record may hold any bytes behind its mark.
    assert_eq!(
        STRICT.decode([0x1F, 0x1F, 0x1F]),
        Ok(fast(Axis::Elbow, 0x1F1F))
    );
}

#[test]
fn strict_ends_at_the_first_error_and_stays_ended() {
    let bytes = [0x00, 0x1F, 0x00, 0x01, 0x01, 0x01];
    let mut records = STRICT.records(&bytes);
    assert!(records.next().unwrap().is_err());
    assert!(records.next().is_none());
    assert!(records.next().is_none());

    let mut decoder = Decoder::new(STRICT);
    let mut input = bytes.as_slice();
    let error = decoder.decode(&mut input).unwrap().unwrap_err();
    assert!(decoder.decode(&mut input).is_none());
    assert_eq!(input, &bytes[3..]);
    assert_eq!(decoder.finish(), Err(error));
}

#[test]
fn lenient_goes_on_with_the_next_three_bytes() {
    let bytes = [0x00, 0x00, 0x1F, 0x01, 0x01, 0x01, 0x00, 0x1F, 0x00];
    let items: Vec<_> = LENIENT.records(&bytes).collect();
    assert_eq!(items.len(), 3);
    assert_eq!(items[0].unwrap_err().offset, 2);
    assert_eq!(items[1].unwrap().record, slow(1, 1, 1));
    assert_eq!(items[1].unwrap().offset, 3);
    assert_eq!(items[2].unwrap_err().offset, 7);
    assert_eq!(LENIENT.records(&bytes).size_hint(), (3, Some(3)));
}

#[test]
fn a_truncated_record_is_an_error_at_its_start() {
    for (rest, present) in [(&[0x3F][..], 1), (&[0x3F, 0x12][..], 2)] {
        let bytes = [&[0x01, 0x02, 0x03][..], rest].concat();
        for format in [STRICT, LENIENT] {
            let mut records = format.records(&bytes);
            assert!(records.next().unwrap().is_ok());
            let error = records.next().unwrap().unwrap_err();
            let kind = DecodeErrorKind::Truncated {
                first: 0x3F,
                present,
            };
            assert_eq!((error.offset, error.kind), (3, kind));
            assert!(records.next().is_none());

            let mut decoder = Decoder::new(format);
            let mut input = bytes.as_slice();
            assert!(decoder.decode(&mut input).unwrap().is_ok());
            assert_eq!(decoder.decode(&mut input), None);
            assert_eq!(decoder.finish(), Err(error));
        }
    }
}

#[test]
fn fast_zero_and_slow_zero_are_records_without_motion() {
    assert_eq!(STRICT.decode([0x3F, 0, 0]), Ok(fast(Axis::Shoulder, 0)));
    assert_eq!(STRICT.decode([0, 0, 0]), Ok(slow(0, 0, 0)));
    assert_eq!(fast(Axis::Shoulder, 0).pulses(), PerAxis::default());
    assert_eq!(slow(0, 0, 0).pulses(), PerAxis::default());
}

#[test]
fn a_negative_zero_is_zero_and_reported() {
    for (bytes, canonical) in [
        ([0xBF, 0x00, 0x00], [0x3F, 0x00, 0x00]),
        ([0x80, 0x01, 0x81], [0x00, 0x01, 0x81]),
        ([0x01, 0x80, 0x80], [0x01, 0x00, 0x00]),
    ] {
        for format in [STRICT, LENIENT] {
            let located = format.records(&bytes).next().unwrap().unwrap();
            assert_eq!(located.bytes, bytes);
            assert!(!located.is_canonical(&format));
            assert_eq!(located.record.encode(&format), canonical);
            assert_eq!(format.canonical(bytes), Ok(canonical));
            let again = format.records(&canonical).next().unwrap().unwrap();
            assert!(again.is_canonical(&format));
        }
    }
}

#[test]
fn axis_bits_in_a_slow_byte_are_an_error_or_ignored() {
    for (place, axis) in [(0, Axis::Disc), (1, Axis::Elbow), (2, Axis::Shoulder)] {
        for bits in [0x20, 0x40, 0x60] {
            let mut bytes = [0x05, 0x86, 0x07];
            bytes[place] |= bits;
            let error = STRICT.decode(bytes).unwrap_err();
            assert_eq!(error.offset, place as u64);
            let byte = bytes[place];
            assert_eq!(error.kind, DecodeErrorKind::SlowAxisBits { axis, byte });
            assert_eq!(LENIENT.decode(bytes), Ok(slow(-6, 7, 5)));
            assert_eq!(LENIENT.canonical(bytes), Ok([0x05, 0x86, 0x07]));
        }
    }
    assert_eq!(
        STRICT.decode([0x05, 0x06, 0x47]).unwrap_err().to_string(),
        "pattern byte 2: 0x47 has D6 or D5 set for shoulder in a SLOW record"
    );
}

#[test]
fn the_first_error_of_a_record_is_the_one_reported() {
    let error = STRICT.decode([0x20, 0x1F, 0x00]).unwrap_err();
    assert_eq!(error.offset, 0);
    let error = LENIENT.decode([0x20, 0x3F, 0x1F]).unwrap_err();
    assert_eq!(error.offset, 1);
}

/// Written from the bit table alone.
fn canonical_by_bits(bytes: [u8; 3], strictness: Strictness) -> Option<[u8; 3]> {
    let [first, second, third] = bytes;
    if first & 0x1F == 0x1F {
        let empty = second == 0 && third == 0;
        return Some([if empty { first & 0x7F } else { first }, second, third]);
    }
    let full = |byte: u8| byte & 0x1F == 0x1F;
    let marked = bytes.iter().any(|byte| byte & 0x60 != 0);
    if full(second) || full(third) || (strictness == Strictness::Strict && marked) {
        return None;
    }
    Some(bytes.map(|byte| if byte & 0x1F == 0 { 0 } else { byte & 0x9F }))
}

fn check_all_records(format: &Format) {
    for word in 0..1_u32 << 24 {
        let [_, a, b, c] = word.to_be_bytes();
        let bytes = [a, b, c];
        let expected = canonical_by_bits(bytes, format.strictness);
        assert_eq!(format.canonical(bytes).ok(), expected, "{bytes:02X?}");
    }
}

#[test]
fn all_16777216_records_are_accepted_or_refused_by_the_bit_table_strict() {
    check_all_records(&STRICT);
}

#[test]
fn all_16777216_records_are_accepted_or_refused_by_the_bit_table_lenient() {
    check_all_records(&LENIENT);
}
