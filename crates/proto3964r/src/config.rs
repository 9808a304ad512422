//! What the sources leave to a parameter list, and what they disagree on.

mod presets;

use crate::frame::{Check, IllegalDle};

/// Who gives way when both stations send STX at the same time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the procedure knows these two")]
pub enum Priority {
    /// Gives way: receives first, then sends its own job.
    Low,
    /// Insists on its own job.
    High,
}

/// What a station of high priority does when it reads STX in place of the answer to its own STX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Collision {
    /// Waits on for DLE; QVZ ends the attempt. Siemens, WAGO, EUCHNER.
    #[default]
    Wait,
    /// Waits in the first setup attempt and gives way in a later one, which ends the stand-off of
    /// two stations of high priority. Linux line discipline.
    YieldOnRetry,
    /// Repeats STX at once, as the next setup attempt. KM271 clients, Beckhoff ("sends again").
    Repeat,
}

/// What an idle station does with a character other than STX and NAK.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum IdleNoise {
    /// Waits until the line has been silent for ZVZ, then sends NAK. Siemens.
    #[default]
    NakAfterSilence,
    /// Sends NAK at once. `ProviewR`, Dust3964r.
    NakAtOnce,
    /// Drops it. Linux line discipline, WAGO, ``ProtoCore``.
    Ignore,
}

/// What a receiver does after ZVZ ran out in a block and NAK was sent.
///
/// On the line the two look the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SilenceInBlock {
    /// Falls back to idle. Siemens S7-300/400.
    #[default]
    Idle,
    /// Counts a rejected reception and waits for the repeat for at most BWZ. Siemens S7-1500.
    ExpectRepeat,
}

/// The parameters of a [`Station`](crate::Station).
///
/// Begin with a preset, change what differs:
/// ```
/// use proto3964r::{Config, Priority};
///
/// const CONFIG: Config = Config::siemens_3964r(Priority::High)
///     .with_qvz_ms(500)
///     .with_line(9600, 11);
/// assert_eq!((CONFIG.zvz_ms, CONFIG.character_us), (220, 1146));
/// ```
/// Times are whole milliseconds up to 65.535 s; Siemens' own parameter lists end at 65.530 s. An
/// attempt count of 0 is taken as 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Config {
    /// QVZ, acknowledgement delay: from STX, and from the end of the block, to the answer, in ms.
    /// Siemens: 2000 with BCC, 550 without.
    pub qvz_ms: u16,
    /// ZVZ, character delay: longest gap between two received characters, in ms. It runs from the
    /// DLE that invites the block, restarts with every character, and is also the silence that
    /// is awaited after noise. A station counts 0 as 1. Siemens: 220.
    pub zvz_ms: u16,
    /// BWZ, block wait: from NAK to the STX of the repeat, in ms. Siemens: 4000.
    pub bwz_ms: u16,
    /// Longest wait for a free receive buffer after STX, in ms; never longer than QVZ less 10 ms.
    /// Siemens: 400.
    pub buffer_wait_ms: u16,
    /// Time that one character takes on the line, in us. QVZ, ZVZ and BWZ then count from the end
    /// of the transmission, however far ahead the output is queued. 0 when bytes are handed to
    /// the line one by one.
    pub character_us: u32,
    /// Longest time that a block which is already known to be bad, or noise, may go on without a
    /// pause before NAK is sent into it, in s: a total deadline where Siemens knows only gaps.
    /// 10, longer than a block of 4096 bytes at 9600 bit/s.
    pub babble_s: u8,
    /// Setup attempts: STX per transfer attempt. Siemens: 6.
    pub setup_attempts: u8,
    /// Transfer attempts: blocks per job, and rejected receptions in a row. Siemens: 6.
    pub transfer_attempts: u8,
    /// Who gives way in a collision.
    pub priority: Priority,
    /// 3964R or 3964.
    pub check: Check,
    /// The high side in a collision.
    pub collision: Collision,
    /// Characters that come while idle.
    pub idle_noise: IdleNoise,
    /// DLE in front of anything but DLE and ETX.
    pub illegal_dle: IllegalDle,
    /// After ZVZ ran out in a block.
    pub silence_in_block: SilenceInBlock,
    /// Whether an empty block may be sent. Linux sends it, Beckhoff refuses it.
    pub allow_empty: bool,
    /// Whether a new station begins with one NAK that puts the partner into idle. Siemens: yes.
    pub nak_at_startup: bool,
    /// Whether what comes in sooner than two times [`character_us`](Self::character_us) after STX
    /// is ignored, since it left the partner before STX arrived: a NAK that crosses STX otherwise
    /// makes a second STX, which the partner takes for data, and costs a repeat. Only for a line
    /// that is truly that slow: on a pseudo-terminal or over a network answers come sooner.
    /// Siemens: no.
    pub ignore_early_answers: bool,
}

/// `const fn with_field(self, value) -> Self` for each field.
macro_rules! setters {
    ($($setter:ident, $field:ident: $type:ty;)*) => {
        impl Config {$(
            #[doc = concat!("The same with another [`", stringify!($field), "`](Self::", stringify!($field), ").")]
            #[must_use]
            pub const fn $setter(mut self, $field: $type) -> Self {
                self.$field = $field;
                self
            }
        )*}
    };
}

setters! {
    with_qvz_ms, qvz_ms: u16;
    with_zvz_ms, zvz_ms: u16;
    with_bwz_ms, bwz_ms: u16;
    with_buffer_wait_ms, buffer_wait_ms: u16;
    with_babble_s, babble_s: u8;
    with_character_us, character_us: u32;
    with_setup_attempts, setup_attempts: u8;
    with_transfer_attempts, transfer_attempts: u8;
    with_priority, priority: Priority;
    with_check, check: Check;
    with_collision, collision: Collision;
    with_idle_noise, idle_noise: IdleNoise;
    with_illegal_dle, illegal_dle: IllegalDle;
    with_silence_in_block, silence_in_block: SilenceInBlock;
    with_allow_empty, allow_empty: bool;
    with_nak_at_startup, nak_at_startup: bool;
    with_ignore_early_answers, ignore_early_answers: bool;
}

impl Config {
    /// The same with [`character_us`](Self::character_us) of a line of `baud` bit/s, rounded up.
    ///
    /// ```text
    /// character_us = bits * 10^6 / baud       8E1: bits = 11, 8N1: bits = 10
    /// ```
    /// 0 for `baud` = 0.
    #[must_use]
    pub const fn with_line(self, baud: u32, bits: u8) -> Self {
        let micros = if baud == 0 {
            0
        } else {
            (bits as u32 * 1_000_000).div_ceil(baud)
        };
        self.with_character_us(micros)
    }

    /// `babble_s` in us.
    pub(crate) fn babble_us(&self) -> u64 {
        u64::from(self.babble_s) * 1_000_000
    }

    /// The wait for a receive buffer: `min(buffer_wait_ms, qvz_ms - 10)`.
    pub(crate) const fn effective_buffer_wait_ms(&self) -> u16 {
        let below_qvz = self.qvz_ms.saturating_sub(10);
        if self.buffer_wait_ms < below_qvz {
            self.buffer_wait_ms
        } else {
            below_qvz
        }
    }
}
