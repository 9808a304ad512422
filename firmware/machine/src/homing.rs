//! Both joints to their switches, one after the other.

use pulse_interp::{Direction, Homing, HomingError, HomingOrder, HomingSpeed};

use crate::blocks::BlockWriter;
use crate::panel::{Panel, Wanted};
use crate::settings::Machine;

/// Why there is no home.
pub(crate) enum NoHome {
    Stopped,
    Switch { joint: usize, error: HomingError },
}

/// Steps to each switch: a step, its time, a look at the switch. `closed` says which are.
pub(crate) async fn home(
    machine: &Machine,
    panel: &Panel,
    writer: &mut BlockWriter<'_>,
    closed: &mut impl FnMut() -> [bool; 2],
) -> Result<(), NoHome> {
    let mut ticks = 0;
    writer.restart(ticks);
    for joint in 0..2 {
        let mut homing = Homing::new(machine.homing[joint]);
        loop {
            if panel.wanted().0 == Wanted::Stop {
                return Err(NoHome::Stopped);
            }
            let order = homing.next(closed()[joint]);
            let order = order.map_err(|error| NoHome::Switch { joint, error })?;
            let HomingOrder::Step { direction, speed } = order else {
                break;
            };
            let direction = match direction {
                Direction::Positive => pvt_steps::Direction::Positive,
                Direction::Negative => pvt_steps::Direction::Negative,
            };
            writer.step(joint, ticks, direction).await;
            ticks += u64::from(match speed {
                HomingSpeed::Fast => machine.homing_fast_ticks,
                HomingSpeed::Slow => machine.homing_slow_ticks,
            });
            writer.rest(ticks).await;
            panel.all_played().await;
        }
    }
    Ok(())
}
