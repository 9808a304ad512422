//! What the control says.

use crate::lcd::LcdCommands;
use crate::number::Led;
use crate::report::{DecodeError, EncodeError, LCD, Model, put};

pub(crate) const STATUS_REQUEST: u8 = 0x23;

/// What an LED does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_enums, reason = "the unit knows these three")]
pub enum LedState {
    /// 30h + number.
    On,
    /// 40h + number.
    Off,
    /// 50h + number.
    Flashing,
}

impl LedState {
    const fn zero(self) -> u8 {
        match self {
            Self::On => 0x30,
            Self::Off => 0x40,
            Self::Flashing => 0x50,
        }
    }
}

/// A telegram from the control to the unit.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Command<'a> {
    /// 23h: the unit replies with its status.
    StatusRequest,
    /// An LED of the HBLS.
    Led {
        /// Which; `None` all of them, which is inferred from the printed ranges.
        led: Option<Led>,
        /// What it does.
        state: LedState,
    },
    /// 6Ch and commands for the display, which are checked as they are read.
    Lcd(LcdCommands<'a>),
}

impl<'a> Command<'a> {
    /// Reads one telegram, as a simulated unit does.
    ///
    /// # Errors
    /// [`DecodeError`] for anything that the unit does not understand. What stands in a display
    /// block is checked when its commands are read.
    pub fn decode(model: Model, telegram: &'a [u8]) -> Result<Self, DecodeError> {
        match telegram {
            [STATUS_REQUEST] => Ok(Self::StatusRequest),
            [LCD, commands @ ..] if telegram.len() <= model.max_lcd_block() => {
                Ok(Self::Lcd(LcdCommands::new(model, commands)))
            }
            &[byte] if model == Model::Hbls => {
                decode_led(byte).ok_or(DecodeError::Unknown { index: 0, byte })
            }
            &[byte] => Err(DecodeError::Unknown { index: 0, byte }),
            other => Err(DecodeError::Length { len: other.len() }),
        }
    }

    /// Writes the telegram into the head of `buffer`; [`MAX_COMMAND`](crate::MAX_COMMAND) bytes
    /// hold every one.
    ///
    /// # Errors
    /// [`EncodeError`]: the buffer is too short, or the unit has no such telegram.
    pub fn encode(self, model: Model, buffer: &mut [u8]) -> Result<&[u8], EncodeError> {
        match self {
            Self::StatusRequest => put(buffer, &[STATUS_REQUEST]),
            Self::Led { led, state } if model == Model::Hbls => {
                let code = led.map_or(state.zero(), |led| led.code(state.zero()));
                put(buffer, &[code])
            }
            Self::Led { .. } => Err(EncodeError::Model { model }),
            Self::Lcd(commands) => {
                let len = commands.as_bytes().len().saturating_add(1);
                if commands.model() != model {
                    return Err(EncodeError::Model { model });
                }
                let capacity = buffer.len();
                let no_room = EncodeError::NoRoom { len, capacity };
                let head = buffer.get_mut(..len).ok_or(no_room)?;
                for (to, from) in head.iter_mut().zip([LCD].iter().chain(commands.as_bytes())) {
                    *to = *from;
                }
                Ok(head)
            }
        }
    }
}

fn decode_led(byte: u8) -> Option<Command<'static>> {
    [LedState::On, LedState::Off, LedState::Flashing]
        .into_iter()
        .find_map(|state| {
            let led = match byte == state.zero() {
                true => None,
                false => Some(Led::from_code(byte, state.zero()).ok()?),
            };
            Some(Command::Led { led, state })
        })
}
