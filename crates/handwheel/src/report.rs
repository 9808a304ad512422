//! What the unit says.

use thiserror::Error;

use crate::number::{Key, NumberError, Position};

/// Bytes of the longest report.
pub const MAX_REPORT: usize = 3;

/// Bytes of the longest telegram to any unit: a display block of the HBAS.
pub const MAX_COMMAND: usize = Model::Hbas.max_lcd_block();

/// First byte of everything about the display.
pub(crate) const LCD: u8 = 0x6C;
const KEY_0: u8 = 0x30;
const W1_0: u8 = 0x40;
const W2_0: u8 = 0x50;
/// Keys of the HBLS; the bytes after theirs belong to the rotary switches.
const HBLS_KEYS: u8 = 12;

/// Which unit: their telegrams share bytes, but not all meanings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Model {
    /// 12 keys, two rotary switches, 12 LEDs; answers a display block by an own telegram.
    #[default]
    Hbls,
    /// 20 keys; its status reply says whether the last display block was right.
    Hbas,
}

impl Model {
    /// The longest display block in bytes, its first byte included: 128 and 135.
    #[must_use]
    pub const fn max_lcd_block(self) -> usize {
        match self {
            Self::Hbls => 128,
            Self::Hbas => 135,
        }
    }
}

/// One of the two rotary switches of the HBLS.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_enums, reason = "the unit has two")]
pub enum RotarySwitch {
    /// The first.
    W1,
    /// The second.
    W2,
}

/// The unit's word on a display block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum LcdAnswer {
    /// 31h: carried out.
    Done,
    /// 32h: a text that was not defined.
    NoSuchText,
    /// 33h: an area that was not defined.
    NoSuchArea,
    /// 34h: a bad parameter.
    BadParameter,
    /// 35h, HBAS: too many parameters.
    TooManyParameters,
    /// 36h, HBAS: an area overlaps text in the large font.
    AreaOverlap,
}

impl LcdAnswer {
    const ALL: [Self; 6] = [
        Self::Done,
        Self::NoSuchText,
        Self::NoSuchArea,
        Self::BadParameter,
        Self::TooManyParameters,
        Self::AreaOverlap,
    ];

    /// The byte of the telegram.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Done => 0x31,
            Self::NoSuchText => 0x32,
            Self::NoSuchArea => 0x33,
            Self::BadParameter => 0x34,
            Self::TooManyParameters => 0x35,
            Self::AreaOverlap => 0x36,
        }
    }

    fn from_code(code: u8, index: usize, model: Model) -> Result<Self, DecodeError> {
        let named = Self::ALL.into_iter().find(|answer| answer.code() == code);
        named
            .filter(|answer| model == Model::Hbas || answer.is_hbls())
            .ok_or(DecodeError::Unknown { index, byte: code })
    }

    const fn is_hbls(self) -> bool {
        !matches!(self, Self::TooManyParameters | Self::AreaOverlap)
    }
}

/// The reply to a status request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Status {
    /// The status of an HBLS, 3 bytes.
    Hbls {
        /// The key that is down.
        key: Option<Key>,
        /// Where the first rotary switch stands.
        w1: Position,
        /// Where the second rotary switch stands.
        w2: Position,
    },
    /// The status of an HBAS, 2 bytes.
    Hbas {
        /// The key that is down.
        key: Option<Key>,
        /// How the last display block went.
        lcd: LcdAnswer,
    },
}

impl Status {
    /// The key that is down.
    #[must_use]
    pub const fn key(self) -> Option<Key> {
        match self {
            Self::Hbls { key, .. } | Self::Hbas { key, .. } => key,
        }
    }
}

/// A telegram from the unit to the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Report {
    /// A key went down, or all are released. Of several keys the unit reports the first alone.
    Key(Option<Key>),
    /// A rotary switch was turned.
    RotarySwitch {
        /// Which.
        switch: RotarySwitch,
        /// To where.
        position: Position,
    },
    /// The reply to a status request.
    Status(Status),
    /// The answer of the HBLS to a display block.
    Lcd(LcdAnswer),
}

/// Why a telegram of the unit means nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DecodeError {
    /// No telegram of this length begins so.
    #[error("{len} bytes are no telegram of this unit")]
    Length {
        /// Bytes received.
        len: usize,
    },
    /// A byte that means nothing at this index.
    #[error("byte {index}: {byte:02X}h means nothing there")]
    Unknown {
        /// Its index.
        index: usize,
        /// The byte.
        byte: u8,
    },
}

/// Why a telegram cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum EncodeError {
    /// The buffer is too short.
    #[error("the telegram has {len} bytes, the buffer holds {capacity}")]
    NoRoom {
        /// Bytes of the telegram.
        len: usize,
        /// Bytes of the buffer.
        capacity: usize,
    },
    /// The other model's telegram.
    #[error("the {model:?} has no such telegram")]
    Model {
        /// The model asked for.
        model: Model,
    },
    /// A key that this unit does not have.
    #[error(transparent)]
    Number(#[from] NumberError),
}

impl Report {
    /// Reads one telegram.
    ///
    /// # Errors
    /// [`DecodeError`] for anything that the unit does not say.
    pub fn decode(model: Model, telegram: &[u8]) -> Result<Self, DecodeError> {
        match (model, telegram) {
            (_, &[byte]) => decode_byte(model, byte),
            (Model::Hbls, &[LCD, answer]) => LcdAnswer::from_code(answer, 1, model).map(Self::Lcd),
            (Model::Hbls, &[key, w1, w2]) => Ok(Self::Status(Status::Hbls {
                key: decode_key(model, key)?,
                w1: decode_position(w1, 1, W1_0)?,
                w2: decode_position(w2, 2, W2_0)?,
            })),
            (Model::Hbas, &[key, answer]) => Ok(Self::Status(Status::Hbas {
                key: decode_key(model, key)?,
                lcd: LcdAnswer::from_code(answer, 1, model)?,
            })),
            (_, other) => Err(DecodeError::Length { len: other.len() }),
        }
    }

    /// Writes the telegram into the head of `buffer`; [`MAX_REPORT`] bytes hold every one.
    ///
    /// # Errors
    /// [`EncodeError`]: the buffer is too short, or the unit has no such telegram.
    pub fn encode(self, model: Model, buffer: &mut [u8]) -> Result<&[u8], EncodeError> {
        let foreign = EncodeError::Model { model };
        match (self, model) {
            (Self::Key(key), _) => put(buffer, &[encode_key(model, key)?]),
            (Self::RotarySwitch { switch, position }, Model::Hbls) => {
                let zero = match switch {
                    RotarySwitch::W1 => W1_0,
                    RotarySwitch::W2 => W2_0,
                };
                put(buffer, &[position.code(zero)])
            }
            (Self::Status(Status::Hbls { key, w1, w2 }), Model::Hbls) => {
                let key = encode_key(model, key)?;
                put(buffer, &[key, w1.code(W1_0), w2.code(W2_0)])
            }
            (Self::Status(Status::Hbas { key, lcd }), Model::Hbas) => {
                put(buffer, &[encode_key(model, key)?, lcd.code()])
            }
            (Self::Lcd(answer), Model::Hbls) if answer.is_hbls() => {
                put(buffer, &[LCD, answer.code()])
            }
            _ => Err(foreign),
        }
    }
}

fn decode_byte(model: Model, byte: u8) -> Result<Report, DecodeError> {
    let switch = |switch, zero| {
        let position = decode_position(byte, 0, zero)?;
        Ok(Report::RotarySwitch { switch, position })
    };
    match (model, byte) {
        (Model::Hbls, 0x41..=0x4C) => switch(RotarySwitch::W1, W1_0),
        (Model::Hbls, 0x51..=0x5C) => switch(RotarySwitch::W2, W2_0),
        _ => decode_key(model, byte).map(Report::Key),
    }
}

fn decode_key(model: Model, byte: u8) -> Result<Option<Key>, DecodeError> {
    if byte == KEY_0 {
        return Ok(None);
    }
    Key::from_code(byte, KEY_0)
        .ok()
        .filter(|&key| has_key(model, key).is_ok())
        .map(Some)
        .ok_or(DecodeError::Unknown { index: 0, byte })
}

fn decode_position(byte: u8, index: usize, zero: u8) -> Result<Position, DecodeError> {
    Position::from_code(byte, zero).map_err(|_| DecodeError::Unknown { index, byte })
}

fn encode_key(model: Model, key: Option<Key>) -> Result<u8, NumberError> {
    let Some(key) = key else { return Ok(KEY_0) };
    has_key(model, key)?;
    Ok(key.code(KEY_0))
}

fn has_key(model: Model, key: Key) -> Result<(), NumberError> {
    if model == Model::Hbls && key.get() > HBLS_KEYS {
        return Err(NumberError {
            what: "key",
            value: key.get().into(),
            min: 1,
            max: HBLS_KEYS,
        });
    }
    Ok(())
}

/// Copies a telegram into the head of a buffer.
pub(crate) fn put<'b>(buffer: &'b mut [u8], telegram: &[u8]) -> Result<&'b [u8], EncodeError> {
    let (len, capacity) = (telegram.len(), buffer.len());
    let head = buffer
        .get_mut(..len)
        .ok_or(EncodeError::NoRoom { len, capacity })?;
    head.copy_from_slice(telegram);
    Ok(head)
}
