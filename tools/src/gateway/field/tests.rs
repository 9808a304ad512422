use proptest::prelude::*;
use serde_json::{Value, json};

use super::Field;

fn field(settings: &str) -> Field {
    let field: Field = toml::from_str(&format!("name = \"f\"\n{settings}")).unwrap();
    field.check(4096).unwrap();
    field
}

fn value(settings: &str, telegram: &[u8]) -> Result<Value, String> {
    let field = field(settings);
    let decoded = field.decode(telegram)?;
    Ok(json!(decoded)["value"].take())
}

#[test]
fn values() {
    for (settings, telegram, expected) in [
        ("offset = 1\ntype = \"u8\"", &[0, 200][..], json!(200)),
        ("offset = 0\ntype = \"i8\"", &[0xFE], json!(-2)),
        ("offset = 0\ntype = \"u16le\"", &[0x34, 0x12], json!(0x1234)),
        (
            "offset = 0\ntype = \"i16be\"\nscale = 0.1",
            &[0, 3],
            json!(0.3),
        ),
        (
            "offset = 0\ntype = \"u32be\"",
            &[0xFF; 4],
            json!(4_294_967_295_u32),
        ),
        ("offset = 0\ntype = \"i32le\"", &[0xFF; 4], json!(-1)),
        (
            "offset = 0\ntype = \"f32be\"",
            &[0x3F, 0x8C, 0xCC, 0xCD],
            json!(1.1),
        ),
        (
            "offset = 0\ntype = \"bcd\"\nlength = 2",
            &[0x12, 0x34],
            json!(1234),
        ),
        ("offset = 0\ntype = \"bit\"\nbit = 7", &[0x80], json!(true)),
        (
            "offset = 0\ntype = \"text\"\nlength = 3",
            b"kg ",
            json!("kg"),
        ),
    ] {
        assert_eq!(value(settings, telegram), Ok(expected), "{settings}");
    }
}

#[test]
fn what_is_not_there_is_told() {
    for (settings, telegram, error) in [
        (
            "offset = 2\ntype = \"u16be\"",
            &[0; 3][..],
            "bytes 2 to 3 of 3",
        ),
        (
            "offset = 0\ntype = \"bcd\"\nlength = 1",
            &[0x1A],
            "1A is no BCD",
        ),
        (
            "offset = 0\ntype = \"f32le\"",
            &[0, 0, 0xC0, 0x7F],
            "NaN is no number",
        ),
    ] {
        assert_eq!(
            value(settings, telegram),
            Err(error.to_owned()),
            "{settings}"
        );
    }
}

#[test]
fn settings_that_do_not_fit() {
    for (settings, error) in [
        ("type = \"text\"", "this type needs a length"),
        ("type = \"u8\"\nlength = 1", "this type has its own length"),
        ("type = \"bcd\"\nlength = 8", "8 bytes of BCD, at most 7"),
        ("type = \"bit\"\nbit = 8", "this type needs a bit, 0 to 7"),
        ("type = \"u8\"\nbit = 0", "only type `bit` has a bit"),
        (
            "type = \"text\"\nlength = 1\nscale = 2.0",
            "only numbers have a scale",
        ),
        ("type = \"u8\"\nscale = 0.0", "0 is no scale"),
    ] {
        let field: Field =
            toml::from_str(&format!("name = \"f\"\noffset = 0\n{settings}")).unwrap();
        assert_eq!(field.check(4096), Err(error.to_owned()), "{settings}");
    }
}

/// Every type of a number, with its bytes.
const NUMBERS: [(&str, usize); 13] = [
    ("u8", 1),
    ("i8", 1),
    ("u16be", 2),
    ("u16le", 2),
    ("i16be", 2),
    ("i16le", 2),
    ("u32be", 4),
    ("u32le", 4),
    ("i32be", 4),
    ("i32le", 4),
    ("f32be", 4),
    ("f32le", 4),
    ("bcd\"\nlength = 7\n#\"", 7),
];

proptest! {
    /// What was decoded is encoded to the same bytes, scaled or not.
    #[test]
    fn round_trip(index in 0..NUMBERS.len(), bytes: [u8; 7], scale in prop::option::of(1e-3..1e3)) {
        let (kind, len) = NUMBERS[index];
        let scale = scale.filter(|_| !kind.starts_with('f'));
        let scale = scale.map_or(String::new(), |scale| format!("\nscale = {scale:?}"));
        let field = field(&format!("offset = 0\ntype = \"{kind}\"{scale}"));
        // Twelve digits of a scaled number are not enough for 14 of BCD.
        prop_assume!(!kind.starts_with("bcd") || scale.is_empty());
        if let Ok(decoded) = field.decode(&bytes[..len]) {
            let decoded = serde_json::to_value(decoded).unwrap();
            // -0.0 is the one float with two forms.
            prop_assume!(decoded["value"] != json!(-0.0) || !kind.starts_with('f'));
            prop_assert_eq!(field.encode(&decoded["value"]), Ok(bytes[..len].to_vec()));
        }
    }
}

#[test]
fn what_cannot_be_written() {
    for (settings, value, error) in [
        ("type = \"u8\"", json!(256), "256 does not fit"),
        ("type = \"u16be\"", json!(-1), "-1 does not fit"),
        (
            "type = \"i16be\"\nscale = 0.1",
            json!(1e9),
            "1000000000.0 does not fit",
        ),
        ("type = \"bcd\"\nlength = 1", json!(100), "100 does not fit"),
        ("type = \"f32be\"", json!(1e39), "1e+39 does not fit"),
        ("type = \"u8\"", json!("1"), "\"1\" is no number"),
        (
            "type = \"text\"\nlength = 1",
            json!("ab"),
            "\"ab\" is longer than 1 bytes",
        ),
        (
            "type = \"bit\"\nbit = 0",
            json!(1),
            "1: a single bit cannot be written",
        ),
    ] {
        let encoded = field(&format!("offset = 0\n{settings}")).encode(&value);
        assert_eq!(encoded, Err(error.to_owned()), "{settings}");
    }
}
