//! The two kinds of record, and their bytes.

use thiserror::Error;

use super::{Axis, ByteOrder, Format, PerAxis};

/// D7 of the first byte of FAST and of every byte of SLOW: negative direction.
pub(super) const NEGATIVE: u8 = 0x80;
/// D6 D5: the axis of FAST, zero in SLOW.
pub(super) const AXIS_BITS: u8 = 0x60;
/// D4..D0: the pulses of SLOW, all ones in the first byte of FAST.
pub(super) const COUNT_BITS: u8 = 0x1F;

/// One record: what can be constructed can be encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_enums,
    reason = "the low five bits of the first byte tell two kinds apart"
)]
pub enum Record {
    /// Rapid motion of one axis.
    Fast(Fast),
    /// Cutting motion of the three turning axes.
    Slow(Slow),
}

impl Record {
    /// Length of every record in bytes.
    pub const LEN: usize = 3;

    /// The three bytes of the record, in canonical form: a zero count has no direction bit.
    #[must_use]
    #[inline]
    pub const fn encode(self, format: &Format) -> [u8; Self::LEN] {
        match self {
            Self::Fast(Fast { axis, pulses }) => {
                // |pulses| <= 65535: the upper two bytes are zero.
                let [_, _, high, low] = pulses.unsigned_abs().to_be_bytes();
                let sign = if pulses < 0 { NEGATIVE } else { 0 };
                let first = sign | format.axis_codes.code(axis) << 5 | COUNT_BITS;
                match format.byte_order {
                    ByteOrder::BigEndian => [first, high, low],
                    ByteOrder::LittleEndian => [first, low, high],
                }
            }
            Self::Slow(slow) => [
                sign_and_count(slow.disc),
                sign_and_count(slow.elbow),
                sign_and_count(slow.shoulder),
            ],
        }
    }

    /// Signed pulses of every axis.
    #[must_use]
    #[inline]
    pub fn pulses(self) -> PerAxis<i32> {
        match self {
            Self::Fast(Fast { axis, pulses }) => {
                let of = |this: Axis| if this == axis { pulses } else { 0 };
                PerAxis {
                    elbow: of(Axis::Elbow),
                    shoulder: of(Axis::Shoulder),
                    disc: of(Axis::Disc),
                    vertical: of(Axis::Vertical),
                }
            }
            Self::Slow(slow) => PerAxis {
                elbow: slow.elbow.into(),
                shoulder: slow.shoulder.into(),
                disc: slow.disc.into(),
                vertical: 0,
            },
        }
    }
}

#[inline]
const fn sign_and_count(pulses: i8) -> u8 {
    let sign = if pulses < 0 { NEGATIVE } else { 0 };
    sign | pulses.unsigned_abs()
}

impl From<Fast> for Record {
    fn from(fast: Fast) -> Self {
        Self::Fast(fast)
    }
}

impl From<Slow> for Record {
    fn from(slow: Slow) -> Self {
        Self::Slow(slow)
    }
}

/// Rapid motion of one axis, -65535..=65535 pulses, made with the tool out of the glass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "UncheckedFast"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fast {
    axis: Axis,
    pulses: i32,
}

impl Fast {
    /// Highest number of pulses of one record, in either direction.
    pub const MAX: i32 = 65_535;

    /// Checks the pulses; [`Builder::fast`](super::Builder::fast) splits what is too long.
    ///
    /// # Errors
    /// [`PulsesError`] beyond -65535..=65535.
    pub const fn new(axis: Axis, pulses: i32) -> Result<Self, PulsesError> {
        if pulses.unsigned_abs() > Self::MAX.unsigned_abs() {
            return Err(PulsesError {
                axis,
                pulses,
                max: Self::MAX,
            });
        }
        Ok(Self { axis, pulses })
    }

    /// From the two fields of a FAST record; a negative zero becomes zero.
    #[inline]
    pub(super) fn from_count(axis: Axis, negative: bool, count: u16) -> Self {
        let magnitude = i32::from(count);
        let pulses = if negative {
            magnitude.wrapping_neg()
        } else {
            magnitude
        };
        Self { axis, pulses }
    }

    /// The axis that moves.
    #[must_use]
    #[inline]
    pub const fn axis(self) -> Axis {
        self.axis
    }

    /// Signed pulses.
    #[must_use]
    #[inline]
    pub const fn pulses(self) -> i32 {
        self.pulses
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct UncheckedFast {
    axis: Axis,
    pulses: i32,
}

#[cfg(feature = "serde")]
impl TryFrom<UncheckedFast> for Fast {
    type Error = PulsesError;

    fn try_from(fast: UncheckedFast) -> Result<Self, PulsesError> {
        Self::new(fast.axis, fast.pulses)
    }
}

/// Cutting motion of the three turning axes, -30..=30 pulses each: disc first, then elbow and
/// shoulder together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(try_from = "JointPulses", into = "JointPulses")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Slow {
    elbow: i8,
    shoulder: i8,
    disc: i8,
}

impl Slow {
    /// Highest number of pulses of one axis in one record, in either direction; 31 marks a FAST
    /// record.
    pub const MAX: i32 = 30;

    /// Checks the pulses; [`Builder::slow`](super::Builder::slow) splits what is too long.
    ///
    /// # Errors
    /// [`PulsesError`] beyond -30..=30, naming the first such axis in the order of the bytes.
    pub const fn new(pulses: JointPulses) -> Result<Self, PulsesError> {
        let JointPulses {
            elbow,
            shoulder,
            disc,
        } = pulses;
        match (
            small(Axis::Disc, disc),
            small(Axis::Elbow, elbow),
            small(Axis::Shoulder, shoulder),
        ) {
            (Ok(disc), Ok(elbow), Ok(shoulder)) => Ok(Self {
                elbow,
                shoulder,
                disc,
            }),
            (Err(error), _, _) | (_, Err(error), _) | (_, _, Err(error)) => Err(error),
        }
    }

    /// From the three bytes of a SLOW record whose counts are at most 30; D6 and D5 are ignored.
    #[inline]
    pub(super) const fn from_bytes([disc, elbow, shoulder]: [u8; Record::LEN]) -> Self {
        Self {
            elbow: signed(elbow),
            shoulder: signed(shoulder),
            disc: signed(disc),
        }
    }

    /// Signed pulses of each joint.
    #[must_use]
    #[inline]
    pub fn pulses(self) -> JointPulses {
        JointPulses {
            elbow: self.elbow.into(),
            shoulder: self.shoulder.into(),
            disc: self.disc.into(),
        }
    }
}

/// Pulses of one axis of a SLOW record as it stores them.
const fn small(axis: Axis, pulses: i32) -> Result<i8, PulsesError> {
    if pulses.unsigned_abs() > Slow::MAX.unsigned_abs() {
        return Err(PulsesError {
            axis,
            pulses,
            max: Slow::MAX,
        });
    }
    // Within +-30 the low byte holds the whole value.
    let [low, ..] = pulses.to_le_bytes();
    Ok(low.cast_signed())
}

/// Sign and magnitude of one SLOW byte, without a branch: signs are hard to predict.
#[inline]
const fn signed(byte: u8) -> i8 {
    let count = (byte & COUNT_BITS).cast_signed();
    let mask = byte.cast_signed() >> 7;
    (count ^ mask).wrapping_sub(mask)
}

impl TryFrom<JointPulses> for Slow {
    type Error = PulsesError;

    fn try_from(pulses: JointPulses) -> Result<Self, PulsesError> {
        Self::new(pulses)
    }
}

impl From<Slow> for JointPulses {
    fn from(slow: Slow) -> Self {
        slow.pulses()
    }
}

/// Signed pulses of the three axes that a SLOW record moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "a SLOW record has three axes")]
pub struct JointPulses {
    /// Pulses of the forearm.
    pub elbow: i32,
    /// Pulses of the upper arm.
    pub shoulder: i32,
    /// Pulses of the disc.
    pub disc: i32,
}

/// More pulses than one record holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error(
    "{axis}: {pulses} pulses do not fit into one record, which holds at most {max} in either direction"
)]
#[non_exhaustive]
pub struct PulsesError {
    /// The axis.
    pub axis: Axis,
    /// Its signed pulses.
    pub pulses: i32,
    /// The highest number that the kind of record holds.
    pub max: i32,
}
