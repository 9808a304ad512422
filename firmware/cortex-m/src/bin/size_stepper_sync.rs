//! Two trains, one edge after the other.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use stepper_sync::Trains;

fn work() -> Option<u64> {
    let trains = Trains::new(black_box([30, -7]), 4096).ok()?;
    Some(trains.edges().last()?.ticks)
}
