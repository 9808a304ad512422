//! Seconds and frames.

use pattern_codec::dance::Timing;

use crate::score::{Move, ScoreErrorKind};

/// Highest number of frames of a dance: 3.6 hours at 200 ms.
pub(super) const MAX_FRAMES: u32 = 65_535;

pub(super) const WITHIN_MAX_FRAMES: &str = "within 65535 frames";

/// How far from a whole number of frames a time in decimal digits may be by its binary rounding.
const WHOLE: f64 = 1e-6;

/// Seconds and frames.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub(super) timing: Timing,
}

impl Clock {
    pub(super) fn frame_s(self) -> f64 {
        f64::from(self.timing.tick_us()) * f64::from(self.timing.frame_ticks()) / 1e6
    }

    pub(super) fn seconds(self, frames: u32) -> f64 {
        // To a thousandth of a microsecond, so that 0.2 times 3 is 0.6.
        (f64::from(frames) * self.frame_s() * 1e9).round() / 1e9
    }

    pub(super) fn frames(self, key: &'static str, value: f64) -> Result<u32, ScoreErrorKind> {
        let frames = value / self.frame_s();
        let whole = frames.round();
        if !(0.0..=f64::from(u32::MAX)).contains(&whole) {
            let wanted = "within 0 s and the longest dance";
            return Err(ScoreErrorKind::Value { key, value, wanted });
        }
        if (frames - whole).abs() > WHOLE {
            return Err(ScoreErrorKind::NotWhole {
                key,
                value,
                frame_s: self.frame_s(),
            });
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and within u32"
        )]
        Ok(whole as u32)
    }

    /// The frames of a dance whose last move ends at a frame.
    pub(super) fn length(self, length_s: f64, end: u32) -> Result<u32, ScoreErrorKind> {
        let frames = self.frames("length_s", length_s)?;
        let wanted = if frames > MAX_FRAMES {
            WITHIN_MAX_FRAMES
        } else if frames < end {
            "at or after the end of the last move"
        } else {
            return Ok(frames);
        };
        Err(ScoreErrorKind::Value {
            key: "length_s",
            value: length_s,
            wanted,
        })
    }

    pub(super) fn too_long(self, one: &Move) -> ScoreErrorKind {
        ScoreErrorKind::TooLong {
            end_s: self.seconds(one.end()),
            most_s: self.seconds(MAX_FRAMES),
        }
    }
}
