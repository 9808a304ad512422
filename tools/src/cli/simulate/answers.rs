//! Any partner: it sends what it is told, and answers what it knows.

use alloc::collections::VecDeque;
use core::time::Duration;

use anyhow::{Result, anyhow};

use super::Partner;
use crate::text;

pub(super) struct Answers {
    known: Vec<(Vec<u8>, Vec<u8>)>,
    queue: VecDeque<Vec<u8>>,
}

impl Answers {
    /// From lines `HEX = HEX`; `#` begins a comment.
    pub(super) fn new(text: &str) -> Result<Self> {
        let mut known = Vec::new();
        for (number, line) in lines(text) {
            let fails = |error: String| anyhow!("line {number}: {error}");
            let (question, answer) = line
                .split_once('=')
                .ok_or_else(|| fails(format!("`{line}` is not HEX = HEX")))?;
            known.push((hex(question).map_err(fails)?, hex(answer).map_err(fails)?));
        }
        Ok(Self {
            known,
            queue: VecDeque::new(),
        })
    }
}

impl Partner for Answers {
    fn receive(&mut self, _now: Duration, telegram: &[u8]) {
        let known = self.known.iter().find(|(question, _)| question == telegram);
        self.queue.extend(known.map(|(_, answer)| answer.clone()));
    }

    fn poll_transmit(&mut self, _now: Duration) -> Option<Vec<u8>> {
        self.queue.pop_front()
    }

    fn order(&mut self, line: &str) -> Result<(), String> {
        self.queue.push_back(hex(line)?);
        Ok(())
    }
}

/// Lines with their numbers, without comments and empty ones.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = (1..).zip(text.lines());
    let lines = lines.map(|(number, line)| (number, line.split('#').next().unwrap_or(line).trim()));
    lines.filter(|(_, line)| !line.is_empty())
}

/// A telegram, `-` for an empty one.
pub(super) fn hex(text: &str) -> Result<Vec<u8>, String> {
    match text.trim() {
        "-" => Ok(Vec::new()),
        "" => Err("no bytes".to_owned()),
        hex => text::bytes(hex.split_whitespace()),
    }
}
