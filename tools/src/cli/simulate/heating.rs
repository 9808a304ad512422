//! A heating controller: the line of a Buderus KM271.

use alloc::collections::VecDeque;
use core::time::Duration;

use anyhow::{Result, anyhow};

use super::{
    Partner,
    answers::{hex, lines},
};

/// What a client sends to be told all values.
const LOG_MODE: [u8; 3] = [0xEE, 0x00, 0x00];

/// How often they are told.
const PERIOD: Duration = Duration::from_secs(10);

/// Address and value, as the published clients read them: supply of heating circuit 1, wanted and
/// measured; boiler; outside.
const VALUES: &str = "80 02 2D\n80 03 2C\n84 2B 3A\n89 3C 07";

pub(super) struct Heating {
    values: Vec<Vec<u8>>,
    queue: VecDeque<Vec<u8>>,
    /// When all values are due again, once a client has asked for them.
    due: Option<Duration>,
}

impl Heating {
    /// From a hexadecimal telegram a line; `#` begins a comment.
    pub(super) fn new(text: Option<&str>) -> Result<Self> {
        let values = lines(text.unwrap_or(VALUES))
            .map(|(number, line)| hex(line).map_err(|error| anyhow!("line {number}: {error}")));
        Ok(Self {
            values: values.collect::<Result<_>>()?,
            queue: VecDeque::new(),
            due: None,
        })
    }
}

impl Partner for Heating {
    fn receive(&mut self, now: Duration, telegram: &[u8]) {
        if telegram == LOG_MODE {
            self.due = Some(now);
            self.handle_timeout(now);
        }
    }

    fn handle_timeout(&mut self, now: Duration) {
        if self.due.is_some_and(|due| due <= now) {
            self.due = Some(now + PERIOD);
            // Not twice, to a client that does not take them.
            self.queue.clear();
            self.queue.extend(self.values.iter().cloned());
        }
    }

    fn poll_timeout(&self) -> Option<Duration> {
        self.due
    }

    fn poll_transmit(&mut self, _now: Duration) -> Option<Vec<u8>> {
        self.queue.pop_front()
    }

    fn order(&mut self, line: &str) -> Result<(), String> {
        self.queue.push_back(hex(line)?);
        Ok(())
    }
}
