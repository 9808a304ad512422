//! A dance as a person writes it: which motor moves when, how long, how far or how fast.

mod compile;
mod error;
mod text;

use core::str::FromStr;

use pattern_codec::dance::{Threshold, Timing};

use crate::easing::Easing;

pub use compile::{Choreography, Landing};
pub use error::{ScoreError, ScoreErrorKind, ScorePart};

/// A dance as a person writes it: which motor moves when, how long, how far or how fast.
///
/// ```
/// use dancer::{Law, Score};
///
/// let score: Score = r#"
///     [[motor]]
///     name = "left wheel"
///     half_step_deg = 0.9
///
///     [[motor]]
///     name = "right wheel"
///     half_step_deg = 0.9
///
///     [[move]]                # the turn on the spot of \[Dancer\]
///     motor = "left wheel"
///     at_s = 1.0
///     for_s = 5.0
///     speed = 60
///
///     [[move]]
///     motor = "right wheel"
///     at_s = 1.0
///     for_s = 5.0
///     turn_deg = -450         # the same, asked as an angle
/// "#.parse()?;
/// let dance = score.compile::<2>(Law::CarryMagnitude)?;
/// assert_eq!(dance.frames[..5], [[0, 0]; 5]);
/// assert_eq!(dance.frames[5..], [[60, -60]; 25]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// | key | meaning | unless given |
/// |---|---|---|
/// | `title` | for people | empty |
/// | `tick_us`, `frame_ticks`, `threshold` | the firmware's | 1000, 200, 600 |
/// | `length_s` | length of the dance | end of the last move |
/// | `[[motor]]` | one per byte of the frame, in this order | the other bytes rest |
/// | `name` | what moves call it | |
/// | `half_step_deg` | angle of one half step, after the gear | |
/// | `max_speed` | highest speed, 1..=127 | 127 |
/// | `[[move]]` | | |
/// | `motor` | whose | |
/// | `at_s`, `for_s` | start and time, in whole frames | |
/// | `speed` | speed of the frames, the highest where it is eased, -127..=127 | |
/// | `to_deg` | or: angle at the end, 0 at the start of the dance | |
/// | `turn_deg` | or: angle from where the motor is asked to be | |
/// | `easing` | `linear`, `in`, `out` or `smooth`, see [`Easing`] | `linear` |
/// | `repeat`, `every_s` | how many times, and from start to start | 1 |
///
/// Angles end within one half step of what was asked, whatever came before: what rounding leaves
/// over, the next move of the motor makes up for. A move at a speed asks for no angle; the next
/// turn goes on from where it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    title: String,
    timing: Timing,
    threshold: Threshold,
    motors: Vec<Performer>,
    /// In the order of their starts, no two of one motor at once.
    moves: Vec<Move>,
    frames: u32,
}

/// A motor of a score.
#[derive(Debug, Clone, PartialEq)]
struct Performer {
    name: String,
    half_step_deg: f64,
    max_speed: u8,
}

/// A move of a score.
#[derive(Debug, Clone, PartialEq)]
struct Move {
    /// From 1, as written.
    number: u32,
    line: u32,
    /// Index of the motor.
    motor: usize,
    start: u32,
    frames: u16,
    action: Action,
    easing: Easing,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Action {
    Speed(i8),
    ToDeg(f64),
    TurnDeg(f64),
}

impl Move {
    fn end(&self) -> u32 {
        self.start.saturating_add(self.frames.into())
    }
}

impl Score {
    /// What people call the dance; may be empty.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Tick and period of a frame.
    #[must_use]
    pub const fn timing(&self) -> Timing {
        self.timing
    }

    /// What an accumulator adds up for one half step.
    #[must_use]
    pub const fn threshold(&self) -> Threshold {
        self.threshold
    }

    /// Length of the dance, in frames.
    #[must_use]
    pub const fn frames(&self) -> u32 {
        self.frames
    }

    /// Name and angle of a half step, in degrees, of each motor.
    #[must_use]
    pub fn motors(&self) -> impl ExactSizeIterator<Item = (&str, f64)> {
        let motors = self.motors.iter();
        motors.map(|motor| (motor.name.as_str(), motor.half_step_deg))
    }
}

impl FromStr for Score {
    type Err = ScoreError;

    /// Reads the TOML form.
    fn from_str(text: &str) -> Result<Self, ScoreError> {
        text::read(text)
    }
}

/// A whole number to compare, and for messages.
#[expect(
    clippy::cast_precision_loss,
    reason = "exact below 2^53, more than 65,535 frames make; in messages the last digit does not count"
)]
fn approximate(value: i64) -> f64 {
    value as f64
}
