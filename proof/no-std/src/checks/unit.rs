//! A hand-held unit.

use core::hint::black_box;
use core::time::Duration;

use handwheel::{Action, Arbiter, Driver, Input, Panel, Settings, Shown, UnitId, WheelQuantiser};

use super::holds;
/// Status request, reply, and a screen in display blocks.
pub fn unit_telegrams() -> Option<()> {
    use handwheel::{Command, Event, Job, Model, Timing};
    let (now, model) = (Duration::ZERO, Model::Hbls);
    let mut driver = Driver::new(model, Timing::DEFAULT);
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
    let (mut shown, mut letters) = (Shown::UNKNOWN, 0);
    while let Some(block) = shown.update(&handwheel::Screen::BLANK, model) {
        driver.submit(Job::Lcd(block)).ok()?;
        let telegram = driver.poll_transmit(now)?;
        let Ok(Command::Lcd(commands)) = Command::decode(model, black_box(telegram)) else {
            return None;
        };
        for command in commands {
            if let handwheel::LcdCommand::Text(text) = command.ok()? {
                letters += text.len();
            }
        }
        driver.handle_delivered(now);
        driver.handle_block(now, &[0x6C, 0x31]);
        holds(matches!(driver.poll_event(), Some(Event::Lcd { .. })))?;
    }
    holds(letters == 128)
}

/// A jog that both switches allow and one stops.
pub fn panel() -> Option<()> {
    use handwheel::{Key, Position, Status};
    let wheel = WheelQuantiser::new(black_box(100), 10).ok()?;
    let mut platform = Arbiter::<3>::new();
    let mut panel = Panel::new(UnitId(1), Settings::new(wheel)).ok()?;
    let (w1, w2) = (Position::new(3).ok()?, Position::new(1).ok()?);
    let key = Key::new(3).ok();
    let course = [
        Input::Status(Status::Hbls { key: None, w1, w2 }),
        Input::Enable {
            left: false,
            right: false,
        },
        Input::Enable {
            left: true,
            right: true,
        },
        Input::Key(key),
        Input::Wheel(black_box(-57)),
        Input::Enable {
            left: true,
            right: false,
        },
    ];
    let mut actions = [None; 6];
    for (action, input) in actions.iter_mut().zip(course) {
        *action = panel.handle(input, &mut platform);
    }
    let [
        ..,
        Some(Action::Jog { speed_um_s, .. }),
        Some(Action::Stop(_)),
    ] = actions
    else {
        return None;
    };
    holds(speed_um_s == -5500)
}
