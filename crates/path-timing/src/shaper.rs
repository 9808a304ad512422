//! Input shapers: impulses that a motion is convolved with, so that a mode of the machine is not
//! left ringing.
//!
//! Goal: amplitudes Aᵢ > 0 at times τᵢ whose sum is 1, so that the vibration that each impulse
//! leaves is cancelled by the others. Method: the closed forms of the literature, with
//!
//! ```text
//! K = exp(-ζπ / √(1 - ζ²))    half a period T/2 = 1 / (2 f √(1 - ζ²))
//! ```
//!
//! Positive amplitudes make the shaped motion a mean of the motion at several times: whatever limit
//! the motion keeps, the mean keeps.

mod course;
mod error;
mod ring;
mod shaped;
mod tap;
mod try_row;

use core::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2, TAU};

use crate::number::{LARGEST, SMALLEST, cube_root, larger_or_nan, range, sqrt};
pub use error::{ShapedError, ShaperError};
pub use shaped::Shaped;
pub use try_row::TryRow;

/// A mode in which a machine vibrates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Mode {
    /// Undamped natural frequency f, in Hz. What a log shows is f √(1 - ζ²).
    pub hz: f64,
    /// Damping ratio ζ, 0 to below 1: a few hundredths for a frame of steel.
    pub damping: f64,
}

/// A part of a shaper: the motion, so much of it, so much later.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Impulse {
    /// Delay, in seconds.
    pub time_s: f64,
    /// The part of the motion, above 0; those of a shaper have the sum 1.
    pub amplitude: f64,
}

/// Impulses that a motion is convolved with.
///
/// ```text
/// qₛ(t) = Σ Aᵢ q(t - τᵢ)
/// ```
///
/// | shaper | impulses | delay, periods | residual vibration below 5 % within | source |
/// |---|---|---|---|---|
/// | [`zv`](Self::zv) | 2 | 1/2 | ±3 % of the frequency | Smith 1957, Singer and Seering 1990 |
/// | [`mzv`](Self::mzv) | 3 | 3/4 | ±4 % | Tuttle and Seering 1994 |
/// | [`zvd`](Self::zvd) | 3 | 1 | ±14 % | Singer and Seering 1990 |
/// | [`ei`](Self::ei) | 3 | 1 | ±20 % | Singhose, Seering and Singer 1994 |
/// | [`two_hump`](Self::two_hump) | 4 | 3/2 | ±36 % | Singhose, Porter, Tuttle and Seering 1997 |
/// | [`three_hump`](Self::three_hump) | 5 | 2 | ±48 % | the same |
///
/// [`residual`](Self::residual) tells it for any mode.
///
/// ```
/// use path_timing::{Mode, Shaper};
///
/// let shaper = Shaper::zvd(Mode { hz: 40.0, damping: 0.05 })?;
/// assert!(shaper.residual(Mode { hz: 44.0, damping: 0.05 }) < 0.03);
/// assert!(shaper.departure(5000.0) < 0.4); // mm, at 5 m/s²
/// # Ok::<(), path_timing::ShaperError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaper {
    impulses: [Impulse; Self::MAX_IMPULSES],
    count: usize,
}

/// The part of the vibration that shapers with humps leave at their frequency.
const TOLERANCE: f64 = 0.05;

impl Shaper {
    /// The most impulses of a shaper.
    pub const MAX_IMPULSES: usize = 8;

    /// No shaping: for an axis next to others that are shaped.
    #[must_use]
    pub const fn none() -> Self {
        let mut impulses = [Impulse {
            time_s: 0.0,
            amplitude: 0.0,
        }; Self::MAX_IMPULSES];
        let [first, ..] = &mut impulses;
        first.amplitude = 1.0;
        Self { impulses, count: 1 }
    }

    /// Zero vibration: 1, K. The shortest, for a frequency that is known.
    ///
    /// # Errors
    /// [`ShaperError::Mode`], as of each shaper for a mode.
    pub fn zv(mode: Mode) -> Result<Self, ShaperError> {
        Self::by_half_periods(mode, [(0.0, 1.0), (1.0, 1.0)])
    }

    /// Zero vibration and derivative: 1, 2K, K². The residual vibration grows with the square of
    /// the error of the frequency.
    ///
    /// # Errors
    /// [`ShaperError::Mode`].
    pub fn zvd(mode: Mode) -> Result<Self, ShaperError> {
        Self::by_half_periods(mode, [(0.0, 1.0), (1.0, 2.0), (2.0, 1.0)])
    }

    /// Modified zero vibration: three impulses within three quarters of a period.
    ///
    /// # Errors
    /// [`ShaperError::Mode`].
    pub fn mzv(mode: Mode) -> Result<Self, ShaperError> {
        let outer = 1.0 - FRAC_1_SQRT_2;
        Self::by_half_periods(mode, [(0.0, outer), (0.75, SQRT_2 - 1.0), (1.5, outer)])
    }

    /// Extra insensitive: 5 % of the vibration are left at the frequency, and no more around it.
    ///
    /// # Errors
    /// [`ShaperError::Mode`].
    pub fn ei(mode: Mode) -> Result<Self, ShaperError> {
        let (outer, inner) = ((1.0 + TOLERANCE) * 0.25, (1.0 - TOLERANCE) * 0.5);
        Self::by_half_periods(mode, [(0.0, outer), (1.0, inner), (2.0, outer)])
    }

    /// Two-hump extra insensitive, in the form for little damping, weighted by the damping.
    ///
    /// ```text
    /// X³ = V² (1 + √(1 - V²))    A₁ = (3X² + 2X + 3V²) / 16X    A₂ = 1/2 - A₁
    /// ```
    ///
    /// # Errors
    /// [`ShaperError::Mode`].
    pub fn two_hump(mode: Mode) -> Result<Self, ShaperError> {
        let square = TOLERANCE * TOLERANCE;
        let x = cube_root(square * (1.0 + sqrt(1.0 - square)));
        let outer = (3.0 * x * x + 2.0 * x + 3.0 * square) / (16.0 * x);
        let inner = 0.5 - outer;
        Self::by_half_periods(
            mode,
            [(0.0, outer), (1.0, inner), (2.0, inner), (3.0, outer)],
        )
    }

    /// Three-hump extra insensitive, in the form for little damping, weighted by the damping.
    ///
    /// ```text
    /// A₁ = (1 + 3V + 2√(2V(V + 1))) / 16    A₂ = (1 - V) / 4    A₃ = 1 - 2 (A₁ + A₂)
    /// ```
    ///
    /// # Errors
    /// [`ShaperError::Mode`].
    pub fn three_hump(mode: Mode) -> Result<Self, ShaperError> {
        let root = sqrt(2.0 * TOLERANCE * (TOLERANCE + 1.0));
        let outer = (1.0 + 3.0 * TOLERANCE + 2.0 * root) / 16.0;
        let next = (1.0 - TOLERANCE) / 4.0;
        let middle = 1.0 - 2.0 * (outer + next);
        let weights = [
            (0.0, outer),
            (1.0, next),
            (2.0, middle),
            (3.0, next),
            (4.0, outer),
        ];
        Self::by_half_periods(mode, weights)
    }

    /// A shaper from its impulses, such as one for two modes, whose impulses are the products of
    /// those of one for each. Amplitudes are divided by their sum.
    ///
    /// # Errors
    /// [`ShaperError`] for no or too many impulses, for amplitudes that are not above 0 and for
    /// times that do not rise from 0 or more.
    pub fn from_impulses(impulses: &[Impulse]) -> Result<Self, ShaperError> {
        let count = impulses.len();
        let max = Self::MAX_IMPULSES;
        if count == 0 || count > max {
            return Err(ShaperError::Count { count, max });
        }
        let mut before_s = None;
        for (index, impulse) in impulses.iter().enumerate() {
            let Impulse { time_s, amplitude } = *impulse;
            if !range().contains(&amplitude) {
                return Err(ShaperError::Amplitude { index, amplitude });
            }
            // Written so that NaN does not rise.
            let rises =
                time_s <= LARGEST && before_s.map_or(time_s >= 0.0, |before| time_s > before);
            if !rises {
                return Err(ShaperError::Time { index, time_s });
            }
            before_s = Some(time_s);
        }
        let sum: f64 = impulses.iter().map(|impulse| impulse.amplitude).sum();
        let mut shaper = Self::none();
        shaper.count = count;
        for (to, from) in shaper.impulses.iter_mut().zip(impulses) {
            *to = Impulse {
                amplitude: from.amplitude / sum,
                ..*from
            };
        }
        Ok(shaper)
    }

    /// Impulses at multiples n of half a period, with weights for no damping, each times Kⁿ.
    fn by_half_periods<const N: usize>(
        mode: Mode,
        impulses: [(f64, f64); N],
    ) -> Result<Self, ShaperError> {
        let [decay, half_period_s] = mode.decay_and_half_period()?;
        let impulses = impulses.map(|(halves, weight)| Impulse {
            time_s: halves * half_period_s,
            amplitude: weight * libm::exp(-halves * decay),
        });
        Self::from_impulses(&impulses)
    }

    /// The impulses, by time.
    #[must_use]
    pub fn impulses(&self) -> &[Impulse] {
        self.impulses.get(..self.count).unwrap_or_default()
    }

    /// Seconds from the first impulse to the last: by so much later the machine rests.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        match self.impulses() {
            [first, .., last] => last.time_s - first.time_s,
            _ => 0.0,
        }
    }

    /// By how many seconds the shaped motion is behind: the mean of the impulses.
    ///
    /// ```text
    /// τ = Σ Aᵢ τᵢ
    /// ```
    #[must_use]
    pub fn delay_s(&self) -> f64 {
        let impulses = self.impulses().iter();
        impulses
            .map(|impulse| impulse.amplitude * impulse.time_s)
            .sum()
    }

    /// The most by which a shaped axis is off the motion [`delay_s`](Self::delay_s) earlier, where
    /// the acceleration of that motion is at most `acceleration`; in the axis' unit. It is the
    /// smoothing that each shaper costs.
    ///
    /// ```text
    /// |qₛ(t) - q(t - τ)| ≤ s²/2 max |q"|    s² = Σ Aᵢ (τᵢ - τ)²
    /// ```
    ///
    /// Proof. The shaped position is the mean Σ Aᵢ q(t - τᵢ). By Taylor's formula each q(t - τᵢ) is
    /// off q(t - τ) - (τᵢ - τ) q'(t - τ) by at most (τᵢ - τ)²/2 max |q"|, and the linear part has
    /// the mean 0.
    ///
    /// Across axes: a Cartesian tool departs by at most the root of the sum of the squares, or by
    /// this bound of its own acceleration where all axes have one shaper.
    #[must_use]
    pub fn departure(&self, acceleration: f64) -> f64 {
        let delay_s = self.delay_s();
        let squares = self.impulses().iter().map(|impulse| {
            let from_mean_s = impulse.time_s - delay_s;
            impulse.amplitude * from_mean_s * from_mean_s
        });
        squares.sum::<f64>() * 0.5 * acceleration.abs()
    }

    /// The most by which a shaped axis is off where its speed jumps, at a corner passed with
    /// [`Corner::Jump`](crate::Corner::Jump): of jumps within [`duration_s`](Self::duration_s) of
    /// one another the sum of their sizes counts. It comes on top of
    /// [`departure`](Self::departure).
    ///
    /// ```text
    /// |qₛ(t) - q(t - τ)| ≤ jump Σ Aᵢ max(0, τ - τᵢ)
    /// ```
    ///
    /// Proof. A jump by d at the time 0 adds d max(0, t) to the motion, so d Σ Aᵢ max(0, t - τᵢ) to
    /// the shaped one; less d max(0, t - τ), that is largest at t = τ.
    #[must_use]
    pub fn departure_of_jumps(&self, jump: f64) -> f64 {
        let delay_s = self.delay_s();
        let earlier = self.impulses().iter().map(|impulse| {
            let earlier_s = larger_or_nan(0.0, delay_s - impulse.time_s);
            impulse.amplitude * earlier_s
        });
        earlier.sum::<f64>() * jump.abs()
    }

    /// The part of a mode's vibration that is left when the last impulse is over: 0 for none, 1 for
    /// all of what an unshaped impulse leaves at its start. Not a number for a mode that is none.
    ///
    /// ```text
    /// V = exp(-ζω τₙ) |Σ Aᵢ exp(ζω τᵢ + i ω√(1-ζ²) τᵢ)|    ω = 2π f
    /// ```
    #[must_use]
    pub fn residual(&self, mode: Mode) -> f64 {
        let Ok([decay, half_period_s]) = mode.decay_and_half_period() else {
            return f64::NAN;
        };
        let last_s = self.impulses().last().map_or(0.0, |last| last.time_s);
        let [mut real, mut imaginary] = [0.0; 2];
        for impulse in self.impulses() {
            let halves = (impulse.time_s - last_s) / half_period_s;
            let size = impulse.amplitude * libm::exp(halves * decay);
            let (sin, cos) = trig_kernels::sin_cos(halves * PI);
            (real, imaginary) = (real + size * cos, imaginary + size * sin);
        }
        sqrt(real * real + imaginary * imaginary)
    }
}

impl Mode {
    /// The logarithm of 1/K, and half a period of the damped vibration in seconds.
    fn decay_and_half_period(&self) -> Result<[f64; 2], ShaperError> {
        let Self { hz, damping } = *self;
        if !range().contains(&hz) {
            return Err(ShaperError::Mode {
                name: "frequency",
                value: hz,
                min: SMALLEST,
                max: LARGEST,
            });
        }
        if !(0.0..=MAX_DAMPING).contains(&damping) {
            return Err(ShaperError::Mode {
                name: "damping",
                value: damping,
                min: 0.0,
                max: MAX_DAMPING,
            });
        }
        let root = sqrt((1.0 - damping) * (1.0 + damping));
        Ok([damping * PI / root, PI / (TAU * hz * root)])
    }
}

/// The largest damping ratio: beyond it hardly anything rings, and the period has no end.
const MAX_DAMPING: f64 = 0.9;
