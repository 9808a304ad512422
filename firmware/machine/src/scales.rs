//! What the scales of the axes count.

use pulse_interp::{AxisLoop, LoopError, LoopSettings, ScaleRatio};

/// What has been played is known once a block. In motion the alarm is later by what an axis goes in
/// the time of two blocks.
const LAG_S: f64 = 0.01;

/// Counters of scales as a board reads them, made longer than 16 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counters<const N: usize> {
    last: [u16; N],
    /// Since home.
    counts: [i32; N],
    /// Of home, from zero.
    home_steps: [i32; N],
    /// Of corrections, either way, since home.
    corrected_steps: [u32; N],
}

/// What the scales say, and the steps that belong to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading<const N: usize> {
    pub(crate) counts: [i32; N],
    /// That the pins have made, from zero.
    pub(crate) steps: [i32; N],
    pub(crate) home_steps: [i32; N],
    pub(crate) corrected_steps: [u32; N],
}

impl<const N: usize> Counters<N> {
    pub(crate) const fn new() -> Self {
        Self {
            last: [0; N],
            counts: [0; N],
            home_steps: [0; N],
            corrected_steps: [0; N],
        }
    }

    /// As the counters read now, where the pins have made so many steps. From one call to the next
    /// none goes half way round.
    pub(crate) fn read(&mut self, now: [u16; N], steps: [i32; N]) -> Reading<N> {
        for ((counts, last), now) in self.counts.iter_mut().zip(&mut self.last).zip(now) {
            *counts = counts.wrapping_add(i32::from(now.wrapping_sub(*last).cast_signed()));
            *last = now;
        }
        Reading {
            counts: self.counts,
            steps,
            home_steps: self.home_steps,
            corrected_steps: self.corrected_steps,
        }
    }

    /// Here is home, so many steps from zero.
    pub(crate) fn set_home(&mut self, home_steps: [i32; N]) {
        self.home_steps = home_steps;
        (self.counts, self.corrected_steps) = ([0; N], [0; N]);
    }

    pub(crate) fn correct(&mut self, steps: [i32; N]) {
        for (corrected, steps) in self.corrected_steps.iter_mut().zip(steps) {
            *corrected = corrected.saturating_add(steps.unsigned_abs());
        }
    }
}

/// The loop of an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScaleLoop {
    ratio: ScaleRatio,
    pub(crate) at_rest: AxisLoop,
    pub(crate) in_motion: AxisLoop,
}

impl ScaleLoop {
    /// Of an axis whose motor makes at most `steps_s` steps a second.
    pub(crate) fn new(settings: LoopSettings, steps_s: f64) -> Result<Self, LoopError> {
        let [counts, steps] = [settings.ratio.counts(), settings.ratio.steps()].map(f64::from);
        let lag_counts = steps_s * LAG_S * counts / steps;
        Ok(Self {
            ratio: settings.ratio,
            at_rest: AxisLoop::new(settings)?,
            in_motion: AxisLoop::new(LoopSettings {
                alarm_counts: settings.alarm_counts.saturating_add(lag_counts as u32),
                ..settings
            })?,
        })
    }

    /// Where the axis is by its scale, in steps from zero.
    pub(crate) fn steps(&self, counts: i32, home_steps: i32) -> f64 {
        let [per, steps] = [self.ratio.counts(), self.ratio.steps()].map(f64::from);
        f64::from(home_steps) + f64::from(counts) * steps / per
    }
}
