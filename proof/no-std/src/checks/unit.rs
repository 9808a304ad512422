//! A hand-held pendant.

use core::hint::black_box;
use core::time::Duration;

use handwheel::{Driver, LcdBlock, WheelQuantiser};

use super::holds;

/// Status request, reply, and a text on the display.
pub fn unit_telegrams() -> Option<()> {
    use handwheel::{Command, Event, Job, LcdCommand, Model, Text, Timeouts};
    let (now, model) = (Duration::ZERO, Model::Hbls);
    let mut driver = Driver::new(model, Timeouts::DEFAULT);
    holds(driver.poll_transmit(now) == Some(&[0x23]))?;
    driver.handle_delivered(now);
    driver.handle_block(now, black_box(&[0x30, 0x43, 0x52]));
    let event = driver.poll_event()?;
    holds(matches!(
        event,
        Event::Status {
            connected: true,
            ..
        }
    ))?;
    let mut block = LcdBlock::new(model);
    let text = Text::new(black_box("SINGLE")).ok()?;
    block.push(LcdCommand::Text(text)).ok()?;
    driver.submit(Job::Lcd(block)).ok()?;
    let telegram = driver.poll_transmit(now)?;
    let Ok(Command::Lcd(mut commands)) = Command::decode(model, black_box(telegram)) else {
        return None;
    };
    holds(commands.next()?.ok()? == LcdCommand::Text(text))?;
    driver.handle_delivered(now);
    driver.handle_block(now, &[0x6C, 0x31]);
    holds(matches!(driver.poll_event(), Some(Event::Lcd { .. })))
}

/// 57 counts lie in the bin around 55.
pub fn wheel() -> Option<()> {
    let wheel = WheelQuantiser::new(black_box(100), 10).ok()?;
    holds(wheel.speed(black_box(-57), 10_000) == -5500)
}
