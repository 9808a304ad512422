//! Why a score is not danced, and where.

use core::fmt;

use pattern_codec::dance::{ThresholdTooLow, ZeroPeriod};
use thiserror::Error;

use crate::turn::TurnError;

/// Why a score is not danced, and where.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("line {line}{part}: {kind}")]
#[non_exhaustive]
pub struct ScoreError {
    /// Line, from 1: that of the part, or of what is wrong in it.
    pub line: u32,
    /// Which part of the score.
    pub part: ScorePart,
    /// Why.
    pub kind: ScoreErrorKind,
}

/// A part of a score.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(clippy::exhaustive_enums, reason = "a score has no other parts")]
pub enum ScorePart {
    /// The settings.
    Head,
    /// A motor, from 1.
    Motor(u32),
    /// A move, from 1.
    Move(u32),
}

impl fmt::Display for ScorePart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Head => Ok(()),
            Self::Motor(number) => write!(f, ", motor {number}"),
            Self::Move(number) => write!(f, ", move {number}"),
        }
    }
}

/// Why a score is not danced.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ScoreErrorKind {
    /// The text is no TOML, or has unknown or missing keys.
    #[error("{message}")]
    Text {
        /// What the TOML reader says, in one line.
        message: String,
    },
    /// A tick or frame without length.
    #[error(transparent)]
    Timing(#[from] ZeroPeriod),
    /// A threshold too low for speeds of eight bits.
    #[error(transparent)]
    Threshold(#[from] ThresholdTooLow),
    /// No motor at all.
    #[error("there is no [[motor]]")]
    NoMotor,
    /// Nothing to dance.
    #[error("there is no frame: no [[move]] and no length_s")]
    NoFrames,
    /// More motors than a frame has bytes.
    #[error("{motors} motors, a frame has {max}")]
    TooManyMotors {
        /// Motors of the score.
        motors: usize,
        /// Bytes of a frame.
        max: usize,
    },
    /// Two motors of one name.
    #[error("the name {name:?} is taken by motor {first}")]
    SameName {
        /// The name.
        name: String,
        /// The motor that has it, from 1.
        first: u32,
    },
    /// A move of a motor that is not there.
    #[error("no motor is called {name:?}")]
    NoSuchMotor {
        /// The name.
        name: String,
    },
    /// A number that the key does not allow.
    #[error("{key} = {value} is not {wanted}")]
    Value {
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        wanted: &'static str,
    },
    /// A time that is no whole number of frames.
    #[error("{key} = {value} is no whole number of frames of {frame_s} s")]
    NotWhole {
        /// The key.
        key: &'static str,
        /// Its value, in s.
        value: f64,
        /// Period of a frame, in s.
        frame_s: f64,
    },
    /// None, or more than one, of the keys that say what the motor does.
    #[error("one of speed, to_deg and turn_deg must be given, here are {given}")]
    Action {
        /// How many are given.
        given: usize,
    },
    /// A repetition without `every_s`, or `every_s` without one.
    #[error("repeat and every_s go together")]
    Repeat,
    /// A speed above the highest of the motor.
    #[error("speed = {speed}, max {max}")]
    Speed {
        /// The speed.
        speed: i64,
        /// The highest.
        max: u8,
    },
    /// Two moves of a motor at once.
    #[error("it starts at {start_s} s, before move {other} of {motor:?} ends at {end_s} s")]
    Overlap {
        /// Start, in s.
        start_s: f64,
        /// The motor.
        motor: String,
        /// The move that has not ended, from 1.
        other: u32,
        /// Its end, in s.
        end_s: f64,
    },
    /// A move after the end of the longest dance.
    #[error("it ends at {end_s} s, the longest dance at {most_s} s")]
    TooLong {
        /// End of the move, in s.
        end_s: f64,
        /// End of the longest dance, in s.
        most_s: f64,
    },
    /// An angle past what 31 bits of half steps hold.
    #[error("{half_steps:e} half steps are more than 31 bits hold")]
    TooFar {
        /// Half steps of the move.
        half_steps: f64,
    },
    /// The motor cannot turn so.
    #[error("{motor:?}: {error}")]
    Turn {
        /// The motor.
        motor: String,
        /// Why.
        error: TurnError,
    },
}
