use core::iter::FusedIterator;

/// How a move goes from its start to its end.
///
/// ```text
///            way s(t)       speed, 1 at its highest
/// Linear     t              1
/// In         t²             t
/// Out        2 t - t²       1 - t
/// Smooth     3 t² - 2 t³    4 t (1 - t)
/// ```
/// t is the part of the time. For the same way in the same time the highest speed of `In` and `Out`
/// is twice, that of `Smooth` 1.5 times that of `Linear`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
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
    /// The speeds of so many frames with the highest of them given.
    ///
    /// ```
    /// use pattern_codec::dance::Easing;
    ///
    /// assert!(Easing::Linear.speeds(-60, 25).eq([-60; 25]));
    /// assert!(Easing::Smooth.speeds(90, 5).eq([32, 76, 90, 76, 32]));
    /// ```
    pub const fn speeds(self, highest: i8, frames: u16) -> Speeds {
        Speeds {
            easing: self,
            highest,
            frames,
            made: 0,
        }
    }

    /// `whole · s(done / frames)`, to the nearest, halves up.
    pub(super) fn way(self, whole: u64, done: u16, frames: u16) -> u64 {
        let (k, n) = (u128::from(done), u128::from(frames));
        // s as a ratio: below 2^50 over at most 2^48.
        let (square, cube) = (n.saturating_mul(n), n.saturating_mul(n).saturating_mul(n));
        let (part, of) = match self {
            Self::Linear => (k, n),
            Self::In => (k.saturating_mul(k), square),
            Self::Out => (
                k.saturating_mul(n.saturating_mul(2).saturating_sub(k)),
                square,
            ),
            Self::Smooth => {
                let rest = n.saturating_mul(3).saturating_sub(k.saturating_mul(2));
                (k.saturating_mul(k).saturating_mul(rest), cube)
            }
        };
        let way = rounded(u128::from(whole).saturating_mul(part), of);
        // s is at most 1.
        u64::try_from(way).unwrap_or(whole)
    }
}

/// A ratio to the nearest whole number, halves up; 0 over 0 is 0.
fn rounded(numerator: u128, denominator: u128) -> u128 {
    numerator
        .saturating_add(denominator >> 1)
        .checked_div(denominator)
        .unwrap_or(0)
}

/// The speeds of frames, made by [`Easing::speeds`].
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Speeds {
    easing: Easing,
    highest: i8,
    frames: u16,
    made: u16,
}

impl Iterator for Speeds {
    type Item = i8;

    fn next(&mut self) -> Option<i8> {
        if self.made == self.frames {
            return None;
        }
        // At the middle of the frame: (2 k + 1) / (2 n).
        let (k, n) = (u128::from(self.made), u128::from(self.frames));
        let part = k.saturating_mul(2).saturating_add(1);
        let whole = n.saturating_mul(2);
        let rest = whole.saturating_sub(part);
        let (part, whole) = match self.easing {
            Easing::Linear => (1, 1),
            Easing::In => (part, whole),
            Easing::Out => (rest, whole),
            Easing::Smooth => (part.saturating_mul(rest), n.saturating_mul(n)),
        };
        self.made = self.made.saturating_add(1);
        let magnitude = u128::from(self.highest.unsigned_abs()).saturating_mul(part);
        let [magnitude, ..] = rounded(magnitude, whole).to_le_bytes();
        let speed = magnitude.cast_signed();
        // 128 keeps its bits: its negative is itself.
        Some(if self.highest < 0 {
            speed.wrapping_neg()
        } else {
            speed
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::from(self.frames.saturating_sub(self.made));
        (left, Some(left))
    }
}

impl ExactSizeIterator for Speeds {}

impl FusedIterator for Speeds {}
