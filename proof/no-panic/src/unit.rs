//! handwheel.

use std::hint::black_box;
use std::time::Duration;

use handwheel::{
    Command, DecodeError, Driver, EncodeError, Event, Job, LcdBlock, LcdCommand, LcdError, Model,
    Report, SubmitError, Timeouts, WheelQuantiser, WheelSampler,
};
use no_panic::no_panic;

#[no_panic]
#[inline(never)]
fn report_decode(model: Model, telegram: &[u8]) -> Result<Report, DecodeError> {
    Report::decode(model, telegram)
}

#[no_panic]
#[inline(never)]
fn report_encode(report: Report, model: Model, buffer: &mut [u8]) -> Result<&[u8], EncodeError> {
    report.encode(model, buffer)
}

#[no_panic]
#[inline(never)]
fn command_encode<'b>(
    command: Command<'_>,
    model: Model,
    buffer: &'b mut [u8],
) -> Result<&'b [u8], EncodeError> {
    command.encode(model, buffer)
}

#[no_panic]
#[inline(never)]
fn read_commands(model: Model, telegram: &[u8]) -> usize {
    match Command::decode(model, telegram) {
        Ok(Command::Lcd(commands)) => commands.filter(Result::is_ok).count(),
        _ => 0,
    }
}

#[no_panic]
#[inline(never)]
fn push(block: &mut LcdBlock, command: LcdCommand<'_>) -> Result<(), LcdError> {
    block.push(command)
}

#[no_panic]
#[inline(never)]
fn driver_submit(driver: &mut Driver, job: Job) -> Result<(), SubmitError> {
    driver.submit(job)
}

#[no_panic]
#[inline(never)]
fn driver_transmit(driver: &mut Driver, now: Duration) -> Option<&[u8]> {
    driver.poll_transmit(now)
}

#[no_panic]
#[inline(never)]
fn driver_event(driver: &mut Driver) -> Option<Event> {
    driver.poll_event()
}

#[no_panic]
#[inline(never)]
fn driver_block(driver: &mut Driver, now: Duration, telegram: &[u8]) {
    driver.handle_block(now, telegram);
}

#[no_panic]
#[inline(never)]
fn driver_delivered(driver: &mut Driver, now: Duration) {
    driver.handle_delivered(now);
}

#[no_panic]
#[inline(never)]
fn driver_failed(driver: &mut Driver, now: Duration) {
    driver.handle_failed(now);
}

#[no_panic]
#[inline(never)]
fn driver_timeout(driver: &mut Driver, now: Duration) {
    driver.handle_timeout(now);
}

#[no_panic]
#[inline(never)]
fn wheel_share(wheel: &WheelQuantiser, counts: i32, full: u32) -> i64 {
    wheel.speed(counts, full)
}

#[no_panic]
#[inline(never)]
fn wheel_sample(sampler: &mut WheelSampler, now: Duration, counter: u32) -> Option<i32> {
    sampler.sample(now, counter)
}

pub fn run() {
    let (now, model) = (black_box(Duration::ZERO), black_box(Model::Hbls));
    let telegram = black_box([0x6C, 0x27, 0x34, 0x30, 0xA5].as_slice());
    let buffer = &mut [0; 200];
    if let Ok(report) = report_decode(model, black_box(&[0x30, 0x41, 0x51])) {
        let _ = black_box(report_encode(report, model, black_box(buffer)));
    }
    if let Ok(command) = Command::decode(model, telegram) {
        let _ = black_box(command_encode(black_box(command), model, black_box(buffer)));
    }
    black_box(read_commands(model, telegram));
    let block = &mut black_box(LcdBlock::new(model));
    let _ = push(block, black_box(LcdCommand::Home));

    let driver = &mut black_box(Driver::new(model, Timeouts::DEFAULT));
    let _ = black_box(driver_submit(driver, black_box(Job::Lcd(*block))));
    black_box(driver_transmit(black_box(driver), now));
    driver_delivered(black_box(driver), now);
    driver_block(black_box(driver), now, telegram);
    driver_failed(black_box(driver), now);
    driver_timeout(black_box(driver), now);
    black_box(driver_event(black_box(driver)));

    let Ok(wheel) = WheelQuantiser::new(black_box(100), black_box(10)) else {
        return;
    };
    black_box(wheel_share(&wheel, black_box(57), black_box(10_000)));
    let sampler = &mut black_box(WheelSampler::new(now, 0));
    black_box(wheel_sample(sampler, black_box(now), black_box(5)));
}
