//! A conversation on a line: what is new of it for the page, and the files that it leaves.

use core::time::Duration;
use std::cell::RefCell;

use anyhow::{Context, Result, bail};
use line3964r::capture::{self, Kind, Report, Step, Tap};
use line3964r::text;
use monitor3964r::{Character, Diagnosis, Side, Verdict};
use proto3964r::Config;
use serde::{Deserialize, Serialize};

use crate::answer::{self, Answer};
use crate::boundary::Request;
use crate::progress;

/// Characters that are kept, as many as a tap keeps.
const KEPT: usize = 1 << 21;

/// Whose conversation it is.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Of {
    Capture,
    Simulation,
    Station,
    Tap,
}

thread_local! {
    static ALL: RefCell<[Option<Conversation>; 4]> = const { RefCell::new([const { None }; 4]) };
}

/// Begins a conversation, with the times and the check that are expected.
pub(super) fn begin(of: Of, config: Config) {
    ALL.with_borrow_mut(|all| {
        if let Some(it) = all.get_mut(of as usize) {
            *it = Some(Conversation::new(config));
        }
    });
}

pub(super) fn with<T>(of: Of, act: impl FnOnce(&mut Conversation) -> T) -> Result<T> {
    ALL.with_borrow_mut(|all| {
        let it = all.get_mut(of as usize).and_then(Option::as_mut);
        it.map(act).context("nothing has been heard yet")
    })
}

pub(super) struct Conversation {
    config: Config,
    tap: Tap,
    record: Vec<Character>,
    new: New,
}

/// What the page has not been told.
#[derive(Default, Serialize)]
struct New {
    steps: Vec<ToldStep>,
    verdict: Option<ToldVerdict>,
    #[serde(skip)]
    characters: Vec<Character>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ToldStep {
    at: String,
    side: Option<&'static str>,
    kind: &'static str,
    is_sent: bool,
    text: String,
}

#[derive(Serialize)]
struct ToldVerdict {
    kind: &'static str,
    /// The sentence, and what looks the same.
    sentence: String,
    /// All that the command line prints.
    text: String,
}

/// What is new, after something else.
#[derive(Serialize)]
struct With<T> {
    #[serde(flatten)]
    value: T,
    #[serde(flatten)]
    new: New,
}

pub(super) const fn name(side: Side) -> &'static str {
    match side {
        Side::A => "A",
        Side::B => "B",
    }
}

impl Conversation {
    fn new(config: Config) -> Self {
        Self {
            config,
            tap: Tap::new(config),
            record: Vec::new(),
            new: New::default(),
        }
    }

    /// Takes the next character, at a time as a capture has it.
    pub(super) fn hear(&mut self, mut character: Character) {
        let at = u64::try_from(character.at.as_micros());
        character.at = at.map_or(Duration::MAX, Duration::from_micros);
        if self.record.len() >= KEPT {
            self.record.drain(..KEPT / 2);
        }
        self.record.push(character);
        self.new.characters.push(character);
        let steps = self.tap.hear(character);
        self.new.steps.extend(steps.into_iter().map(ToldStep::from));
    }

    /// Nothing more has come by now.
    pub(super) fn wait(&mut self, now: Duration) {
        let steps = self.tap.wait(now);
        self.new.steps.extend(steps.into_iter().map(ToldStep::from));
    }

    /// Adds the verdict on what was heard from this time on.
    pub(super) fn judge_since(&mut self, from: Duration) {
        self.new.verdict = Some(self.tap.verdict_since(from).into());
    }

    /// What is new, after something else.
    pub(super) fn answer(&mut self, value: impl Serialize) -> Result<Answer> {
        let new = core::mem::take(&mut self.new);
        let times: Vec<_> = new
            .characters
            .iter()
            .map(|it| it.at.as_secs_f64())
            .collect();
        let bits: Vec<_> = new.characters.iter().map(bits).collect();
        Ok(Answer::new(With { value, new })?
            .with_numbers("times", times.into_iter().map(f64::to_le_bytes))
            .with_numbers("characters", bits.into_iter().map(u32::to_le_bytes)))
    }

    /// What was heard, as a capture.
    fn capture(&self) -> String {
        let lines = self.record.iter().map(|it| capture::line(it) + "\n");
        lines.collect()
    }

    /// The same characters once more, as `line3964r monitor` hears them in the capture.
    fn replay(&self, mut take: impl FnMut(Step)) -> Diagnosis {
        let mut tap = Tap::new(self.config);
        let mut told = progress::teller(0);
        let all = self.record.len() as u64;
        for (done, &character) in (1..).zip(&self.record) {
            tap.hear(character).into_iter().for_each(&mut take);
            told(done, all);
        }
        tap.verdict()
    }

    /// What `line3964r monitor` prints for the capture.
    fn told(&self) -> String {
        let mut lines = String::new();
        let diagnosis = self.replay(|Step { at, text, .. }| {
            lines += &format!("{}s {text}\n", text::time(at));
        });
        format!("{lines}verdict: {diagnosis}\n")
    }
}

/// Byte, side and whether it is damaged, in one number.
fn bits(character: &Character) -> u32 {
    let is_b = u32::from(character.side == Side::B);
    let is_damaged = u32::from(character.error.is_some());
    u32::from(character.byte) | is_b << 8 | is_damaged << 9
}

impl From<Step> for ToldStep {
    fn from(step: Step) -> Self {
        Self {
            at: text::time(step.at),
            side: step.side.map(name),
            kind: match step.kind {
                Kind::Good => "good",
                Kind::Neutral => "neutral",
                Kind::Unusual => "unusual",
                Kind::Fault => "fault",
            },
            is_sent: step.is_sent,
            text: step.text,
        }
    }
}

impl From<Diagnosis> for ToldVerdict {
    fn from(diagnosis: Diagnosis) -> Self {
        let kind = match diagnosis.verdict {
            Verdict::Works => "good",
            Verdict::Silent | Verdict::Open => "neutral",
            _ => "fault",
        };
        let mut sentence = diagnosis.verdict.to_string();
        if let Some(or) = diagnosis.or {
            sentence = format!("{sentence}; or {or}");
        }
        Self {
            kind,
            sentence,
            text: diagnosis.to_string(),
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    of: Of,
    name: String,
}

/// A file of a conversation, by its name.
pub(super) fn file(request: &Request) -> Result<Answer> {
    let File { of, name } = request.parameters()?;
    with(of, |conversation| match &*name {
        "capture.txt" => answer::file(conversation.capture()),
        "conversation.txt" => answer::file(conversation.told()),
        "verdict.json" => answer::json_file(&Report::new(None, conversation.replay(drop))),
        _ => bail!("there is no file {name:?}"),
    })?
}
