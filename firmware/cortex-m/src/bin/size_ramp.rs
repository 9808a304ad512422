//! A ramp of two axes, one edge after the other.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use pvt_steps::{Ramp, RampLimits};
use stepper_sync::Rate;

fn work() -> Option<u64> {
    let limits = RampLimits {
        start_millihertz: 0,
        max_millihertz: 2_000_000,
        accel_steps_per_s2: black_box(10_000),
    };
    let rate = Rate::from_hz(1_000_000).ok()?;
    let ramp = Ramp::new(black_box([4000, -1500]), &limits, rate).ok()?;
    Some(ramp.edges().last()?.ticks)
}
