//! The simulated locators: every axis for itself, from jogs and from tables.

use nalgebra::Vector3;
use pose_pt::Platform;

use crate::panel::Axis;
use crate::table::{AxisState, States, Table, positions};

/// Cycle of the drives, in microseconds.
pub(crate) const CYCLE_US: u64 = 1000;
const CYCLE_S: f64 = 1e-3;
enum Motion<const N: usize> {
    Hold,
    Jog {
        locator: usize,
        axis: usize,
        /// In mm per second.
        speed: f64,
    },
    Table {
        table: Table<N>,
        start_us: u64,
    },
}

/// The axes of all locators.
pub(crate) struct Drives<const N: usize> {
    states: States<N>,
    accelerations: [[f64; 3]; N],
    /// Ends of each axis, in mm.
    strokes: [[(f64, f64); 3]; N],
    motion: Motion<N>,
    now_us: u64,
}

impl<const N: usize> Drives<N> {
    pub(crate) fn new(platform: &Platform<N>, axes: &[Vector3<f64>; N]) -> Self {
        let state = |position| AxisState {
            position,
            speed: 0.0,
        };
        Self {
            states: axes.map(|it| [it.x, it.y, it.z].map(state)),
            accelerations: platform
                .locators()
                .map(|it| it.limits.map(|limits| limits.acceleration)),
            strokes: platform
                .locators()
                .map(|it| it.limits.map(|limits| (limits.min, limits.max))),
            motion: Motion::Hold,
            now_us: 0,
        }
    }

    pub(crate) const fn states(&self) -> &States<N> {
        &self.states
    }

    pub(crate) fn axes(&self) -> [Vector3<f64>; N] {
        positions(&self.states)
    }

    /// When the next cycle is due.
    pub(crate) const fn due_us(&self) -> Option<u64> {
        match self.motion {
            Motion::Hold => None,
            _ => Some(self.now_us + CYCLE_US),
        }
    }

    /// Moves one axis at a speed, in mm per second; 0 stops it.
    pub(crate) fn jog(&mut self, now_us: u64, locator: u8, axis: Axis, speed: f64) {
        self.begin(now_us);
        self.motion = Motion::Jog {
            locator: locator.into(),
            axis: axis.index(),
            speed,
        };
    }

    pub(crate) fn run(&mut self, now_us: u64, table: Table<N>) {
        self.begin(now_us);
        let start_us = self.now_us;
        self.motion = Motion::Table { table, start_us };
    }

    /// Brakes the axis that is jogged; a table is given up where it is. True when everything is
    /// at rest at once.
    pub(crate) fn stop(&mut self) -> bool {
        match &mut self.motion {
            Motion::Jog { speed, .. } => {
                *speed = 0.0;
                false
            }
            motion => {
                *motion = Motion::Hold;
                true
            }
        }
    }

    fn begin(&mut self, now_us: u64) {
        if matches!(self.motion, Motion::Hold) {
            self.now_us = now_us;
        }
    }

    /// One cycle; true when it has brought everything to rest.
    pub(crate) fn cycle(&mut self) -> bool {
        self.now_us += CYCLE_US;
        match &mut self.motion {
            Motion::Hold => return false,
            Motion::Jog {
                locator,
                axis,
                speed,
            } => {
                let acceleration = self
                    .accelerations
                    .get(*locator)
                    .and_then(|it| it.get(*axis));
                let state = self
                    .states
                    .get_mut(*locator)
                    .and_then(|it| it.get_mut(*axis));
                if let (Some(state), Some(acceleration)) = (state, acceleration) {
                    let max_change = acceleration * CYCLE_S;
                    let change = (*speed - state.speed).clamp(-max_change, max_change);
                    state.position += (state.speed + change / 2.0) * CYCLE_S;
                    state.speed += change;
                    let stroke = self.strokes.get(*locator).and_then(|it| it.get(*axis));
                    if let Some(&(min, max)) = stroke
                        && !(min..=max).contains(&state.position)
                    {
                        // The drive ends a jog at the end of the stroke by itself.
                        state.position = state.position.clamp(min, max);
                        state.speed = 0.0;
                        *speed = 0.0;
                    }
                    if *speed != 0.0 || state.speed != 0.0 {
                        return false;
                    }
                }
            }
            Motion::Table { table, start_us } => {
                #[expect(clippy::cast_precision_loss, reason = "hours of microseconds")]
                let time_s = (self.now_us - *start_us) as f64 * 1e-6;
                self.states = table.at(time_s).unwrap_or(self.states);
                if time_s < table.duration_s() {
                    return false;
                }
                for state in self.states.iter_mut().flatten() {
                    state.speed = 0.0;
                }
            }
        }
        self.motion = Motion::Hold;
        true
    }
}
