//! Any telegrams, failures, delays, switches and wheel counts in front of a hand-held unit's
//! driver and panel: what decodes encodes, every job ends once, nothing moves without enabling.
#![no_main]

use std::time::Duration;

use handwheel::{
    Action, Arbiter, Command, Driver, Event, Input, Job, LcdBlock, MAX_COMMAND, MAX_REPORT, Model,
    Panel, Refusal, Report, Settings, Shown, Timing, UnitId, WheelQuantiser,
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
    let wheel = WheelQuantiser::new(u32::from(head) + 1, 1 + u16::from(head) / 2).unwrap();
    let mut panel = Panel::new(UnitId(1), Settings::new(wheel)).unwrap();
    let mut arbiter = Arbiter::<3>::new();
    let mut driver = Driver::new(model, Timing::DEFAULT);
    let (mut now, mut shown) = (Duration::ZERO, Shown::UNKNOWN);
    let (mut jobs, mut moving) = (0, false);
    while let Some((&[happening, value], rest)) = input.split_first_chunk() {
        input = rest;
        driver.handle_timeout(now);
        let mut events: Vec<_> = driver.poll_event().into_iter().collect();
        let mut direct = None;
        match happening % 10 {
            0 => {
                let telegram = driver.poll_transmit(now);
                telegram.into_iter().for_each(|it| round_trip(model, it));
            }
            1 => driver.handle_delivered(now),
            2 => driver.handle_failed(now),
            3 => now += Duration::from_millis(20 * u64::from(value)),
            4 => {
                direct = Some(Input::Enable {
                    left: value & 1 != 0,
                    right: value & 2 != 0,
                })
            }
            5 => direct = Some(Input::Wheel(i32::from(value.cast_signed()) * 5)),
            6 => {
                direct =
                    Some([Input::AtRest, Input::StopButton, Input::Lost][usize::from(value % 3)])
            }
            7 if value == 0 => direct = Some(Input::Refused(Refusal::OutOfReach)),
            7 => {
                let screen = panel.screen(&arbiter, &[[i32::from(value) << 20; 3]; 3]);
                if !driver.is_busy()
                    && let Some(block) = shown.update(&screen, model)
                {
                    jobs += u32::from(driver.submit(Job::Lcd(block)).is_ok());
                }
            }
            _ => {
                let (telegram, behind) = input.split_at(input.len().min(usize::from(value) % 8));
                input = behind;
                round_trip(model, telegram);
                driver.handle_block(now, telegram);
            }
        }
        events.extend(std::iter::from_fn(|| driver.poll_event()));
        for event in &events {
            jobs -= u32::from(matches!(event, Event::Lcd { .. } | Event::Failed(..)));
        }
        assert_eq!(driver.is_busy(), jobs == 1);
        let inputs = events.iter().filter_map(Input::of_event);
        for input in inputs.chain(direct) {
            let action = panel.handle(input, &mut arbiter);
            moving &= !matches!(input, Input::AtRest | Input::Refused(_));
            match action {
                Some(Action::Stop(_)) => assert!(std::mem::take(&mut moving)),
                Some(_) => {
                    assert!(panel.is_enabled());
                    moving = true;
                }
                None => {}
            }
            assert!(panel.is_enabled() || !moving);
        }
    }
});
