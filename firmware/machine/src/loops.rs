//! The loop closed on the scales of the axes, where the settings name some and the board counts them.
//!
//! ```text
//! at rest     counts against commanded steps: up to the alarm the axis is stepped back to its place
//! in motion   the same once a row, and no step more: an axis that is lost brings all to rest
//! ```
//! Steps of a correction are the motor's, not the path's: they count nowhere.

use core::fmt::{self, Display, Formatter};

use pulse_interp::{AxisLoop, LostSteps};
use pvt_steps::Direction;

use crate::blocks::BlockWriter;
use crate::inputs::Inputs;
use crate::kinematics::Kinematics;
use crate::panel::Panel;
use crate::scales::ScaleLoop;
use crate::settings::Machine;

/// Corrections at a rest, after which an axis has to be in its place.
const CORRECTIONS: usize = 3;
/// An axis stands for a 50th of a second before its scale is read.
const SETTLE_HZ: u32 = 50;

/// Why a loop cannot be closed.
pub(crate) enum NotClosed {
    Lost {
        axis: &'static str,
        error: LostSteps,
    },
    /// Corrections do not bring the axis to its place.
    Off { axis: &'static str, steps: i32 },
}

impl Display for NotClosed {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lost { axis, error } => write!(f, "{axis} is {error}"),
            Self::Off { axis, steps } => write!(
                f,
                "{axis} is {steps} steps off after {CORRECTIONS} corrections"
            ),
        }
    }
}

/// The loops of the axes that have a scale.
pub(crate) struct Loops<'m, I, const N: usize> {
    panel: &'m Panel<N>,
    inputs: &'m I,
    loops: [Option<ScaleLoop>; N],
    /// Whether there is one.
    are_some: bool,
}

impl<'m, I: Inputs<N>, const N: usize> Loops<'m, I, N> {
    pub(crate) fn new<K>(machine: &Machine<K, N>, panel: &'m Panel<N>, inputs: &'m I) -> Self {
        Self {
            panel,
            inputs,
            loops: machine.loops,
            are_some: machine.has_scales(),
        }
    }

    /// What the counters read, where that is asked for.
    fn counts(&self) -> Option<[u16; N]> {
        self.inputs.counts().filter(|_| self.are_some)
    }

    /// The axes stand at home, so many steps from zero.
    pub(crate) fn set_home(&mut self, home_steps: [i32; N]) {
        for axis in self.loops.iter_mut().flatten() {
            axis.at_rest.reset();
            axis.in_motion.reset();
        }
        if let Some(counts) = self.counts() {
            self.panel.read_scales(counts);
            self.panel.set_home(home_steps);
        }
    }

    /// Whether each axis, as it moves, is about where the pins have brought it.
    pub(crate) fn check<K: Kinematics<N>>(&mut self) -> Result<(), NotClosed> {
        self.corrections::<K>(|axis| &mut axis.in_motion)?;
        Ok(())
    }

    /// Waits after a motion that has ended at `end` until the axes stand, if scales are to be read.
    pub(crate) async fn settle<K>(
        &self,
        machine: &Machine<K, N>,
        writer: &mut BlockWriter<'_, N>,
        end: u64,
    ) {
        if self.counts().is_some() {
            writer.rest(end + settle_ticks(machine)).await;
            self.panel.all_played().await;
            writer.restart(end);
        }
    }

    /// Brings the axes, which stand, to where the panel says that they are. `end` is when the last
    /// motion has ended, from where the times of the next one count.
    pub(crate) async fn close<K: Kinematics<N>>(
        &mut self,
        machine: &Machine<K, N>,
        writer: &mut BlockWriter<'_, N>,
        end: u64,
    ) -> Result<(), NotClosed> {
        let steps = self.panel.steps();
        for _ in 0..CORRECTIONS {
            let corrections = self.corrections::<K>(|axis| &mut axis.at_rest)?;
            if corrections == [0; N] {
                return Ok(());
            }
            let ticks = make(machine, writer, corrections, end).await;
            writer.rest(ticks + settle_ticks(machine)).await;
            self.panel.all_played().await;
            writer.restart(end);
            writer.set_steps(steps);
            self.panel.corrected(corrections);
        }
        let corrections = self.corrections::<K>(|axis| &mut axis.at_rest)?;
        match corrections.iter().position(|&steps| steps != 0) {
            None => Ok(()),
            Some(axis) => Err(NotClosed::Off {
                axis: K::AXES[axis],
                steps: -corrections[axis],
            }),
        }
    }

    /// Steps that bring each axis to its place: none where the board counts nothing.
    fn corrections<K: Kinematics<N>>(
        &mut self,
        of: impl Fn(&mut ScaleLoop) -> &mut AxisLoop,
    ) -> Result<[i32; N], NotClosed> {
        let mut corrections = [0; N];
        let Some(counts) = self.counts() else {
            return Ok(corrections);
        };
        let reading = self.panel.read_scales(counts);
        for (axis, scale) in self.loops.iter_mut().enumerate() {
            let Some(scale) = scale else { continue };
            let closed = of(scale);
            let (steps, home) = (reading.steps[axis], reading.home_steps[axis]);
            closed.set_commanded(i64::from(steps) - i64::from(home));
            let correction = closed.correction(reading.counts[axis]);
            corrections[axis] = correction.map_err(|error| NotClosed::Lost {
                axis: K::AXES[axis],
                error,
            })?;
        }
        Ok(corrections)
    }
}

/// How long after its last step an axis stands, and its scale may be read.
fn settle_ticks<K, const N: usize>(machine: &Machine<K, N>) -> u64 {
    u64::from(machine.tick_hz / SETTLE_HZ)
}

/// The steps of a correction, after a tick; the tick at which they end.
async fn make<K, const N: usize>(
    machine: &Machine<K, N>,
    writer: &mut BlockWriter<'_, N>,
    corrections: [i32; N],
    after: u64,
) -> u64 {
    // A word takes a tick at least.
    let mut ticks = after + 1;
    for (axis, steps) in corrections.into_iter().enumerate() {
        let direction = match steps {
            0.. => Direction::Positive,
            _ => Direction::Negative,
        };
        for _ in 0..steps.unsigned_abs() {
            writer.step(axis, ticks, direction).await;
            ticks += u64::from(machine.homing_fast_ticks);
        }
    }
    ticks
}
