//! The simulated stage: per axis a motor that may lose steps, a scale, two limit switches.

use kurbo::Point;
use machine_sim::{LimitSwitches, Scale, Stepper};
use pulse_interp::{Direction, Switches};

use crate::grid::{STEPS_PER_MM, to_mm};

/// Counts of a scale per step: 500 counts/mm.
pub(crate) const COUNTS_PER_STEP: u16 = 5;
/// Where each axis' switches close, in steps from the drawing's zero: a millimetre beyond travel.
pub(crate) const SWITCHES: [[i32; 2]; 2] = [[-100, 12_100], [-100, 10_100]];

/// How far the axes travel from the drawing's zero, in mm: a millimetre before the upper switch.
pub(crate) const TRAVEL_MM: [f64; 2] = [120.0, 100.0];

/// Where the switches of X and Y close, in mm from the drawing's zero: the lower one first.
#[must_use]
pub fn switches_mm() -> [[f64; 2]; 2] {
    SWITCHES.map(|ends| ends.map(|steps| f64::from(steps) / STEPS_PER_MM))
}

/// Where the stage stands when it is switched on.
const SWITCHED_ON_AT: [i32; 2] = [1731, 942];

/// Step pulses in; counts and switch levels out.
#[derive(Debug, Clone)]
pub(crate) struct Stage {
    axes: [Axis; 2],
}

#[derive(Debug, Clone)]
struct Axis {
    motor: Stepper,
    scale: Scale,
    switches: LimitSwitches,
}

impl Stage {
    /// A stage that has just been switched on.
    pub(crate) fn new(lose_steps: f64, seed: u64) -> Self {
        let axis = |index: usize, at: i32, [lower, upper]: [i32; 2]| {
            let mut scale = Scale::new(COUNTS_PER_STEP);
            scale.set_zero(at);
            // Each axis loses other steps.
            let seed = seed.wrapping_mul(2).wrapping_add(index as u64);
            Axis {
                motor: Stepper::at(at).losing(lose_steps, seed),
                scale,
                switches: LimitSwitches::new(lower, upper),
            }
        };
        let [x, y] = SWITCHED_ON_AT;
        let [x_switches, y_switches] = SWITCHES;
        Self {
            axes: [axis(0, x, x_switches), axis(1, y, y_switches)],
        }
    }

    /// One pulse of an axis' motor.
    pub(crate) fn pulse(&mut self, axis: usize, direction: Direction) {
        if let Some(axis) = self.axes.get_mut(axis) {
            axis.motor.step(direction.sign());
        }
    }

    /// What the scales read.
    pub(crate) fn counts(&self) -> [i32; 2] {
        let count = |axis: &Axis| axis.scale.counts(axis.motor.position());
        self.axes.each_ref().map(count)
    }

    /// The switches of both axes.
    pub(crate) fn switches(&self) -> [Switches; 2] {
        self.axes.each_ref().map(|axis| {
            let [lower, upper] = axis.switches.closed(axis.motor.position());
            Switches { lower, upper }
        })
    }

    /// Sets all scales to 0 here.
    pub(crate) fn zero(&mut self) {
        for axis in &mut self.axes {
            axis.scale.set_zero(axis.motor.position());
        }
    }

    /// Counts lost steps from here on.
    pub(crate) fn forget_lost(&mut self) {
        for axis in &mut self.axes {
            axis.motor.forget_lost();
        }
    }

    /// Where the stage really is, for the observer alone.
    pub(crate) fn at_mm(&self) -> Point {
        to_mm(self.axes.each_ref().map(|axis| axis.motor.position()))
    }

    pub(crate) fn lost(&self) -> u64 {
        self.axes.iter().map(|axis| axis.motor.lost()).sum()
    }
}
