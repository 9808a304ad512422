//! What stands at which place of a telegram.

mod kind;

use core::ops::Range;

use serde::{Deserialize, Serialize};
use serde_json::Value;

pub(crate) use self::kind::Kind;
use super::{config::Name, sparkplug::DataType};
use crate::text;

/// One value in a telegram: `value = raw * scale`.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Field {
    pub(crate) name: Name,
    /// First byte, from 0.
    offset: usize,
    #[serde(rename = "type")]
    kind: Kind,
    /// Bytes of `text` and `bcd`.
    length: Option<usize>,
    /// Of `bit`, 0 the lowest.
    bit: Option<u8>,
    scale: Option<f64>,
    pub(crate) unit: Option<String>,
    /// Home Assistant's class of the quantity, `temperature` for instance.
    pub(crate) device_class: Option<String>,
    /// Home Assistant's class of its course, `total_increasing` for instance.
    state_class: Option<String>,
    /// What may be written, where it is less than the type holds.
    min: Option<f64>,
    max: Option<f64>,
}

/// A value with its unit, as JSON shows it.
#[derive(Serialize)]
pub(crate) struct Decoded<'f> {
    value: Value,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'f str>,
}

/// First bytes of a telegram, as hexadecimal text.
#[derive(Clone, Default, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Pattern(pub(crate) Vec<u8>);

impl TryFrom<String> for Pattern {
    type Error = String;

    fn try_from(hex: String) -> Result<Self, String> {
        let is_half = |word: &&str| !word.len().is_multiple_of(2);
        if let Some(half) = hex.split_whitespace().find(is_half) {
            return Err(format!("`{half}` is not made of whole bytes"));
        }
        text::bytes(hex.split_whitespace()).map(Self)
    }
}

impl Field {
    /// Whether the settings fit together, and into so many bytes.
    pub(crate) fn check(&self, bytes: usize) -> Result<(), String> {
        let kind = self.kind;
        match (kind.has_length(), self.length) {
            (true, None | Some(0)) => return Err("this type needs a length".to_owned()),
            (false, Some(_)) => return Err("this type has its own length".to_owned()),
            (true, Some(length)) if kind == Kind::Bcd && length > Kind::MAX_BCD => {
                return Err(format!("{length} bytes of BCD, at most {}", Kind::MAX_BCD));
            }
            _ => {}
        }
        match (kind == Kind::Bit, self.bit) {
            (true, Some(0..=7)) | (false, None) => {}
            (true, _) => return Err("this type needs a bit, 0 to 7".to_owned()),
            (false, Some(_)) => return Err("only type `bit` has a bit".to_owned()),
        }
        let end = self.range().end;
        if end > bytes {
            return Err(format!("ends at byte {end} of {bytes}"));
        }
        if !self.min.is_none_or(f64::is_finite) || !self.max.is_none_or(f64::is_finite) {
            return Err("min and max are numbers".to_owned());
        }
        match self.scale {
            Some(_) if !kind.is_number() => Err("only numbers have a scale".to_owned()),
            Some(scale) if !scale.is_normal() => Err(format!("{scale} is no scale")),
            _ => Ok(()),
        }
    }

    /// Home Assistant's class of its course: that of any number is a measurement.
    pub(crate) fn state_class(&self) -> Option<&str> {
        let given = self.state_class.as_deref();
        given.or_else(|| self.kind.is_number().then_some("measurement"))
    }

    /// The type of its values in Sparkplug B.
    pub(crate) fn data_type(&self) -> DataType {
        match self.kind {
            _ if self.scale.is_some() => DataType::Double,
            Kind::U8 => DataType::UInt8,
            Kind::U16Be | Kind::U16Le => DataType::UInt16,
            Kind::U32Be | Kind::U32Le => DataType::UInt32,
            Kind::I8 | Kind::I16Be | Kind::I16Le | Kind::I32Be | Kind::I32Le => DataType::Int32,
            Kind::F32Be | Kind::F32Le => DataType::Float,
            Kind::Bcd => DataType::UInt64,
            Kind::Bit => DataType::Boolean,
            Kind::Text => DataType::String,
        }
    }

    /// Whether it begins and ends with a word.
    pub(crate) fn is_made_of_words(&self) -> bool {
        let range = self.range();
        range.start.is_multiple_of(2) && range.len().is_multiple_of(2)
    }

    /// The least and the largest value, and the step from one to the next, of what may be written
    /// alone: a number of whole words.
    pub(crate) fn scale_to_write(&self) -> Option<(f64, f64, f64)> {
        if !self.is_made_of_words() {
            return None;
        }
        let range = self.range();
        let scale = self.scale.unwrap_or(1.0);
        let holds = self.kind.holds(range.len());
        let (one, other) = holds.map_or((None, None), |(least, largest)| {
            (Some(rounded(least * scale)), Some(rounded(largest * scale)))
        });
        let (least, largest) = if scale < 0.0 {
            (other, one)
        } else {
            (one, other)
        };
        let step = if self.kind.is_whole() {
            scale.abs()
        } else {
            0.001
        };
        Some((self.min.or(least)?, self.max.or(largest)?, step))
    }

    /// The bytes that it takes.
    pub(crate) fn range(&self) -> Range<usize> {
        let length = self.length.or(self.kind.size()).unwrap_or(0);
        self.offset..self.offset.saturating_add(length)
    }

    /// The value in a telegram.
    ///
    /// # Errors
    /// What is wrong with these bytes.
    pub(crate) fn decode(&self, telegram: &[u8]) -> Result<Decoded<'_>, String> {
        let range = self.range();
        let Some(bytes) = telegram.get(range.clone()) else {
            let len = telegram.len();
            return Err(format!(
                "bytes {} to {} of {len}",
                range.start,
                range.end - 1
            ));
        };
        let value = match self.kind {
            Kind::Text => Value::from(String::from_utf8_lossy(bytes).trim_end()),
            Kind::Bit => {
                let byte = bytes.first().copied().unwrap_or(0);
                Value::from(byte >> self.bit.unwrap_or(0) & 1 == 1)
            }
            kind => self.scaled(kind.number(bytes)?),
        };
        Ok(Decoded {
            value,
            unit: self.unit.as_deref(),
        })
    }

    /// Whole numbers stay whole, without a scale.
    fn scaled(&self, raw: kind::Number) -> Value {
        match (raw, self.scale) {
            (kind::Number::Signed(raw), None) => Value::from(raw),
            (kind::Number::Unsigned(raw), None) => Value::from(raw),
            (kind::Number::Float(raw), None) => Value::from(raw),
            (raw, Some(scale)) => Value::from(rounded(raw.to_f64() * scale)),
        }
    }

    /// Puts a value into what it is a part of; a bit is `true` or `false`.
    ///
    /// # Errors
    /// A value of another type, or that does not fit.
    pub(crate) fn put(&self, value: &Value, bytes: &mut [u8]) -> Result<(), String> {
        let range = self.range();
        let end = range.end;
        let place = bytes
            .get_mut(range)
            .ok_or_else(|| format!("ends at byte {end}"))?;
        if self.kind != Kind::Bit {
            place.copy_from_slice(&self.encode(value)?);
            return Ok(());
        }
        let is_set = value
            .as_bool()
            .ok_or_else(|| format!("{value} is not true or false"))?;
        let mask = 1 << self.bit.unwrap_or(0);
        for byte in place {
            *byte = if is_set { *byte | mask } else { *byte & !mask };
        }
        Ok(())
    }

    /// The bytes that a value takes: `raw = value / scale`, rounded to the nearest.
    ///
    /// # Errors
    /// A value of another type, or that does not fit.
    pub(crate) fn encode(&self, value: &Value) -> Result<Vec<u8>, String> {
        let length = self.range().len();
        if self.kind == Kind::Text {
            let text = value
                .as_str()
                .ok_or_else(|| format!("{value} is no text"))?;
            let mut bytes = text.as_bytes().to_vec();
            if bytes.len() > length {
                return Err(format!("{value} is longer than {length} bytes"));
            }
            bytes.resize(length, b' ');
            return Ok(bytes);
        }
        let bytes = match (self.scale, value) {
            (_, Value::Number(number)) if self.kind == Kind::Bit => {
                return Err(format!("{number}: a single bit cannot be written"));
            }
            (None, Value::Number(number)) => match number.as_i128() {
                Some(whole) => self.kind.bytes_of_whole(whole, length),
                None => number
                    .as_f64()
                    .and_then(|raw| self.kind.bytes_of(raw, length)),
            },
            (Some(scale), Value::Number(number)) => number
                .as_f64()
                .and_then(|value| self.kind.bytes_of(value / scale, length)),
            _ => return Err(format!("{value} is no number")),
        };
        bytes.ok_or_else(|| format!("{value} does not fit"))
    }
}

/// To twelve digits: 3 * 0.1 is 0.3.
fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests;
