//! A live station on a real port, with a tap on both its directions: A is the station.

extern crate alloc;

use alloc::collections::VecDeque;
use core::time::Duration;
use std::cell::RefCell;

use anyhow::{Context, Result};
use line3964r::Preset;
use monitor3964r::{Character, Side};
use proto3964r::{Event, Line, Station, Transmit};
use serde::{Deserialize, Serialize};

use super::conversation::{self, Conversation, Of};
use super::tap::{Damage, characters};
use super::{PriorityName, RECENT, Telegram, seconds};
use crate::answer::Answer;
use crate::boundary::Request;

/// Longest telegram: that of a CP 341.
const BLOCK: usize = 4096;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Begin {
    preset: Preset,
    priority: PriorityName,
    baud: u32,
    /// With start, parity and stop bit.
    bits: u8,
}

/// What has happened by now.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Push {
    now_s: f64,
    #[serde(default)]
    bytes: Vec<u8>,
    damage: Option<Damage>,
    #[serde(default)]
    is_break: bool,
    /// A telegram to send.
    send: Option<Telegram>,
    /// Whether the telegram under way is given up.
    #[serde(default)]
    cancel: bool,
    /// Whether the verdict is asked for.
    #[serde(default)]
    judge: bool,
}

/// What follows.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Pulled {
    transmit: Vec<u8>,
    events: Vec<ToldEvent>,
    activity: String,
    is_busy: bool,
    /// When to push again, if nothing happens before.
    deadline_s: Option<f64>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ToldEvent {
    text: String,
    is_good: bool,
    /// Of a telegram that came in.
    telegram: Option<Vec<u8>>,
}

struct Live {
    station: Station<BLOCK>,
    character: Duration,
    /// Characters that are on their way to the wire, by the time of their ends.
    leaving: VecDeque<Character>,
}

thread_local!(static LIVE: RefCell<Option<Live>> = const { RefCell::new(None) });

pub(super) fn begin(request: &Request) -> Result<Answer> {
    let begin: Begin = request.parameters()?;
    let line = Line::buffered(begin.baud, begin.bits);
    let config = begin.preset.config(begin.priority.into(), line);
    let bits = f64::from(begin.bits) / f64::from(begin.baud);
    conversation::begin(Of::Station, config);
    LIVE.set(Some(Live {
        station: Station::new(config),
        character: seconds(bits).context("baud")?,
        leaving: VecDeque::new(),
    }));
    Answer::new(())
}

/// Pushes what has happened, pulls what follows.
pub(super) fn push(request: &Request) -> Result<Answer> {
    let push: Push = request.parameters()?;
    let now = seconds(push.now_s)?;
    LIVE.with_borrow_mut(|live| {
        let live = live.as_mut().context("no station is on a port")?;
        conversation::with(Of::Station, |conversation| {
            let pulled = live.take(now, &push, conversation)?;
            if push.judge {
                conversation.judge_since(now.saturating_sub(RECENT));
            }
            conversation.answer(pulled)
        })?
    })
}

impl Live {
    fn take(&mut self, now: Duration, push: &Push, tap: &mut Conversation) -> Result<Pulled> {
        // First what may be refused: then nothing of the rest is lost.
        if let Some(telegram) = &push.send {
            self.station.submit(now, &telegram.bytes()?)?;
        }
        let mut events = Vec::new();
        self.station.handle_timeout(now);
        self.flush(now, tap);
        if push.is_break {
            self.station.handle_break(now);
        }
        for character in characters(now, Side::B, &push.bytes, push.damage) {
            match character.error {
                None => self.station.handle_byte(now, character.byte),
                Some(error) => self.station.handle_damaged(now, character.byte, error),
            }
            // A telegram frees the buffer for the next one at once.
            self.events(&mut events);
            tap.hear(character);
        }
        if push.cancel {
            self.station.cancel(now);
        }
        self.events(&mut events);
        let transmit = self.transmit(now);
        self.flush(now, tap);
        tap.wait(now);
        Ok(Pulled {
            transmit,
            events,
            activity: self.station.activity().to_string(),
            is_busy: self.station.is_busy(),
            deadline_s: self.station.poll_timeout().map(|it| it.as_secs_f64()),
        })
    }

    fn events(&mut self, events: &mut Vec<ToldEvent>) {
        while let Some(event) = self.station.poll_event() {
            events.push(ToldEvent {
                text: event.to_string(),
                is_good: matches!(event, Event::Received(_) | Event::Sent { .. }),
                telegram: match event {
                    Event::Received(telegram) => Some(telegram.to_vec()),
                    _ => None,
                },
            });
        }
    }

    fn transmit(&mut self, now: Duration) -> Vec<u8> {
        let mut transmit = Vec::new();
        let mut out = [0; 256];
        while let Some(next) = self.station.poll_transmit(now, &mut out) {
            // A buffered line has nothing to discard.
            if let Transmit::Bytes(bytes) = next {
                transmit.extend_from_slice(bytes);
            }
        }
        let mut at = self.leaving.back().map_or(now, |last| last.at.max(now));
        for &byte in &transmit {
            at += self.character;
            self.leaving.extend(characters(at, Side::A, &[byte], None));
        }
        transmit
    }

    /// Lets the tap hear what has left by now.
    fn flush(&mut self, now: Duration, tap: &mut Conversation) {
        while let Some(character) = self.leaving.pop_front_if(|it| it.at <= now) {
            tap.hear(character);
        }
    }
}
