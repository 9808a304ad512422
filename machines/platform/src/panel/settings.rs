//! What an installation chooses.

use handwheel::{Key, Position, RotarySwitch, WheelQuantiser};
use thiserror::Error;

const KEYS: [Key; 4] = [key(1), key(2), key(3), key(4)];

const fn key(number: u8) -> Key {
    match Key::new(number) {
        Ok(key) => key,
        #[expect(clippy::panic, reason = "of constants")]
        Err(_) => panic!("no such key"),
    }
}

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum KeyRole {
    /// The cursor goes up.
    PageUp,
    /// The cursor goes down.
    PageDown,
    /// Opens what the cursor is on, and goes back.
    Enter,
    /// Runs the pose change.
    Start,
}

/// By what the multiplier switch multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Multiplier {
    /// Position 1.
    X1,
    /// Position 2.
    X10,
    /// Position 3.
    X100,
}

impl Multiplier {
    pub(crate) const fn of_position(position: Position) -> Option<Self> {
        match position.get() {
            1 => Some(Self::X1),
            2 => Some(Self::X10),
            3 => Some(Self::X100),
            _ => None,
        }
    }

    /// 1, 10 or 100.
    pub(crate) const fn factor(self) -> u8 {
        match self {
            Self::X1 => 1,
            Self::X10 => 10,
            Self::X100 => 100,
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::X1 => "x1",
            Self::X10 => "x10",
            Self::X100 => "x100",
        }
    }
}

/// Keys, rotary switches, speeds and steps of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::exhaustive_structs, reason = "plain settings")]
pub struct PanelSettings {
    /// From wheel counts to a fraction of the jog speed.
    pub wheel: WheelQuantiser,
    /// Jog speed of a wheel at full speed with x100, in micrometres per second.
    pub full_jog_um_s: u32,
    /// Change of a length by one wheel count with x1, in micrometres.
    pub step_um: u32,
    /// Change of an angle by one wheel count with x1, in millionths of a degree.
    pub step_udeg: u32,
    /// Largest length of a pose change, in micrometres.
    pub max_um: u32,
    /// Largest angle of a pose change, in millionths of a degree.
    pub max_udeg: u32,
    /// The keys for page up, page down, enter and motion start.
    pub keys: [Key; 4],
    /// The right rotary switch, which chooses the direction; the other one is the multiplier.
    pub direction_switch: RotarySwitch,
}

/// Why settings cannot work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[non_exhaustive]
pub enum PanelSettingsError {
    /// A speed, step or limit of zero, or above what a signed 32-bit number holds.
    #[error("{name} = {value} is not within 1..=2147483647")]
    Range {
        /// The setting.
        name: &'static str,
        /// Its value.
        value: u32,
    },
    /// One key for two things.
    #[error("key {key} has two roles")]
    SameKey {
        /// The key.
        key: Key,
    },
}

impl PanelSettings {
    /// Full jog speed 10 mm/s, steps of 1 um and 0.0001 deg, pose changes up to 100 mm and 10 deg,
    /// keys 1 to 4, the direction on W2.
    #[must_use]
    pub const fn new(wheel: WheelQuantiser) -> Self {
        Self {
            wheel,
            full_jog_um_s: 10_000,
            step_um: 1,
            step_udeg: 100,
            max_um: 100_000,
            max_udeg: 10_000_000,
            keys: KEYS,
            direction_switch: RotarySwitch::W2,
        }
    }

    const ROLES: [KeyRole; 4] = [
        KeyRole::PageUp,
        KeyRole::PageDown,
        KeyRole::Enter,
        KeyRole::Start,
    ];

    pub(crate) fn check(self) -> Result<Self, PanelSettingsError> {
        for (name, value) in [
            ("full_jog_um_s", self.full_jog_um_s),
            ("step_um", self.step_um),
            ("step_udeg", self.step_udeg),
            ("max_um", self.max_um),
            ("max_udeg", self.max_udeg),
        ] {
            if value == 0 || i32::try_from(value).is_err() {
                return Err(PanelSettingsError::Range { name, value });
            }
        }
        for (index, &key) in self.keys.iter().enumerate() {
            if self
                .keys
                .iter()
                .skip(index.saturating_add(1))
                .any(|&other| other == key)
            {
                return Err(PanelSettingsError::SameKey { key });
            }
        }
        Ok(self)
    }

    pub(crate) fn role(&self, key: Key) -> Option<KeyRole> {
        let index = self.keys.iter().position(|&it| it == key)?;
        Self::ROLES.get(index).copied()
    }

    /// The jog speed that the counts of a sample stand for.
    pub(crate) fn jog_um_s(&self, counts: i32, multiplier: Multiplier) -> i32 {
        let hundredths = i64::from(multiplier.factor());
        let full = self.wheel.speed(counts, self.full_jog_um_s);
        let speed = full.saturating_mul(hundredths) / 100;
        // At most `full_jog_um_s`, which fits.
        i32::try_from(speed).unwrap_or_default()
    }

    /// Step of one count, and the largest value, in a direction of the pose change, 1 to 6.
    pub(crate) fn adjustment(&self, direction: u8, multiplier: Multiplier) -> (i64, i64) {
        let (step, max) = match direction {
            ..=3 => (self.step_um, self.max_um),
            _ => (self.step_udeg, self.max_udeg),
        };
        let step = i64::from(step).saturating_mul(multiplier.factor().into());
        (step, max.into())
    }
}
