//! What the sources leave to a parameter list, and what they disagree on.

mod line;
mod presets;

use core::time::Duration;

use crate::frame::{Check, IllegalDle};

pub use line::Line;

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

/// What a station of high priority does in an initialization conflict (collision): it reads STX in
/// place of the answer to its own STX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Conflict {
    /// Waits on for DLE; QVZ ends the attempt. Siemens, WAGO, EUCHNER.
    #[default]
    Wait,
    /// Waits in the first connection attempt and gives way in a later one, which ends the stand-off
    /// of two stations of high priority. Linux line discipline.
    YieldOnRetry,
    /// Repeats STX as the next connection attempt, ZVZ after the partner's. KM271 clients, Beckhoff
    /// ("sends again"), which do not wait: a partner that has given way takes such a STX for data,
    /// and two of them cancel in the BCC.
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
    /// Drops it. Linux line discipline, WAGO, `ProtoCore`.
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
/// use proto3964r::{Config, Line, Priority};
///
/// const CONFIG: Config = Config {
///     qvz_ms: 500,
///     ..Config::siemens_3964r(Priority::High, Line::paced(9600, 11))
/// };
/// assert_eq!((CONFIG.zvz_ms, CONFIG.connection_attempts), (220, 6));
/// ```
/// Times are whole milliseconds up to 65.535 s, as in Siemens' own parameter lists, which end at
/// 65.530 s. An attempt count of 0 is taken as 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "plain settings, to be written as a literal on top of a preset"
)]
pub struct Config {
    /// Acknowledgement delay time (QVZ): from STX, and from the end of the block, to the answer, in
    /// ms. Siemens: 2000 with BCC, 550 without.
    pub qvz_ms: u16,
    /// Character delay time (ZVZ): longest gap between two received characters, in ms. It runs
    /// from the DLE that invites the block, restarts with every character, and is also the silence
    /// that is awaited after noise. A station counts 0 as 1. Siemens: 220.
    pub zvz_ms: u16,
    /// Block wait time (BWZ): from NAK to the STX of the repeat, in ms. Siemens: 4000.
    pub bwz_ms: u16,
    /// Longest wait for a free receive buffer after STX, in ms; never longer than QVZ less 10 ms.
    /// Siemens: 400.
    pub buffer_wait_ms: u16,
    /// Longest time that the answer to a good block is held for
    /// [`Station::accept`](crate::Station::accept) or [`refuse`](crate::Station::refuse), in ms;
    /// never longer than QVZ less 10 ms. 0, as in every preset: DLE at once.
    pub acknowledge_wait_ms: u16,
    /// How the output reaches the wire. QVZ, ZVZ and BWZ count from the end of the transmission,
    /// however far ahead the output is queued.
    pub line: Line,
    /// Longest time that a block which is already known to be bad, or noise, may go on without a
    /// pause before NAK is sent into it, in s: a total deadline where Siemens knows only gaps.
    /// 10, longer than a block of 4096 bytes at 9600 bit/s.
    pub max_noise_s: u8,
    /// Connection attempts: STX per transmission attempt. Siemens: 6.
    pub connection_attempts: u8,
    /// Transmission attempts: blocks per job, and rejected receptions in a row. Siemens: 6.
    pub transmission_attempts: u8,
    /// Who gives way in an initialization conflict.
    pub priority: Priority,
    /// 3964R or 3964.
    pub check: Check,
    /// The high side in an initialization conflict.
    pub conflict: Conflict,
    /// Characters that come while idle.
    pub idle_noise: IdleNoise,
    /// DLE before anything but DLE and ETX.
    pub illegal_dle: IllegalDle,
    /// After ZVZ ran out in a block.
    pub silence_in_block: SilenceInBlock,
    /// Whether an empty block may be sent. Linux sends it, Beckhoff refuses it.
    pub allow_empty: bool,
    /// Whether a new station begins with one NAK that puts the partner into idle. Siemens: yes.
    pub nak_at_startup: bool,
}

impl Config {
    /// The acknowledgement delay time (QVZ).
    #[must_use]
    pub fn qvz(&self) -> Duration {
        Duration::from_millis(self.qvz_ms.into())
    }

    /// The character delay time (ZVZ).
    #[must_use]
    pub fn zvz(&self) -> Duration {
        Duration::from_millis(self.zvz_ms.into())
    }

    pub(crate) fn bwz(&self) -> Duration {
        Duration::from_millis(self.bwz_ms.into())
    }

    pub(crate) fn max_noise(&self) -> Duration {
        Duration::from_secs(self.max_noise_s.into())
    }

    /// `min(buffer_wait, QVZ - 10 ms)`.
    pub(crate) fn buffer_wait(&self) -> Duration {
        self.within_qvz(self.buffer_wait_ms)
    }

    /// How long the answer to a good block is held; `None` when it is not.
    pub(crate) fn acknowledge_wait(&self) -> Option<Duration> {
        (self.acknowledge_wait_ms > 0).then(|| self.within_qvz(self.acknowledge_wait_ms))
    }

    fn within_qvz(&self, ms: u16) -> Duration {
        Duration::from_millis(ms.min(self.qvz_ms.saturating_sub(10)).into())
    }
}
