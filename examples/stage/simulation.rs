//! The simulated stage: two motors that count pulses and lose some, scales, limit switches.

use kurbo::Point;
use pose2pulse::pulse_interp::{Direction, Switches};

use crate::plan::to_mm;

/// Counts of a scale per step: 500 counts/mm.
pub(crate) const COUNTS_PER_STEP: u16 = 5;
/// Where each axis' switches close, in steps from the drawing's zero: a millimetre beyond travel.
pub(crate) const SWITCHES: [[i32; 2]; 2] = [[-100, 12_100], [-100, 10_100]];
/// Where the stage stands when it is switched on.
const SWITCHED_ON_AT: [i32; 2] = [1731, 942];

/// Step pulses in; counts and switch levels out.
#[derive(Debug, Clone)]
pub(crate) struct Stage {
    steps: [i32; 2],
    scale_zero: [i32; 2],
    lose: f64,
    random: u64,
    lost: u64,
}

impl Stage {
    pub(crate) const fn new(lose: f64, seed: u64) -> Self {
        Self {
            steps: SWITCHED_ON_AT,
            scale_zero: SWITCHED_ON_AT,
            lose,
            random: seed,
            lost: 0,
        }
    }

    /// One pulse of an axis' motor.
    pub(crate) fn pulse(&mut self, axis: usize, direction: Direction) {
        if self.lose > 0.0 && self.random_share() < self.lose {
            self.lost += 1;
        } else if let Some(steps) = self.steps.get_mut(axis) {
            *steps += direction.sign();
        }
    }

    /// What the scale of an axis reads.
    pub(crate) fn counts(&self, axis: usize) -> i32 {
        let of = |steps: &[i32; 2]| steps.get(axis).copied().unwrap_or_default();
        (of(&self.steps) - of(&self.scale_zero)) * i32::from(COUNTS_PER_STEP)
    }

    pub(crate) fn switches(&self, axis: usize) -> Switches {
        match (self.steps.get(axis), SWITCHES.get(axis)) {
            (Some(at), Some([lower, upper])) => Switches {
                lower: at <= lower,
                upper: at >= upper,
            },
            _ => Switches::default(),
        }
    }

    /// Sets all scales to 0 here.
    pub(crate) const fn zero(&mut self) {
        self.scale_zero = self.steps;
    }

    /// Counts lost steps from here on.
    pub(crate) const fn forget_lost(&mut self) {
        self.lost = 0;
    }

    /// Where the stage really is, for the observer alone.
    pub(crate) fn at_mm(&self) -> Point {
        to_mm(self.steps)
    }

    pub(crate) const fn lost(&self) -> u64 {
        self.lost
    }

    /// In 0..1, by `SplitMix64`.
    fn random_share(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.random;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let high = u32::try_from((z ^ (z >> 31)) >> 32).unwrap_or(0);
        f64::from(high) / 4_294_967_296.0
    }
}
