//! Serialized settings and records: names as documented, values validated when read.

use pattern_codec::engraving::{
    Axis, AxisCodes, ByteOrder, Fast, Format, Record, Statistics, Strictness,
};
use serde_json::{from_str, json, to_value};
use test_support::{not_read, stored};

use crate::common::{fast, per_axis, slow};

#[test]
fn a_format_is_read_and_written_by_name() {
    let codes = per_axis([3, 2, 1, 0]);
    let format = Format::new()
        .with_axis_codes(AxisCodes::new(codes).unwrap())
        .with_byte_order(ByteOrder::LittleEndian)
        .with_strictness(Strictness::Lenient);
    let value = json!({
        "axis_codes": { "elbow": 3, "shoulder": 2, "disc": 1, "vertical": 0 },
        "byte_order": "little_endian",
        "strictness": "lenient",
    });
    assert_eq!(to_value(format).unwrap(), value);
    assert_eq!(from_str::<Format>(&value.to_string()).unwrap(), format);
    assert_eq!(from_str::<Format>("{}").unwrap(), Format::new());
}

#[test]
fn wrong_settings_are_refused_with_the_reason() {
    for (text, reason) in [
        (
            r#"{"axis_codes": {"elbow": 0, "shoulder": 1, "disc": 1, "vertical": 3}}"#,
            "shoulder and disc: both have the axis code 1",
        ),
        (
            r#"{"axis_codes": {"elbow": 0, "shoulder": 1, "disc": 2, "vertical": 9}}"#,
            "vertical: axis code 9 is above 3",
        ),
        (r#"{"byte_order": "middle"}"#, "unknown variant `middle`"),
        (
            r#"{"byteorder": "big_endian"}"#,
            "unknown field `byteorder`",
        ),
    ] {
        let error = not_read::<Format>(text);
        assert!(error.contains(reason), "{error}");
    }
}

#[test]
fn records_are_read_within_their_range_only() {
    for (record, value) in [
        (
            fast(Axis::Vertical, -65_535),
            json!({ "fast": { "axis": "vertical", "pulses": -65_535 } }),
        ),
        (
            slow(-30, 30, 1),
            json!({ "slow": { "elbow": -30, "shoulder": 30, "disc": 1 } }),
        ),
    ] {
        assert_eq!(to_value(record).unwrap(), value);
        stored(&record);
    }
    for (text, reason) in [
        (
            r#"{"fast": {"axis": "elbow", "pulses": 65536}}"#,
            "elbow: 65536 pulses do not fit",
        ),
        (
            r#"{"slow": {"elbow": 0, "shoulder": -31, "disc": 0}}"#,
            "shoulder: -31 pulses do not fit",
        ),
    ] {
        let error = not_read::<Record>(text);
        assert!(error.contains(reason), "{error}");
    }
}

#[test]
fn statistics_are_written_by_name() {
    let fast = Fast::new(Axis::Shoulder, -7).unwrap();
    let statistics: Statistics = [fast.into()].into_iter().collect();
    let value = to_value(statistics).unwrap();
    assert_eq!(value["fast_records"], 1);
    assert_eq!(value["pulses"]["shoulder"], 7);
    stored(&statistics);
}
