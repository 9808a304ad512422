//! Taps: where on the motion each impulse of a shaper is.

use crate::number::smaller;
use crate::{Impulse, Shaper};

/// Rows nearer to each other than this, in seconds, are one: below the tick of any timer, and below
/// what the time of a row is known to.
pub(super) const MIN_GAP_S: f64 = 1e-9;

/// One impulse of an axis: the axis on its cubic, so much later than the rows come.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tap {
    amplitude: f64,
    /// q = c₀ + c₁ t + c₂ t² + c₃ t³
    cubic: [f64; 4],
    /// Of the segment; infinite where no row follows.
    duration_s: f64,
    /// Since the start of the segment; since the rest began where no row follows.
    elapsed_s: f64,
    /// Rows that have come after the one that it runs to.
    behind: usize,
}

impl Tap {
    const NONE: Self = Self {
        amplitude: 0.0,
        cubic: [0.0; 4],
        duration_s: f64::INFINITY,
        elapsed_s: 0.0,
        behind: 0,
    };

    /// At rest at the first row, which it begins at after a delay.
    const fn waiting(amplitude: f64, delay_s: f64, position: f64) -> Self {
        let mut tap = Self::NONE;
        tap.amplitude = amplitude;
        tap.cubic = [position, 0.0, 0.0, 0.0];
        if delay_s > MIN_GAP_S {
            tap.duration_s = delay_s;
        }
        tap
    }

    const fn is_idle(&self) -> bool {
        self.duration_s == f64::INFINITY
    }

    /// Rows that have come after the one that it runs to.
    pub(super) const fn behind(&self) -> usize {
        if self.is_idle() { 0 } else { self.behind }
    }

    /// Whether the row after the one that it runs to has come.
    pub(super) const fn knows_next(&self) -> bool {
        !self.is_idle() && self.behind > 0
    }

    /// Seconds to the row that it runs to.
    const fn remaining_s(&self) -> f64 {
        self.duration_s - self.elapsed_s
    }

    /// How long it has been at rest, for want of rows.
    pub(super) const fn idle_s(&self) -> f64 {
        if self.is_idle() { self.elapsed_s } else { 0.0 }
    }

    fn position_and_velocity(&self) -> [f64; 2] {
        let [c0, c1, c2, c3] = self.cubic;
        let t = self.elapsed_s;
        if self.is_idle() {
            return [c0, c1];
        }
        [
            c0 + (c1 + (c2 + c3 * t) * t) * t,
            c1 + (2.0 * c2 + 3.0 * c3 * t) * t,
        ]
    }

    /// Stays at the row, for no row follows.
    const fn rest(&mut self, [position, velocity]: [f64; 2], elapsed_s: f64) {
        self.cubic = [position, velocity, 0.0, 0.0];
        (self.duration_s, self.elapsed_s) = (f64::INFINITY, elapsed_s);
    }

    /// Begins a segment.
    const fn run(&mut self, [q0, v0]: [f64; 2], [q1, v1]: [f64; 2], duration_s: f64) {
        self.duration_s = duration_s;
        if duration_s > 0.0 {
            let inverse = 1.0 / duration_s;
            let mean = (q1 - q0) * inverse;
            self.cubic = [
                q0,
                v0,
                (3.0 * mean - 2.0 * v0 - v1) * inverse,
                (v0 + v1 - 2.0 * mean) * inverse * inverse,
            ];
        } else {
            self.cubic = [q0, v0, 0.0, 0.0];
        }
    }
}

/// The taps of one axis, by delay.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisTaps {
    taps: [Tap; Shaper::MAX_IMPULSES],
    count: usize,
}

impl AxisTaps {
    pub(super) const NONE: Self = Self {
        taps: [Tap::NONE; Shaper::MAX_IMPULSES],
        count: 0,
    };

    /// The taps of a shaper, each so much later than its impulse, at rest.
    pub(super) fn new(shaper: &Shaper, later_s: f64, position: f64) -> Self {
        let mut axis = Self::NONE;
        for (tap, impulse) in axis.taps.iter_mut().zip(shaper.impulses()) {
            let Impulse { time_s, amplitude } = *impulse;
            *tap = Tap::waiting(amplitude, time_s + later_s, position);
            axis.count = axis.count.saturating_add(1);
        }
        axis
    }

    pub(super) fn taps(&self) -> &[Tap] {
        self.taps.get(..self.count).unwrap_or_default()
    }

    fn taps_mut(&mut self) -> &mut [Tap] {
        self.taps.get_mut(..self.count).unwrap_or_default()
    }

    /// Seconds to the next row of any tap; infinite where all rest.
    #[inline]
    pub(super) fn next_s(&self) -> f64 {
        let rows = self.taps().iter().map(Tap::remaining_s);
        rows.fold(f64::INFINITY, smaller)
    }

    /// Rows that have come after the one that the last of them runs to.
    pub(super) fn behind(&self) -> usize {
        self.taps().iter().map(Tap::behind).max().unwrap_or(0)
    }

    /// A row has come, of which `rows` has the last two numbers of this axis.
    pub(super) fn push(&mut self, rows: [[f64; 2]; 2], duration_s: f64) {
        let [from, to] = rows;
        for tap in self.taps_mut() {
            if !tap.is_idle() {
                tap.behind = tap.behind.saturating_add(1);
                continue;
            }
            tap.behind = 0;
            if tap.elapsed_s >= duration_s && duration_s > 0.0 {
                // It has rested that long already.
                let elapsed_s = tap.elapsed_s - duration_s;
                tap.rest(to, elapsed_s);
            } else {
                tap.run(from, to, duration_s);
            }
        }
    }

    /// Goes on by so many seconds. `row` gives the numbers of this axis and the duration of the
    /// segment before, of a row by how many have come after it.
    #[inline]
    pub(super) fn advance(&mut self, step_s: f64, row: impl Fn(usize) -> Option<([f64; 2], f64)>) {
        for tap in self.taps_mut() {
            let mut remaining_s = tap.remaining_s() - step_s;
            tap.elapsed_s += step_s;
            while remaining_s <= MIN_GAP_S {
                let after = tap.behind.checked_sub(1).and_then(&row);
                // At a jump to the instant: positions would depart by the jump times the gap.
                let is_early = remaining_s > 0.0;
                if is_early && after.is_some_and(|(_, duration_s)| duration_s <= 0.0) {
                    break;
                }
                let Some((from, _)) = row(tap.behind) else {
                    return;
                };
                tap.elapsed_s = -remaining_s;
                let Some((to, duration_s)) = after else {
                    tap.rest(from, -remaining_s);
                    break;
                };
                tap.behind = tap.behind.saturating_sub(1);
                tap.run(from, to, duration_s);
                if duration_s <= 0.0 {
                    tap.elapsed_s = 0.0;
                    break;
                }
                remaining_s += duration_s;
            }
        }
    }

    /// The mean of the taps: exactly what all of them have where they have the same.
    ///
    /// ```text
    /// q = q₁ + Σ Aᵢ (qᵢ - q₁)
    /// ```
    #[inline]
    pub(super) fn mean(&self) -> [f64; 2] {
        let Some((first, others)) = self.taps().split_first() else {
            return [0.0; 2];
        };
        let [q1, v1] = first.position_and_velocity();
        let (mut position, mut velocity) = (0.0, 0.0);
        for tap in others {
            let [q, v] = tap.position_and_velocity();
            position += tap.amplitude * (q - q1);
            velocity += tap.amplitude * (v - v1);
        }
        [q1 + position, v1 + velocity]
    }
}
