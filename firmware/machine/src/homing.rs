//! All axes to their switches, one after the other.
//!
//! What is handed out is ahead of the pins by the longest word, so that no step is late: when that
//! has been played, as much again follows. A fast step is decided some steps before it is made. A
//! slow one has to be decided with the switch as the step before has left it: where slow steps are
//! not that far apart, the pins rest between them.

use pulse_interp::{Direction, Homing, HomingError, HomingOrder, HomingSpeed};

use crate::blocks::{BlockWriter, max_word_ticks};
use crate::inputs::Inputs;
use crate::panel::{Panel, Wanted};
use crate::settings::Machine;

/// Why there is no home.
pub(crate) enum NoHome {
    Stopped,
    Switch { axis: usize, error: HomingError },
}

/// All axes to their switches.
pub(crate) async fn home<K, const N: usize>(
    machine: &Machine<K, N>,
    panel: &Panel<N>,
    inputs: &impl Inputs<N>,
    writer: &mut BlockWriter<'_, N>,
) -> Result<(), NoHome> {
    writer.restart(0);
    // A word takes a tick at least.
    let mut ticks = 1;
    let mut found = Ok(());
    for axis in 0..N {
        if found.is_ok() {
            found = home_axis(machine, panel, writer, axis, &mut ticks, inputs).await;
        }
    }
    // The blocks before have said that others follow.
    writer
        .rest(ticks + u64::from(max_word_ticks(machine)))
        .await;
    panel.all_played().await;
    found
}

async fn home_axis<K, const N: usize>(
    machine: &Machine<K, N>,
    panel: &Panel<N>,
    writer: &mut BlockWriter<'_, N>,
    axis: usize,
    ticks: &mut u64,
    inputs: &impl Inputs<N>,
) -> Result<(), NoHome> {
    let mut homing = Homing::new(machine.homing[axis]);
    loop {
        if panel.wanted().0 == Wanted::Stop {
            return Err(NoHome::Stopped);
        }
        let order = homing.next(inputs.closed()[axis]);
        let order = order.map_err(|error| NoHome::Switch { axis, error })?;
        let HomingOrder::Step { direction, speed } = order else {
            return Ok(());
        };
        let direction = match direction {
            Direction::Positive => pvt_steps::Direction::Positive,
            Direction::Negative => pvt_steps::Direction::Negative,
        };
        writer.step(axis, *ticks, direction).await;
        let interval = match speed {
            HomingSpeed::Fast => machine.homing_fast_ticks,
            HomingSpeed::Slow => machine.homing_slow_ticks,
        };
        *ticks += u64::from(interval);
        let ahead = max_word_ticks(machine);
        match speed {
            HomingSpeed::Fast => {
                writer.go_on(*ticks).await;
                panel.all_played_but(2 * ahead).await;
            }
            HomingSpeed::Slow if interval >= 2 * ahead => {
                writer.go_on(*ticks).await;
                panel.all_played_but(ahead).await;
            }
            HomingSpeed::Slow => {
                writer.rest(*ticks).await;
                panel.all_played().await;
            }
        }
    }
}
