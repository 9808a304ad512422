//! What the source leaves open: axis codes, byte order, strictness.

use thiserror::Error;

use super::{Axis, PerAxis};

/// Which two-bit code in D6 D5 of a FAST record names which axis: distinct, 0..=3.
///
/// The default is 0 elbow, 1 shoulder, 2 disc, 3 vertical; [Engraver 2000] does not print the
/// codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(try_from = "PerAxis<u8>", into = "PerAxis<u8>")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AxisCodes {
    codes: PerAxis<u8>,
    /// The inverse, two bits for each code: the axis of code 0 in D1 D0.
    axes: u8,
}

impl AxisCodes {
    const DEFAULT: Self = Self {
        codes: PerAxis {
            elbow: 0,
            shoulder: 1,
            disc: 2,
            vertical: 3,
        },
        axes: 0b11_10_01_00,
    };

    /// Checks the code of each axis.
    ///
    /// # Errors
    /// [`AxisCodeError`] for a code above 3 or one given twice.
    pub fn new(codes: PerAxis<u8>) -> Result<Self, AxisCodeError> {
        let mut owners = PerAxis::<Option<Axis>>::default();
        let mut axes = 0;
        for axis in Axis::ALL {
            let code = *codes.get(axis);
            if code > 3 {
                return Err(AxisCodeError::TooLarge { axis, code });
            }
            if let Some(first) = owners.get_mut(Axis::from_index(code)).replace(axis) {
                return Err(AxisCodeError::Repeated {
                    first,
                    second: axis,
                    code,
                });
            }
            axes |= axis.index() << shift(code);
        }
        Ok(Self { codes, axes })
    }

    /// The code of an axis, 0..=3.
    #[must_use]
    #[inline]
    pub const fn code(&self, axis: Axis) -> u8 {
        *self.codes.get(axis)
    }

    /// The axis of a code; only the low two bits count.
    #[must_use]
    #[inline]
    pub const fn axis(&self, code: u8) -> Axis {
        Axis::from_index(self.axes >> shift(code))
    }

    /// The code of every axis.
    #[must_use]
    pub const fn codes(&self) -> PerAxis<u8> {
        self.codes
    }
}

/// The lower of the two bits of an index 0..=3: 0, 2, 4 or 6.
const fn shift(index: u8) -> u8 {
    (index & 3) << 1
}

impl Default for AxisCodes {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl TryFrom<PerAxis<u8>> for AxisCodes {
    type Error = AxisCodeError;

    fn try_from(codes: PerAxis<u8>) -> Result<Self, AxisCodeError> {
        Self::new(codes)
    }
}

impl From<AxisCodes> for PerAxis<u8> {
    fn from(codes: AxisCodes) -> Self {
        codes.codes
    }
}

/// Why a set of axis codes was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AxisCodeError {
    /// The code does not fit into two bits.
    #[error("{axis}: axis code {code} is above 3")]
    TooLarge {
        /// The axis with the wrong code.
        axis: Axis,
        /// Its code.
        code: u8,
    },
    /// Two axes have one code.
    #[error("{first} and {second}: both have the axis code {code}")]
    Repeated {
        /// The axis that has the code.
        first: Axis,
        /// The axis that has it again.
        second: Axis,
        /// The code.
        code: u8,
    },
}

/// Order of the two count bytes of a FAST record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "two bytes have two orders")]
pub enum ByteOrder {
    /// High byte first, as the 8051 assemblers and Keil C51 store words.
    #[default]
    BigEndian,
    /// Low byte first.
    LittleEndian,
}

/// What a decoder does with bytes that [Engraver 2000] does not describe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_enums,
    reason = "a caller must know what each strictness lets pass"
)]
pub enum Strictness {
    /// D6 or D5 set in a SLOW byte is an error, and decoding ends at the first error.
    #[default]
    Strict,
    /// D6 and D5 of a SLOW byte are ignored. After an error decoding goes on with the next three
    /// bytes: records have one length, so the next one starts there.
    Lenient,
}

/// Settings of the pattern bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Format {
    /// Axis codes of FAST records.
    pub axis_codes: AxisCodes,
    /// Byte order of the pulse count of FAST records.
    pub byte_order: ByteOrder,
    /// How strictly bytes are decoded. Encoding does not depend on it.
    pub strictness: Strictness,
}

impl Format {
    /// The default of every setting.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            axis_codes: AxisCodes::DEFAULT,
            byte_order: ByteOrder::BigEndian,
            strictness: Strictness::Strict,
        }
    }

    /// The same format with other axis codes.
    #[must_use]
    pub const fn with_axis_codes(self, axis_codes: AxisCodes) -> Self {
        Self { axis_codes, ..self }
    }

    /// The same format with another byte order.
    #[must_use]
    pub const fn with_byte_order(self, byte_order: ByteOrder) -> Self {
        Self { byte_order, ..self }
    }

    /// The same format with another strictness.
    #[must_use]
    pub const fn with_strictness(self, strictness: Strictness) -> Self {
        Self { strictness, ..self }
    }
}

impl Default for Format {
    fn default() -> Self {
        Self::new()
    }
}
