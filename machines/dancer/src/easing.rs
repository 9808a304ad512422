//! How a move goes from its start to its end, in whole speeds.

use serde::Deserialize;

/// How a move goes from its start to its end.
///
/// ```text
///            position s(t)  speed, 1 at its highest
/// Linear     t              1
/// In         t²             t
/// Out        2 t - t²       1 - t
/// Smooth     3 t² - 2 t³    4 t (1 - t)
/// ```
/// t is the fraction of the time. Over the same distance in the same time the highest speed of `In`
/// and `Out` is twice, that of `Smooth` 1.5 times that of `Linear`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(clippy::exhaustive_enums, reason = "what a score may say")]
pub enum Easing {
    /// The same speed throughout.
    #[default]
    Linear,
    /// From rest.
    In,
    /// To rest.
    Out,
    /// From rest to rest.
    Smooth,
}

impl Easing {
    /// The speeds of `frames` frames, the highest of them given.
    ///
    /// ```
    /// use dancer::Easing;
    ///
    /// assert!(Easing::Linear.speeds(-60, 25).eq([-60; 25]));
    /// assert!(Easing::Smooth.speeds(90, 5).eq([32, 76, 90, 76, 32]));
    /// ```
    #[must_use]
    pub fn speeds(self, highest: i8, frames: u16) -> impl ExactSizeIterator<Item = i8> {
        let n = u64::from(frames);
        (0..frames).map(move |frame| {
            // At the middle of the frame: (2 k + 1) / (2 n).
            let part = 2 * u64::from(frame) + 1;
            let rest = 2 * n - part;
            let (numerator, denominator) = match self {
                Self::Linear => (1, 1),
                Self::In => (part, 2 * n),
                Self::Out => (rest, 2 * n),
                Self::Smooth => (part * rest, n * n),
            };
            let magnitude = u64::from(highest.unsigned_abs()) * numerator;
            // At most the highest, 128.
            let [magnitude, ..] = rounded(magnitude.into(), denominator.into()).to_le_bytes();
            let speed = magnitude.cast_signed();
            // 128 keeps its bits: its negative is itself.
            if highest < 0 {
                speed.wrapping_neg()
            } else {
                speed
            }
        })
    }

    /// `whole · s(done / frames)`, to the nearest, halves up, for at least one frame.
    pub(crate) fn position(self, whole: u64, done: u16, frames: u16) -> u64 {
        let (k, n) = (u128::from(done), u128::from(frames));
        // s as a ratio: below 2^50 over at most 2^48.
        let (numerator, denominator) = match self {
            Self::Linear => (k, n),
            Self::In => (k * k, n * n),
            Self::Out => (k * (2 * n - k), n * n),
            Self::Smooth => (k * k * (3 * n - 2 * k), n * n * n),
        };
        #[expect(clippy::cast_possible_truncation, reason = "s is at most 1")]
        let position = rounded(u128::from(whole) * numerator, denominator) as u64;
        position
    }
}

/// A ratio to the nearest whole number, halves up.
const fn rounded(numerator: u128, denominator: u128) -> u128 {
    (numerator + (denominator >> 1)) / denominator
}
