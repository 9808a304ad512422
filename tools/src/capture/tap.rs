//! A monitor and all that it has heard.

use core::time::Duration;

use monitor3964r::{Character, Diagnosis, Monitor, diagnose};
use proto3964r::Config;

use super::Step;

/// Longest payload that is shown.
const BLOCK: usize = 4096;

/// What a tap keeps for its verdict, in characters: a quarter of an hour of both directions of a
/// 9600-baud line that never rests.
const KEPT: usize = 1 << 21;

/// Listens to both directions of a line: tells each step, and why the line does not work.
#[derive(Clone, Debug)]
pub struct Tap {
    config: Config,
    monitor: Monitor<BLOCK>,
    record: Vec<Character>,
}

impl Tap {
    /// A tap that expects these times and this check; the other settings do not matter.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self {
            config,
            monitor: Monitor::new(config),
            record: Vec::new(),
        }
    }

    /// Takes the next character in time; returns what it means.
    pub fn hear(&mut self, character: Character) -> Vec<Step> {
        if self.record.len() >= KEPT {
            self.record.drain(..KEPT / 2);
        }
        self.record.push(character);
        let Character {
            at,
            side,
            byte,
            error,
        } = character;
        let steps = match error {
            None => self.monitor.handle_byte(at, side, byte),
            Some(error) => self.monitor.handle_damaged(at, side, byte, error),
        };
        steps.map(|step| Step::new(at, &step)).collect()
    }

    /// Nothing has come up to now; returns what that means.
    pub fn wait(&mut self, now: Duration) -> Vec<Step> {
        let steps = self.monitor.handle_timeout(now);
        steps.map(|step| Step::new(now, &step)).collect()
    }

    /// The verdict on all that is kept: the last two million characters, at least the last one
    /// million.
    #[must_use]
    pub fn verdict(&self) -> Diagnosis {
        diagnose(&self.record, &self.config)
    }

    /// The verdict on what was heard from this time on.
    #[must_use]
    pub fn verdict_since(&self, from: Duration) -> Diagnosis {
        let begin = self.record.partition_point(|heard| heard.at < from);
        diagnose(self.record.get(begin..).unwrap_or_default(), &self.config)
    }
}
