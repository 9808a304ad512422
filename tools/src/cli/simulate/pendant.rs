//! A EUCHNER hand-held pendant HBLS.

use alloc::collections::VecDeque;
use core::time::Duration;

use handwheel::{
    Command, Key, LcdAnswer, LcdCommand, MAX_REPORT, Model, Position, Report, RotarySwitch, Status,
};

use super::Partner;

const MODEL: Model = Model::Hbls;

pub(super) struct Pendant {
    /// Its status has been asked for: before, it is silent.
    is_awake: bool,
    key: Option<Key>,
    w1: Position,
    w2: Position,
    reports: VecDeque<Report>,
    notes: VecDeque<String>,
}

impl Pendant {
    pub(super) const fn new() -> Self {
        Self {
            is_awake: false,
            key: None,
            w1: Position::MIN,
            w2: Position::MIN,
            reports: VecDeque::new(),
            notes: VecDeque::new(),
        }
    }

    fn take(&mut self, command: Command<'_>) {
        match command {
            Command::StatusRequest => {
                self.is_awake = true;
                let Self { key, w1, w2, .. } = *self;
                let status = Status::Hbls { key, w1, w2 };
                self.reports.push_front(Report::Status(status));
            }
            Command::Led { led, state } => {
                let led = led.map_or("all".to_owned(), |led| led.get().to_string());
                self.notes.push_back(format!("led {led} {state:?}"));
            }
            Command::Lcd(commands) => {
                let mut answer = LcdAnswer::Done;
                for command in commands {
                    match command {
                        Ok(LcdCommand::Text(text)) => {
                            let text: String = text.chars().collect();
                            self.notes.push_back(format!("display {text}"));
                        }
                        Ok(_) => {}
                        Err(_) => answer = LcdAnswer::BadParameter,
                    }
                }
                self.reports.push_back(Report::Lcd(answer));
            }
            other => self.notes.push_back(format!("not simulated: {other:?}")),
        }
    }
}

impl Partner for Pendant {
    fn receive(&mut self, _now: Duration, telegram: &[u8]) {
        match Command::decode(MODEL, telegram) {
            Ok(command) => self.take(command),
            Err(error) => self.notes.push_back(format!("no command: {error}")),
        }
    }

    fn poll_transmit(&mut self, _now: Duration) -> Option<Vec<u8>> {
        let report = self.reports.pop_front()?;
        let mut telegram = [0; MAX_REPORT];
        let telegram = report.encode(MODEL, &mut telegram).ok()?;
        Some(telegram.to_vec())
    }

    fn poll_note(&mut self) -> Option<String> {
        self.notes.pop_front()
    }

    fn order(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_whitespace();
        let (name, number) = (words.next().unwrap_or_default(), words.next());
        let is_none_of = || format!("`{line}` is none of key, key NUMBER, w1 NUMBER, w2 NUMBER");
        if words.next().is_some() {
            return Err(is_none_of());
        }
        let number = match number {
            Some(word) => Some(word.parse::<u8>().map_err(|_| is_none_of())?),
            None => None,
        };
        let position = |number| Position::new(number).map_err(|error| error.to_string());
        let report = match (name, number) {
            ("key", None) => {
                self.key = None;
                Report::Key(None)
            }
            ("key", Some(number)) => {
                self.key = Some(Key::new(number).map_err(|error| error.to_string())?);
                Report::Key(self.key)
            }
            ("w1", Some(number)) => {
                self.w1 = position(number)?;
                Report::RotarySwitch {
                    switch: RotarySwitch::W1,
                    position: self.w1,
                }
            }
            ("w2", Some(number)) => {
                self.w2 = position(number)?;
                Report::RotarySwitch {
                    switch: RotarySwitch::W2,
                    position: self.w2,
                }
            }
            _ => return Err(is_none_of()),
        };
        if self.is_awake {
            self.reports.push_back(report);
        }
        Ok(())
    }
}
