//! A driver and a simulated unit on two 3964R stations, over a line that damages bytes: the display
//! comes to show what it must.

use core::time::Duration;

use handwheel::{
    Cell, Column, Command, Driver, Event, Job, LcdAnswer, LcdBlock, LcdCommand, Line as Row,
    MAX_COMMAND, Model, Position, Report, Status, Text, Timeouts,
};
use proptest::prelude::*;
use proto3964r::{Config, Line, Priority, Station, Transmit};

const MODEL: Model = Model::Hbls;
/// Bytes of the longest block on the line: two damaged bytes in one can cancel in the BCC.
const LONGEST: u16 = 140;
/// A byte on the line, about 9600 bit/s.
const STEP_US: u64 = 1000;

type End = Station<MAX_COMMAND>;

/// What a station hands out arrives within the same step.
fn config(priority: Priority) -> Config {
    Config {
        priority,
        ..Config::euchner_hbls(Line::Instant)
    }
}

/// The unit: dead until asked, one answer for each display block.
struct Unit {
    station: End,
    display: [[char; 16]; 8],
    awake: bool,
    replies: Vec<Report>,
    blocks: usize,
}

impl Unit {
    fn new() -> Self {
        Self {
            station: End::new(config(Priority::Low)),
            display: [['?'; 16]; 8],
            awake: false,
            replies: Vec::new(),
            blocks: 0,
        }
    }

    fn work(&mut self, now: Duration) {
        self.station.handle_timeout(now);
        while let Some(event) = self.station.poll_event() {
            let proto3964r::Event::Received(telegram) = event else {
                continue;
            };
            match Command::decode(MODEL, telegram).unwrap() {
                Command::StatusRequest => {
                    self.awake = true;
                    let (key, w1, w2) = (None, Position::MIN, Position::MIN);
                    // It resets the unit: what it still had to say is gone.
                    self.replies = vec![Report::Status(Status::Hbls { key, w1, w2 })];
                }
                Command::Lcd(commands) => {
                    assert!(self.awake, "a display block to a unit that is not awake");
                    let mut at = (0, 0);
                    for command in commands {
                        match command.unwrap() {
                            LcdCommand::Goto(place) => {
                                at = (place.line.get().into(), place.column.get().into());
                            }
                            LcdCommand::Text(text) => text.chars().for_each(|character| {
                                self.display[at.0][at.1] = character;
                                at.1 += 1;
                            }),
                            other => panic!("{other:?}"),
                        }
                    }
                    self.blocks += 1;
                    self.replies.push(Report::Lcd(LcdAnswer::Done));
                }
                other => panic!("{other:?}"),
            }
        }
        if self.station.is_idle() && !self.station.is_busy() && !self.replies.is_empty() {
            let mut telegram = [0; 3];
            let telegram = self.replies.remove(0).encode(MODEL, &mut telegram).unwrap();
            self.station.submit(now, telegram).unwrap();
        }
    }
}

/// A text on all lines, shifted by one column from line to line.
fn rows(text: &str) -> Vec<String> {
    (0..8)
        .map(|line| format!("{:line$}{text:<width$}", "", width = 16 - line))
        .collect()
}

/// The blocks that show all lines: six in the first, as many as it has room for, two in the second.
fn blocks(rows: &[String]) -> [LcdBlock; 2] {
    let mut blocks = [LcdBlock::new(MODEL); 2];
    for (number, row) in rows.iter().enumerate() {
        let block = &mut blocks[usize::from(number >= 6)];
        let line = Row::new(u8::try_from(number).unwrap()).unwrap();
        let column = Column::MIN;
        block.push(LcdCommand::Goto(Cell { line, column })).unwrap();
        block
            .push(LcdCommand::Text(Text::new(row).unwrap()))
            .unwrap();
    }
    blocks
}

/// Two texts to be shown, one after the other, and the damage: how many bytes are left alone
/// before one is lost or changed.
fn show(texts: [&str; 2], damage: &[(u16, u8)]) -> Result<(), TestCaseError> {
    let mut station = End::new(config(Priority::High));
    let mut driver = Driver::new(MODEL, Timeouts::DEFAULT);
    let mut unit = Unit::new();
    let mut damage = damage.iter();
    let mut next = damage.next();
    let mut passed = 0;
    let mut spoil = |byte: u8| -> Option<u8> {
        let Some(&(after, flip)) = next else {
            return Some(byte);
        };
        passed += 1;
        if passed <= after {
            return Some(byte);
        }
        (passed, next) = (0, damage.next());
        (flip != 0).then_some(byte ^ flip)
    };
    for text in texts {
        let rows = rows(text);
        let blocks = blocks(&rows);
        let mut waiting = blocks.iter();
        let wanted = |unit: &Unit| {
            let shown = unit.display.iter();
            let shown = shown.map(|line| line.iter().collect::<String>());
            shown.eq(rows.iter().cloned())
        };
        let mut micros = 0;
        while !(wanted(&unit) && !driver.is_busy() && driver.is_online()) {
            micros += STEP_US;
            // Each damaged byte costs at most all attempts, a reply's deadline and a retry.
            prop_assert!(micros < 400_000_000, "{text} is not shown, {driver:?}");
            step(&mut station, &mut driver, &mut unit, &mut spoil, micros);
            if !driver.is_busy()
                && driver.is_online()
                && let Some(block) = waiting.next()
            {
                driver.submit(Job::Lcd(*block))?;
            }
            let now = Duration::from_micros(micros);
            for event in events(&mut station, &mut driver, now) {
                let lost = matches!(event, Event::Failed(_));
                if lost
                    || matches!(
                        event,
                        Event::Status {
                            connected: true,
                            ..
                        }
                    )
                {
                    waiting = blocks.iter();
                }
            }
        }
        // A new driver's clock begins at zero, and so does a new line's.
        station = End::new(config(Priority::High));
        driver = Driver::new(MODEL, Timeouts::DEFAULT);
        unit.station = End::new(config(Priority::Low));
    }
    Ok(())
}

/// One byte each way.
fn step(
    station: &mut End,
    driver: &mut Driver,
    unit: &mut Unit,
    spoil: &mut impl FnMut(u8) -> Option<u8>,
    micros: u64,
) {
    let now = Duration::from_micros(micros);
    station.handle_timeout(now);
    unit.work(now);
    if station.is_idle()
        && !station.is_busy()
        && let Some(telegram) = driver.poll_transmit(now)
    {
        station.submit(now, telegram).unwrap();
    }
    let mut byte = [0];
    let forth = match station.poll_transmit(now, &mut byte) {
        Some(Transmit::Bytes(&[byte])) => spoil(byte),
        _ => None,
    };
    let mut byte = [0];
    let back = match unit.station.poll_transmit(now, &mut byte) {
        Some(Transmit::Bytes(&[byte])) => spoil(byte),
        _ => None,
    };
    if let Some(byte) = forth {
        unit.station.handle_byte(now, byte);
    }
    if let Some(byte) = back {
        station.handle_byte(now, byte);
    }
}

fn events(station: &mut End, driver: &mut Driver, now: Duration) -> Vec<Event> {
    let mut events = Vec::new();
    driver.handle_timeout(now);
    events.extend(driver.poll_event());
    while let Some(event) = station.poll_event() {
        match event {
            proto3964r::Event::Received(telegram) => driver.handle_block(now, telegram),
            proto3964r::Event::Sent { .. } => driver.handle_delivered(now),
            proto3964r::Event::Failed(_) => driver.handle_failed(now),
            _ => {}
        }
        events.extend(core::iter::from_fn(|| driver.poll_event()));
    }
    events
}

#[test]
fn a_clean_line_needs_no_repeat() {
    show(["SINGLE", "ADJUST"], &[]).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_bad_line_shows_the_screen_in_the_end(
        damage in prop::collection::vec((LONGEST..2 * LONGEST, prop_oneof![Just(0), Just(0x04), Just(0x20)]), 0..30),
    ) {
        show(["SINGLE", "ADJUST"], &damage)?;
    }
}
