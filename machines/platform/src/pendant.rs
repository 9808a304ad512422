//! The simulated pendant: keys, rotary switches, LEDs and display on a 3964R station of its own.

use alloc::collections::VecDeque;
use core::time::Duration;

use handwheel::{
    Cell, Command, Key, LcdAnswer, LcdCommand, LcdCommands, LedState, MAX_REPORT, Model, Position,
    Report, RotarySwitch, Status,
};
use proto3964r::{Config, Event, Priority, Station};

use crate::line::PACED;
use crate::screen::{COLUMNS, LINES};

const MODEL: Model = Model::Hbls;
/// The pendant's longest block, and the longest it takes.
const BLOCK: usize = Model::Hbls.max_lcd_block();

pub(crate) struct Pendant {
    pub(crate) station: Station<BLOCK>,
    powered: bool,
    /// Its status has been asked for.
    awake: bool,
    key: Option<Key>,
    w1: Position,
    w2: Position,
    led: LedState,
    cells: [[char; COLUMNS]; LINES],
    cursor: (usize, usize),
    reports: VecDeque<Report>,
    /// Telegrams that it could not make sense of, or bring out.
    pub(crate) faults: usize,
}

impl Pendant {
    /// A pendant without power.
    pub(crate) fn new() -> Self {
        let line = Config {
            priority: Priority::Low,
            ..Config::euchner_hbls(PACED)
        };
        Self {
            station: Station::new(line),
            powered: false,
            awake: false,
            key: None,
            w1: Position::MIN,
            w2: Position::MIN,
            led: LedState::Off,
            cells: [[' '; COLUMNS]; LINES],
            cursor: (0, 0),
            reports: VecDeque::new(),
            faults: 0,
        }
    }

    pub(crate) const fn switch_on(&mut self) {
        self.powered = true;
    }

    /// Without power nothing is heard.
    pub(crate) fn hear(&mut self, now: Duration, byte: u8) {
        if self.powered {
            self.station.handle_byte(now, byte);
        }
    }

    pub(crate) fn press(&mut self, key: Option<Key>) {
        self.key = key;
        self.report(Report::Key(key));
    }

    pub(crate) fn turn(&mut self, switch: RotarySwitch, position: Position) {
        let place = match switch {
            RotarySwitch::W1 => &mut self.w1,
            RotarySwitch::W2 => &mut self.w2,
        };
        *place = position;
        self.report(Report::RotarySwitch { switch, position });
    }

    pub(crate) const fn position(&self, switch: RotarySwitch) -> Position {
        match switch {
            RotarySwitch::W1 => self.w1,
            RotarySwitch::W2 => self.w2,
        }
    }

    /// A line of the display.
    pub(crate) fn line(&self, line: usize) -> String {
        self.cells.get(line).into_iter().flatten().collect()
    }

    pub(crate) const fn led(&self) -> LedState {
        self.led
    }

    /// Whether there is nothing left to say.
    pub(crate) fn is_quiet(&self) -> bool {
        self.reports.is_empty() && self.station.is_idle()
    }

    /// Before the first status request key changes are lost.
    fn report(&mut self, report: Report) {
        if self.awake {
            self.reports.push_back(report);
        }
    }

    /// Takes what the station has received, and hands it the next report.
    pub(crate) fn work(&mut self, now: Duration) {
        self.station.handle_timeout(now);
        loop {
            let telegram = match self.station.poll_event() {
                None => break,
                Some(Event::Received(telegram)) => telegram.to_vec(),
                Some(Event::Sent { .. }) => continue,
                Some(event) => {
                    let failed = matches!(event, Event::Failed(_) | Event::Rejected(_));
                    self.faults += usize::from(failed);
                    continue;
                }
            };
            match Command::decode(MODEL, &telegram) {
                Ok(Command::StatusRequest) => {
                    self.awake = true;
                    let (key, w1, w2) = (self.key, self.w1, self.w2);
                    let status = Status::Hbls { key, w1, w2 };
                    self.reports.push_front(Report::Status(status));
                }
                Ok(Command::Led { state, .. }) => self.led = state,
                Ok(Command::Lcd(commands)) => {
                    let answer = self.show(commands);
                    self.reports.push_back(Report::Lcd(answer));
                }
                _ => self.faults += 1,
            }
        }
        if self.station.is_idle()
            && !self.station.is_busy()
            && let Some(report) = self.reports.pop_front()
        {
            let mut telegram = [0; MAX_REPORT];
            let sent = report
                .encode(MODEL, &mut telegram)
                .is_ok_and(|telegram| self.station.submit(now, telegram).is_ok());
            self.faults += usize::from(!sent);
        }
    }

    /// Cursor, characters and clearing; stored texts and areas are not simulated.
    fn show(&mut self, commands: LcdCommands<'_>) -> LcdAnswer {
        for command in commands {
            match command {
                Ok(LcdCommand::Goto(Cell { line, column })) => {
                    self.cursor = (line.get().into(), column.get().into());
                }
                Ok(LcdCommand::Text(text)) => {
                    for character in text.chars() {
                        self.put(character);
                    }
                }
                Ok(LcdCommand::Home) => self.cursor = (0, 0),
                Ok(LcdCommand::DeleteAll) => self.cells = [[' '; COLUMNS]; LINES],
                Ok(LcdCommand::ShowText(_)) => return LcdAnswer::NoSuchText,
                Ok(
                    LcdCommand::ClearArea(_)
                    | LcdCommand::InverseArea(_)
                    | LcdCommand::FlashArea(_)
                    | LcdCommand::InverseFlashArea(_)
                    | LcdCommand::NormalArea(_),
                ) => return LcdAnswer::NoSuchArea,
                _ => return LcdAnswer::BadParameter,
            }
        }
        LcdAnswer::Done
    }

    fn put(&mut self, character: char) {
        let (line, column) = self.cursor;
        let cell = self.cells.get_mut(line).and_then(|it| it.get_mut(column));
        if let Some(cell) = cell {
            *cell = character;
        }
        self.cursor.1 += 1;
    }
}
