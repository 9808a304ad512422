//! Two stations on a simulated line, to learn the procedure.

use core::time::Duration;
use std::cell::RefCell;

use anyhow::{Context, Result, ensure};
use line_sim::{Faults, Frame, Happening, Parity, Simulation, StationSettings};
use line3964r::Preset;
use machine_sim::Random;
use monitor3964r::Side;
use proto3964r::{Line, Priority, SubmitError};
use serde::{Deserialize, Serialize};

use super::conversation::{self, Of, name};
use super::{PriorityName, Telegram, milliseconds, seconds};
use crate::answer::Answer;
use crate::boundary::Request;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Begin {
    a: Settings,
    b: Settings,
    seed: u64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    preset: Preset,
    priority: PriorityName,
    baud: u32,
    parity: ParityName,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum ParityName {
    None,
    Even,
    Odd,
}

impl Settings {
    fn station(&self) -> Result<StationSettings> {
        let parity = match self.parity {
            ParityName::None => Parity::None,
            ParityName::Even => Parity::Even,
            ParityName::Odd => Parity::Odd,
        };
        let frame = Frame::new(self.baud, parity);
        let frame = frame.with_context(|| format!("baud: {} is not simulated", self.baud))?;
        let line = Line::paced(self.baud, frame.bits());
        let config = self.preset.config(self.priority.into(), line);
        Ok(StationSettings { config, frame })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Set {
    a: FaultsOf,
    b: FaultsOf,
    is_one_wire: bool,
    /// Whether both stations send telegrams by themselves.
    has_traffic: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FaultsOf {
    is_dead: bool,
    is_deaf: bool,
    hears_itself: bool,
    keeps_telegrams: bool,
    delay_ms: f64,
    pause_ms: f64,
    bcc: BccName,
    /// Of 10000 bits, how many arrive inverted.
    bit_errors: f64,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BccName {
    Right,
    Undoubled,
    WithStx,
    WithoutEnd,
    Inverted,
}

impl BccName {
    /// What the check character is off by, where the payload has an odd and an even number of 10h.
    const fn change(self) -> [u8; 2] {
        match self {
            Self::Right => [0; 2],
            Self::Undoubled => [0x10, 0],
            Self::WithStx => [0x02; 2],
            Self::WithoutEnd => [0x10 ^ 0x03; 2],
            Self::Inverted => [0xFF; 2],
        }
    }
}

impl FaultsOf {
    fn faults(&self) -> Result<Faults> {
        let rate = self.bit_errors / 10_000.0;
        ensure!(
            (0.0..=1.0).contains(&rate),
            "bit errors: {} is not between 0 and 10000",
            self.bit_errors
        );
        Ok(Faults {
            is_dead: self.is_dead,
            is_deaf: self.is_deaf,
            hears_itself: self.hears_itself,
            keeps_telegrams: self.keeps_telegrams,
            delay: milliseconds(self.delay_ms, "delay")?,
            pause: milliseconds(self.pause_ms, "pause")?,
            bcc_change: self.bcc.change(),
            bit_error_rate: rate,
            ..Faults::NONE
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Send {
    is_from_b: bool,
    telegram: Telegram,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Run {
    to_s: f64,
    /// Only to the next character, event or change of activity.
    is_step: bool,
    /// Whether the verdict is asked for.
    judge: bool,
}

/// What is new.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Pulled {
    now_s: f64,
    stations: [ToldStation; 2],
    events: Vec<ToldEvent>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ToldStation {
    activity: String,
    deadline_s: Option<f64>,
    /// Telegrams to send.
    waiting: usize,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ToldEvent {
    at_s: f64,
    side: &'static str,
    text: String,
    is_good: bool,
}

impl From<&Happening> for ToldEvent {
    fn from(happening: &Happening) -> Self {
        Self {
            at_s: happening.at.as_secs_f64(),
            side: name(happening.side),
            text: happening.text.clone(),
            is_good: happening.is_good,
        }
    }
}

struct Running {
    line: Simulation,
    /// Since when the faults are as they are.
    set_at: Duration,
    traffic: Option<Traffic>,
    random: Random,
    /// What the page has been told of.
    characters: usize,
    events: usize,
}

/// Telegrams that the stations send by themselves.
struct Traffic {
    next_at: Duration,
    rounds: u32,
}

thread_local!(static RUNNING: RefCell<Option<Running>> = const { RefCell::new(None) });

fn with_running<T>(act: impl FnOnce(&mut Running) -> Result<T>) -> Result<T> {
    RUNNING.with_borrow_mut(|running| act(running.as_mut().context("no line is simulated")?))
}

pub(super) fn begin(request: &Request) -> Result<Answer> {
    let Begin { a, b, seed } = request.parameters()?;
    let stations = [a.station().context("A")?, b.station().context("B")?];
    // The tap expects what A is set to.
    let expected = a.preset.config(Priority::Low, Line::Instant);
    conversation::begin(Of::Simulation, expected);
    RUNNING.set(Some(Running {
        line: Simulation::new(stations, seed),
        set_at: Duration::ZERO,
        traffic: None,
        random: Random::new(seed),
        characters: 0,
        events: 0,
    }));
    Answer::new(())
}

/// What is wrong from now on.
pub(super) fn set(request: &Request) -> Result<Answer> {
    let set: Set = request.parameters()?;
    let faults = [set.a.faults().context("A")?, set.b.faults().context("B")?];
    with_running(|running| {
        for (side, faults) in [Side::A, Side::B].into_iter().zip(faults) {
            running.line.set_faults(side, faults);
        }
        running.line.set_one_wire(set.is_one_wire);
        running.set_at = running.line.now();
        running.traffic = match (set.has_traffic, running.traffic.take()) {
            (true, None) => Some(Traffic {
                next_at: running.line.now() + Duration::from_millis(200),
                rounds: 0,
            }),
            (true, running) => running,
            (false, _) => None,
        };
        Answer::new(())
    })
}

pub(super) fn send(request: &Request) -> Result<Answer> {
    let Send {
        is_from_b,
        telegram,
    } = request.parameters()?;
    let side = if is_from_b { Side::B } else { Side::A };
    with_running(|running| {
        running.line.submit(side, &telegram.bytes()?)?;
        Answer::new(())
    })
}

/// Runs on; tells what has come of it.
pub(super) fn run(request: &Request) -> Result<Answer> {
    let Run {
        to_s,
        is_step,
        judge,
    } = request.parameters()?;
    let to = seconds(to_s)?;
    with_running(|running| {
        running.advance(to, is_step)?;
        running.pull(judge)
    })
}

impl Running {
    fn advance(&mut self, to: Duration, is_step: bool) -> Result<(), SubmitError> {
        loop {
            let next_at = self.traffic.as_ref().map(|it| it.next_at);
            let end = next_at.map_or(to, |at| at.min(to));
            if is_step {
                self.line.run_to_change(end);
            } else {
                self.line.run_until(end);
            }
            let is_due = next_at.is_some_and(|at| at <= self.line.now());
            if is_due {
                self.next_round()?;
            } else if is_step || end >= to {
                return Ok(());
            }
        }
    }

    /// A telegram of each station, in every second round at the same time.
    fn next_round(&mut self) -> Result<(), SubmitError> {
        let Some(traffic) = &mut self.traffic else {
            return Ok(());
        };
        let now = self.line.now();
        let later = Duration::from_millis(if traffic.rounds % 2 == 0 { 500 } else { 0 });
        traffic.rounds += 1;
        traffic.next_at = now + Duration::from_millis(1000 + self.random.next_u64() % 500);
        for (side, at) in [(Side::A, now), (Side::B, now + later)] {
            // None piles up at a station that cannot get rid of them.
            if self.line.waiting(side) < 2 {
                let telegram = telegram(&mut self.random);
                self.line.plan(side, at, &telegram)?;
            }
        }
        Ok(())
    }

    fn pull(&mut self, judge: bool) -> Result<Answer> {
        let now = self.line.now();
        let happenings = self.line.happenings();
        let events = happenings.iter().skip(self.events);
        let pulled = Pulled {
            now_s: now.as_secs_f64(),
            stations: [Side::A, Side::B].map(|side| ToldStation {
                activity: self.line.activity(side).to_string(),
                deadline_s: self.line.deadline(side).map(|it| it.as_secs_f64()),
                waiting: self.line.waiting(side),
            }),
            events: events.map(ToldEvent::from).collect(),
        };
        self.events = happenings.len();
        conversation::with(Of::Simulation, |it| {
            let heard = self.line.heard().iter().skip(self.characters);
            heard.for_each(|&character| it.hear(character));
            self.characters = self.line.heard().len();
            it.wait(now);
            if judge {
                it.judge_since(self.set_at);
            }
            it.answer(pulled)
        })?
    }
}

/// A telegram of 1 to 12 bytes, as rich in control characters as the procedure can bear.
fn telegram(random: &mut Random) -> Vec<u8> {
    let len = 1 + random.next_u64() % 12;
    let bytes = (0..len).map(|_| match random.next_u64() % 8 {
        0 => 0x10,
        1 => 0x03,
        _ => 0x41 + (random.next_u64() % 26).to_be_bytes()[7],
    });
    bytes.collect()
}
