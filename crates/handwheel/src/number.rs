//! Numbers that a telegram carries in one byte, each with its range.

use core::fmt;

use thiserror::Error;

/// A number outside its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{what} {value} is not within {min}..={max}")]
#[non_exhaustive]
pub struct NumberError {
    /// What is numbered.
    pub what: &'static str,
    /// The value refused; of a received byte that lies below the first code, the negative offset.
    pub value: i16,
    /// The lowest.
    pub min: u8,
    /// The highest.
    pub max: u8,
}

macro_rules! number {
    ($(#[$doc:meta])* $name:ident, $what:literal, $min:literal..=$max:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(try_from = "u8", into = "u8"))]
        pub struct $name(u8);

        impl $name {
            /// The lowest number.
            pub const MIN: Self = Self($min);
            /// The highest number.
            pub const MAX: Self = Self($max);

            #[doc = concat!("Checks the range, ", stringify!($min..=$max), ".")]
            ///
            /// # Errors
            /// [`NumberError`] outside of it.
            pub const fn new(number: u8) -> Result<Self, NumberError> {
                Self::checked(number as i16)
            }

            /// The number.
            #[must_use]
            pub const fn get(self) -> u8 {
                self.0
            }

            /// From its byte in a telegram, where `zero` stands for 0.
            pub(crate) const fn from_code(code: u8, zero: u8) -> Result<Self, NumberError> {
                Self::checked(code as i16 - zero as i16)
            }

            /// Its byte in a telegram; no range reaches past `FFh`.
            pub(crate) const fn code(self, zero: u8) -> u8 {
                self.0.wrapping_add(zero)
            }

            const fn checked(value: i16) -> Result<Self, NumberError> {
                if value < $min || value > $max {
                    let (what, min, max) = ($what, $min, $max);
                    return Err(NumberError { what, value, min, max });
                }
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "checked to lie in the range of a byte"
                )]
                Ok(Self(value as u8))
            }
        }

        impl TryFrom<u8> for $name {
            type Error = NumberError;

            fn try_from(number: u8) -> Result<Self, NumberError> {
                Self::new(number)
            }
        }

        impl From<$name> for u8 {
            fn from(number: $name) -> Self {
                number.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

number! {
    /// A key: 1 to 12 on the HBLS, 1 to 20 on the HBAS.
    Key, "key", 1..=20
}
number! {
    /// The position of a rotary switch, 1 to 12.
    Position, "position", 1..=12
}
number! {
    /// An LED of the HBLS, 1 to 12.
    Led, "LED", 1..=12
}
number! {
    /// A line of the display, 0 to 7 from the top.
    Line, "line", 0..=7
}
number! {
    /// A column of the display, 0 to 15 from the left.
    Column, "column", 0..=15
}
number! {
    /// A text that the unit stores, 1 to 200.
    TextNumber, "text", 1..=200
}
number! {
    /// An area of the display that the unit stores, 1 to 32.
    AreaNumber, "area", 1..=32
}
