//! The same program on the same tables, not shaped.

use anyhow::{Result, ensure};
use known_load::Vibration;

use crate::drive::Drive;
use crate::machine::Machine;
use crate::motors::Motors;
use crate::planned::Planned;
use crate::record::Record;
use crate::settings::{Settings, Stepping};
use crate::timed::ChainPath;

/// How the tables of X and Y swing then; none where no modes are known, steps are not timed, or a
/// motion was broken off.
pub(crate) fn vibration(
    machine: &Machine,
    settings: &Settings,
    record: &Record,
) -> Result<Option<[Vibration; 2]>> {
    let (Some(plain), Some(chains), Stepping::Timed) =
        (machine.unshaped(), &record.chains, settings.stepping)
    else {
        return Ok(None);
    };
    let mut rest = record.programmed.as_slice();
    let Some(first) = rest.first() else {
        return Ok(None);
    };
    let mut motors = Motors::new(&plain);
    let mut drive = Drive::at_rest(0, first.from, plain.start_stop_mm_s)?;
    for count in chains {
        ensure!(
            *count <= rest.len(),
            "a chain has motions that have not begun"
        );
        let (chain, later) = rest.split_at(*count);
        let path = ChainPath::new(&plain, chain, settings.tolerance_mm)?;
        drive.begin();
        for row in Planned::new(&plain, &path)?.rows.iter().skip(1) {
            for (ticks, by) in drive.row(row)? {
                motors.step(ticks, by);
            }
        }
        rest = later;
    }
    Ok(motors.finish().vibration)
}
