//! Speeds to steps by accumulators: one addition and one comparison per motor and tick.

mod law;

pub use law::{Accumulation, AccumulatorError, SpeedLaw};

/// Lowest threshold: the highest speed, -128, makes one step every tick.
const MIN_THRESHOLD: u16 = i8::MIN.unsigned_abs() as u16;

/// Highest threshold: an accumulator below it and a speed add up to 16 bits at most.
const MAX_THRESHOLD: u16 = i16::MAX.unsigned_abs().wrapping_sub(MIN_THRESHOLD);

/// Accumulators of N motors: every tick each gains its motor's speed, and at the threshold the
/// motor makes a step.
///
/// Speeds are -128..=127, each worth `speed / threshold` steps per tick; see [`Accumulation`] for
/// the law. `tick()` has no division, no multiplication and no branch that depends on a motor.
/// Source: \[Dancer\].
///
/// # Examples
/// ```
/// use motor_phases::{Accumulation, Rate, SpeedLaw};
/// let mut motors = Accumulation::new(SpeedLaw::CarrySigned, 600, Rate::from_hz(1000)?)?.motors();
/// motors.set_speeds([60, -60]);
/// // Frames of 200 ticks: a step every 10.
/// let mut positions = [0_i32; 2];
/// for _ in 0..200 {
///     for (position, step) in positions.iter_mut().zip(motors.tick()) {
///         *position += step;
///     }
/// }
/// assert_eq!(positions, [20, -20]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Accumulators<const N: usize> {
    // Below the threshold; under `CarrySigned` above its negative.
    sums: [i16; N],
    // What a tick adds: magnitudes; under `CarrySigned` speeds.
    gains: [i16; N],
    // -1, 0 or 1.
    signs: [i16; N],
    // Within 128..=32639.
    threshold: i16,
    law: SpeedLaw,
}

impl<const N: usize> Accumulators<N> {
    const fn new(law: SpeedLaw, threshold: i16) -> Self {
        Self {
            sums: [0; N],
            gains: [0; N],
            signs: [0; N],
            threshold,
            law,
        }
    }

    /// Takes the speeds of a frame. The accumulators keep what they have gathered.
    pub fn set_speeds(&mut self, speeds: [i8; N]) {
        let speeds = speeds.map(i16::from);
        self.signs = speeds.map(i16::signum);
        self.gains = match self.law {
            SpeedLaw::Reset | SpeedLaw::CarryMagnitude => speeds.map(i16::wrapping_abs),
            SpeedLaw::CarrySigned => speeds,
        };
    }

    /// What each accumulator has gathered: 0 to below the threshold; with its sign under
    /// [`SpeedLaw::CarrySigned`].
    #[must_use]
    pub const fn sums(&self) -> [i16; N] {
        self.sums
    }

    /// One tick: the step of each motor, -1, 0 or 1.
    #[inline]
    #[must_use = "these are the steps to make"]
    pub fn tick(&mut self) -> [i32; N] {
        let threshold = self.threshold;
        match self.law {
            SpeedLaw::Reset => self.each(|sum, sign| {
                let due = mask(sum >= threshold);
                (sum & !due, sign & due)
            }),
            SpeedLaw::CarryMagnitude => self.each(|sum, sign| {
                let due = mask(sum >= threshold);
                (sum.wrapping_sub(threshold & due), sign & due)
            }),
            SpeedLaw::CarrySigned => self.each(|sum, _| {
                let forward = mask(sum >= threshold);
                let back = mask(sum <= threshold.wrapping_neg());
                let taken = (threshold & forward).wrapping_sub(threshold & back);
                (sum.wrapping_sub(taken), back.wrapping_sub(forward))
            }),
        }
    }

    /// Adds to each sum, and lets the law make sum and step of sum and sign.
    #[inline]
    fn each(&mut self, law: impl Fn(i16, i16) -> (i16, i16)) -> [i32; N] {
        let mut steps = [0; N];
        let gains = self.gains.iter().zip(&self.signs);
        for ((sum, (&gain, &sign)), step) in self.sums.iter_mut().zip(gains).zip(&mut steps) {
            // |sum| < 32639 and |gain| <= 128 fit 16 bits.
            let (left, made) = law(sum.wrapping_add(gain), sign);
            *sum = left;
            *step = i32::from(made);
        }
        steps
    }
}

/// All ones or all zeros: chosen without a branch, so that eight motors fit one vector register.
#[inline]
fn mask(condition: bool) -> i16 {
    i16::from(condition).wrapping_neg()
}
