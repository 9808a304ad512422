//! Types of metrics, and values between JSON and messages.

use serde_json::Value as Json;

use super::payload::Value;
use crate::text;

/// A type of Sparkplug B, by its number there. Signed numbers of 8 and 16 bits are `Int32`:
/// libraries disagree on how the shorter ones stand in the 32 bits of the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DataType {
    Int32 = 3,
    Int64 = 4,
    UInt8 = 5,
    UInt16 = 6,
    UInt32 = 7,
    UInt64 = 8,
    Float = 9,
    Double = 10,
    Boolean = 11,
    String = 12,
    Bytes = 17,
}

impl DataType {
    /// The value that a JSON of this gateway shows; bytes are hexadecimal. `None` for one of
    /// another type.
    pub(super) fn value(self, json: &Json) -> Option<Value> {
        Some(match self {
            Self::Int32 => Value::Int(i32::try_from(json.as_i64()?).ok()?.cast_unsigned()),
            Self::Int64 => Value::Long(json.as_i64()?.cast_unsigned()),
            Self::UInt8 => Value::Int(u8::try_from(json.as_u64()?).ok()?.into()),
            Self::UInt16 => Value::Int(u16::try_from(json.as_u64()?).ok()?.into()),
            Self::UInt32 => Value::Int(u32::try_from(json.as_u64()?).ok()?),
            Self::UInt64 => Value::Long(json.as_u64()?),
            #[expect(clippy::cast_possible_truncation, reason = "it was one of 32 bits")]
            Self::Float => Value::Float(json.as_f64()? as f32),
            Self::Double => Value::Double(json.as_f64()?),
            Self::Boolean => Value::Boolean(json.as_bool()?),
            Self::String => Value::String(json.as_str()?.to_owned()),
            Self::Bytes => Value::Bytes(text::bytes(json.as_str()?.split_whitespace()).ok()?),
        })
    }

    /// The JSON of a value that came as this type.
    pub(super) fn json(self, value: &Value) -> Option<Json> {
        Some(match (self, value) {
            (Self::Int32, Value::Int(value)) => value.cast_signed().into(),
            (Self::UInt8 | Self::UInt16 | Self::UInt32, Value::Int(value)) => (*value).into(),
            // Some hosts send unsigned numbers of 32 bits as long ones.
            (Self::UInt32 | Self::UInt64, Value::Long(value)) => (*value).into(),
            (Self::Int64, Value::Long(value)) => value.cast_signed().into(),
            // The shortest decimal number that is this float.
            (Self::Float, Value::Float(value)) => value.to_string().parse::<f64>().ok()?.into(),
            (Self::Float | Self::Double, Value::Double(value)) => (*value).into(),
            (Self::Boolean, Value::Boolean(value)) => (*value).into(),
            (Self::String, Value::String(value)) => value.as_str().into(),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn values_there_and_back() {
        for (data_type, json, value) in [
            (DataType::Int32, json!(-5), Value::Int(0xFFFF_FFFB)),
            (DataType::Int64, json!(-1), Value::Long(u64::MAX)),
            (DataType::UInt8, json!(255), Value::Int(255)),
            (DataType::UInt32, json!(u32::MAX), Value::Int(u32::MAX)),
            (DataType::Float, json!(1.1), Value::Float(1.1)),
            (DataType::Double, json!(12.3), Value::Double(12.3)),
            (DataType::Boolean, json!(true), Value::Boolean(true)),
            (DataType::String, json!("a"), Value::String("a".to_owned())),
        ] {
            assert_eq!(data_type.value(&json), Some(value.clone()), "{json}");
            assert_eq!(data_type.json(&value), Some(json));
        }
        let bytes = DataType::Bytes.value(&json!("57 00"));
        assert_eq!(bytes, Some(Value::Bytes(vec![0x57, 0])));
        assert_eq!(DataType::UInt8.value(&json!(256)), None);
        assert_eq!(DataType::UInt8.value(&json!(-1)), None);
        assert_eq!(DataType::Boolean.json(&Value::Int(1)), None);
    }
}
