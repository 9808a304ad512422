//! Numbers and their bytes.

use serde::Deserialize;

/// How a value stands in its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    U8,
    I8,
    U16Be,
    U16Le,
    I16Be,
    I16Le,
    U32Be,
    U32Le,
    I32Be,
    I32Le,
    F32Be,
    F32Le,
    /// Two decimal digits a byte, the high ones first.
    Bcd,
    /// One bit of a byte.
    Bit,
    /// Characters; spaces at the end do not count.
    Text,
}

/// A number as it stands in a telegram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    Signed(i64),
    Unsigned(u64),
    Float(f64),
}

impl Number {
    #[expect(
        clippy::cast_precision_loss,
        reason = "at most 32 bits, or 15 digits of BCD"
    )]
    pub(super) const fn to_f64(self) -> f64 {
        match self {
            Self::Signed(value) => value as f64,
            Self::Unsigned(value) => value as f64,
            Self::Float(value) => value,
        }
    }
}

impl Kind {
    /// Bytes of the longest BCD number: 14 digits, which a float holds exactly.
    pub(super) const MAX_BCD: usize = 7;

    pub(super) const fn has_length(self) -> bool {
        matches!(self, Self::Text | Self::Bcd)
    }

    pub(super) const fn is_number(self) -> bool {
        !matches!(self, Self::Text | Self::Bit)
    }

    pub(super) const fn is_whole(self) -> bool {
        self.is_number() && !matches!(self, Self::F32Be | Self::F32Le)
    }

    /// The least and the largest whole number of so many bytes.
    pub(super) fn holds(self, length: usize) -> Option<(f64, f64)> {
        Some(match self {
            Self::U8 => (0.0, u8::MAX.into()),
            Self::I8 => (i8::MIN.into(), i8::MAX.into()),
            Self::U16Be | Self::U16Le => (0.0, u16::MAX.into()),
            Self::I16Be | Self::I16Le => (i16::MIN.into(), i16::MAX.into()),
            Self::U32Be | Self::U32Le => (0.0, u32::MAX.into()),
            Self::I32Be | Self::I32Le => (i32::MIN.into(), i32::MAX.into()),
            Self::Bcd => {
                let digits = i32::try_from(2 * length).ok()?;
                (0.0, 10_f64.powi(digits) - 1.0)
            }
            Self::F32Be | Self::F32Le | Self::Bit | Self::Text => return None,
        })
    }

    /// Bytes, where the type says it.
    pub(super) const fn size(self) -> Option<usize> {
        match self {
            Self::U8 | Self::I8 | Self::Bit => Some(1),
            Self::U16Be | Self::U16Le | Self::I16Be | Self::I16Le => Some(2),
            Self::U32Be | Self::U32Le | Self::I32Be | Self::I32Le | Self::F32Be | Self::F32Le => {
                Some(4)
            }
            Self::Bcd | Self::Text => None,
        }
    }

    /// The number in these bytes, which are as many as the type takes.
    ///
    /// # Errors
    /// A float that is no number, a BCD digit above 9.
    pub(super) fn number(self, bytes: &[u8]) -> Result<Number, String> {
        Ok(match self {
            Self::U8 => Number::Unsigned(u8::from_be_bytes(array(bytes)).into()),
            Self::I8 => Number::Signed(i8::from_be_bytes(array(bytes)).into()),
            Self::U16Be => Number::Unsigned(u16::from_be_bytes(array(bytes)).into()),
            Self::U16Le => Number::Unsigned(u16::from_le_bytes(array(bytes)).into()),
            Self::I16Be => Number::Signed(i16::from_be_bytes(array(bytes)).into()),
            Self::I16Le => Number::Signed(i16::from_le_bytes(array(bytes)).into()),
            Self::U32Be => Number::Unsigned(u32::from_be_bytes(array(bytes)).into()),
            Self::U32Le => Number::Unsigned(u32::from_le_bytes(array(bytes)).into()),
            Self::I32Be => Number::Signed(i32::from_be_bytes(array(bytes)).into()),
            Self::I32Le => Number::Signed(i32::from_le_bytes(array(bytes)).into()),
            Self::F32Be => float(f32::from_be_bytes(array(bytes)))?,
            Self::F32Le => float(f32::from_le_bytes(array(bytes)))?,
            Self::Bcd => Number::Unsigned(decimal(bytes)?),
            Self::Bit | Self::Text => return Err("no number".to_owned()),
        })
    }

    /// The bytes of the nearest number; none when it does not fit.
    pub(super) fn bytes_of(self, value: f64, length: usize) -> Option<Vec<u8>> {
        if matches!(self, Self::F32Be | Self::F32Le) {
            #[expect(clippy::cast_possible_truncation, reason = "to the nearest")]
            let value = value as f32;
            return value.is_finite().then(|| match self {
                Self::F32Be => value.to_be_bytes().to_vec(),
                _ => value.to_le_bytes().to_vec(),
            });
        }
        let whole = value.round();
        /// Beyond what any of these types holds.
        const LIMIT: f64 = 1e15;
        #[expect(clippy::cast_possible_truncation, reason = "within the limit")]
        let whole = (whole.abs() < LIMIT).then_some(whole as i128)?;
        self.bytes_of_whole(whole, length)
    }

    /// The bytes of a whole number; none when it does not fit.
    pub(super) fn bytes_of_whole(self, value: i128, length: usize) -> Option<Vec<u8>> {
        Some(match self {
            Self::U8 => u8::try_from(value).ok()?.to_be_bytes().to_vec(),
            Self::I8 => i8::try_from(value).ok()?.to_be_bytes().to_vec(),
            Self::U16Be => u16::try_from(value).ok()?.to_be_bytes().to_vec(),
            Self::U16Le => u16::try_from(value).ok()?.to_le_bytes().to_vec(),
            Self::I16Be => i16::try_from(value).ok()?.to_be_bytes().to_vec(),
            Self::I16Le => i16::try_from(value).ok()?.to_le_bytes().to_vec(),
            Self::U32Be => u32::try_from(value).ok()?.to_be_bytes().to_vec(),
            Self::U32Le => u32::try_from(value).ok()?.to_le_bytes().to_vec(),
            Self::I32Be => i32::try_from(value).ok()?.to_be_bytes().to_vec(),
            Self::I32Le => i32::try_from(value).ok()?.to_le_bytes().to_vec(),
            #[expect(clippy::cast_precision_loss, reason = "to the nearest")]
            Self::F32Be | Self::F32Le => return self.bytes_of(value as f64, length),
            Self::Bcd => return digits(u64::try_from(value).ok()?, length),
            Self::Bit | Self::Text => return None,
        })
    }
}

/// The first bytes; zeros in place of those that are missing.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.first_chunk().copied().unwrap_or([0; N])
}

/// The shortest decimal number that is this float: 1.1, not 1.10000002.
fn float(value: f32) -> Result<Number, String> {
    match value.to_string().parse() {
        Ok(value) if f64::is_finite(value) => Ok(Number::Float(value)),
        _ => Err(format!("{value} is no number")),
    }
}

fn decimal(bytes: &[u8]) -> Result<u64, String> {
    let mut number = 0;
    for byte in bytes {
        let (high, low) = (byte >> 4, byte & 0xF);
        if high > 9 || low > 9 {
            return Err(format!("{byte:02X} is no BCD"));
        }
        number = number * 100 + u64::from(high * 10 + low);
    }
    Ok(number)
}

fn digits(mut number: u64, length: usize) -> Option<Vec<u8>> {
    let mut bytes = vec![0; length];
    for byte in bytes.iter_mut().rev() {
        let pair = u8::try_from(number % 100).ok()?;
        *byte = ((pair / 10) << 4) | (pair % 10);
        number /= 100;
    }
    (number == 0).then_some(bytes)
}
