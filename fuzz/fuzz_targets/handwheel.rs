//! Any telegrams, failures, delays and wheel counts at a hand-held pendant's driver: what decodes
//! encodes, every job ends once, the wheel is within its range.
#![no_main]

use std::time::Duration;

use handwheel::{
    Command, Driver, Event, Job, LcdBlock, LcdCommand, MAX_COMMAND, MAX_REPORT, Model, Report,
    Text, Timeouts, WheelQuantiser,
};
use libfuzzer_sys::fuzz_target;

/// What is read is written as the same bytes.
fn round_trip(model: Model, telegram: &[u8]) {
    let (mut report_bytes, mut command_bytes) = ([0; MAX_REPORT], [0; MAX_COMMAND]);
    if let Ok(report) = Report::decode(model, telegram) {
        assert_eq!(report.encode(model, &mut report_bytes), Ok(telegram));
    }
    let Ok(command) = Command::decode(model, telegram) else {
        return;
    };
    let encoded = command.clone().encode(model, &mut command_bytes);
    assert_eq!(encoded, Ok(telegram));
    if let Command::Lcd(commands) = command {
        let mut block = LcdBlock::new(model);
        if commands
            .into_iter()
            .all(|it| it.is_ok_and(|it| block.push(it).is_ok()))
        {
            assert_eq!(block.as_bytes(), telegram);
        }
    }
}

// Records of two bytes (what happens, length or value) and a telegram of that length.
fuzz_target!(|data: &[u8]| {
    let Some((&head, mut input)) = data.split_first() else {
        return;
    };
    let model = [Model::Hbls, Model::Hbas][usize::from(head & 1)];
    let max = u32::from(head) + 1;
    let wheel = WheelQuantiser::new(max, 1 + u16::from(head) / 2).unwrap();
    let mut driver = Driver::new(model, Timeouts::DEFAULT);
    let (mut now, mut jobs) = (Duration::ZERO, 0);
    while let Some((&[happening, value], rest)) = input.split_first_chunk() {
        input = rest;
        driver.handle_timeout(now);
        let mut events: Vec<_> = driver.poll_event().into_iter().collect();
        match happening % 8 {
            0 => {
                let telegram = driver.poll_transmit(now);
                telegram.into_iter().for_each(|it| round_trip(model, it));
            }
            1 => driver.handle_delivered(now),
            2 => driver.handle_failed(now),
            3 => now += Duration::from_millis(20 * u64::from(value)),
            4 => {
                let counts = i32::from(value.cast_signed()) * 5;
                let counts = wheel.counts(counts);
                assert!(counts.unsigned_abs() <= u64::from(max));
            }
            5 => {
                let letters = [b' ' + value % 95; 40];
                let text = Text::from_ascii(&letters[..usize::from(value % 41)]).unwrap();
                let mut block = LcdBlock::new(model);
                block.push(LcdCommand::Text(text)).unwrap();
                if !driver.is_busy() {
                    jobs += u32::from(driver.submit(Job::Lcd(block)).is_ok());
                }
            }
            _ => {
                let (telegram, after) = input.split_at(input.len().min(usize::from(value) % 8));
                input = after;
                round_trip(model, telegram);
                driver.handle_block(now, telegram);
            }
        }
        events.extend(std::iter::from_fn(|| driver.poll_event()));
        for event in &events {
            jobs -= u32::from(matches!(event, Event::Lcd { .. } | Event::Failed(..)));
        }
        assert_eq!(driver.is_busy(), jobs == 1);
    }
});
