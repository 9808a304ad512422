//! A pendant's driver and its wheel.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;
use core::time::Duration;

use handwheel::{Driver, Model, Timeouts, WheelQuantiser};

fn work() -> Option<i64> {
    let now = Duration::ZERO;
    let mut driver = Driver::new(Model::Hbls, Timeouts::DEFAULT);
    black_box(driver.poll_transmit(now)?);
    driver.handle_delivered(now);
    driver.handle_block(now, black_box(&[0x30, 0x43, 0x52]));
    black_box(driver.poll_event()?);
    let wheel = WheelQuantiser::new(black_box(100), 10).ok()?;
    Some(wheel.speed(black_box(-57), 10_000))
}
