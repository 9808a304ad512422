//! The line: both sides, the wires between them, and the tap.

use core::time::Duration;

use monitor3964r::{Character, Side};
use proto3964r::{Activity, Event, SubmitError};

use crate::{
    Faults, Frame,
    end::{End, StationSettings},
    steps::{step_at, time},
    uart::{Read, Receiver},
};

/// An event of a station.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Happening {
    /// When, since the begin.
    pub at: Duration,
    /// At which station.
    pub side: Side,
    /// What, as [`Event`] displays it.
    pub text: String,
    /// Whether it is a telegram received or sent; all else tells of an error.
    pub is_good: bool,
}

/// Two stations on a line, with time that begins at zero.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// A, then B.
    ends: [End; 2],
    /// Hears what each of them sends.
    taps: [Receiver; 2],
    is_one_wire: bool,
    tells_damage: bool,
    step: u64,
    heard: Vec<Character>,
    happenings: Vec<Happening>,
}

/// The sides in the order of the arrays.
const SIDES: [Side; 2] = [Side::A, Side::B];

impl Simulation {
    /// A line without faults, with a tap for [`Frame::USUAL`]; random faults follow from the seed.
    #[must_use]
    pub fn new([a, b]: [StationSettings; 2], seed: u64) -> Self {
        Self {
            ends: [End::new(a, seed), End::new(b, !seed)],
            taps: [Frame::USUAL, Frame::USUAL].map(Receiver::new),
            is_one_wire: false,
            tells_damage: false,
            step: 0,
            heard: Vec::new(),
            happenings: Vec::new(),
        }
    }

    /// What is wrong at a side from now on. A station that is no longer dead starts up anew.
    pub fn set_faults(&mut self, side: Side, faults: Faults) {
        self.end_mut(side).set_faults(faults);
    }

    /// Whether both directions are on one pair of wires from now on, echo and all.
    pub const fn set_one_wire(&mut self, is_one_wire: bool) {
        self.is_one_wire = is_one_wire;
    }

    /// Whether the tap tells from now on which characters came in damaged, as a port with marks
    /// does.
    pub const fn set_tells_damage(&mut self, tells_damage: bool) {
        self.tells_damage = tells_damage;
    }

    /// Gives a station a telegram to send, after those that it has.
    ///
    /// # Errors
    /// [`SubmitError::TooLong`] for more than [`BLOCK`](crate::BLOCK) bytes; [`SubmitError::Empty`]
    /// where the station sends no empty ones.
    pub fn submit(&mut self, side: Side, telegram: &[u8]) -> Result<(), SubmitError> {
        self.plan(side, self.now(), telegram)
    }

    /// Gives a station a telegram to send from a time on, after those that it has.
    ///
    /// # Errors
    /// [`SubmitError::TooLong`] for more than [`BLOCK`](crate::BLOCK) bytes; [`SubmitError::Empty`]
    /// where the station sends no empty ones.
    pub fn plan(&mut self, side: Side, at: Duration, telegram: &[u8]) -> Result<(), SubmitError> {
        self.end_mut(side).plan(at, telegram)
    }

    /// The time by now.
    #[must_use]
    pub const fn now(&self) -> Duration {
        time(self.step)
    }

    /// Runs until a time; nothing if that has passed.
    pub fn run_until(&mut self, end: Duration) {
        let end = step_at(end);
        while self.step < end {
            self.advance(end);
        }
    }

    /// Runs until the next character, event or change of a station's activity, at most until a
    /// time.
    pub fn run_to_change(&mut self, end: Duration) {
        let end = step_at(end);
        let now = |it: &Self| {
            (
                it.heard.len(),
                it.happenings.len(),
                SIDES.map(|side| it.activity(side)),
            )
        };
        let before = now(self);
        while self.step < end && now(self) == before {
            self.advance(end);
        }
    }

    /// What the tap has heard so far. A character with a wrong parity or stop bit reads 00h, as a
    /// port of a PC reads it, unless the tap [tells damage](Self::set_tells_damage).
    #[must_use]
    pub fn heard(&self) -> &[Character] {
        &self.heard
    }

    /// The events of both stations so far.
    #[must_use]
    pub fn happenings(&self) -> &[Happening] {
        &self.happenings
    }

    /// What a station does.
    #[must_use]
    pub const fn activity(&self, side: Side) -> Activity {
        self.end(side).station.activity()
    }

    /// When a station's wait ends, if it waits.
    #[must_use]
    pub fn deadline(&self, side: Side) -> Option<Duration> {
        self.end(side).station.poll_timeout()
    }

    /// Telegrams that a station has not sent yet.
    #[must_use]
    pub fn waiting(&self, side: Side) -> usize {
        self.end(side).jobs()
    }

    const fn end(&self, side: Side) -> &End {
        let [a, b] = &self.ends;
        match side {
            Side::A => a,
            Side::B => b,
        }
    }

    const fn end_mut(&mut self, side: Side) -> &mut End {
        let [a, b] = &mut self.ends;
        match side {
            Side::A => a,
            Side::B => b,
        }
    }

    /// One step; or, where the line rests, all until the next thing is due.
    fn advance(&mut self, end: u64) {
        let now = self.now();
        if !self.rests() {
            self.wires(now);
        }
        for (side, it) in SIDES.into_iter().zip(&mut self.ends) {
            let happenings = &mut self.happenings;
            it.serve(now, |event| {
                happenings.push(Happening {
                    at: now,
                    side,
                    text: event.to_string(),
                    is_good: matches!(event, Event::Received(_) | Event::Sent { .. }),
                });
            });
        }
        let next = if self.rests() {
            let due = self.ends.iter().filter_map(End::next_due).min();
            due.map_or(end, step_at)
        } else {
            self.step
        };
        self.step = next.clamp(self.step + 1, end);
    }

    /// What is on the wires in this step, and who reads it.
    fn wires(&mut self, now: Duration) {
        let [a, b] = self.ends.each_mut().map(|it| it.transmitter.step());
        let both = a && b;
        let sent = if self.is_one_wire { [both; 2] } else { [a, b] };
        for ((side, tap), level) in SIDES.into_iter().zip(&mut self.taps).zip(sent) {
            if let Some(read) = tap.step(level) {
                self.heard
                    .push(character(now, side, read, self.tells_damage));
            }
        }
        for (it, other) in self.ends.iter_mut().zip([b, a]) {
            let hears_both = self.is_one_wire || it.faults.hears_itself;
            let level = if hears_both { both } else { other };
            if let Some(read) = it.receiver.step(level) {
                it.hear(now, read);
            }
        }
    }

    fn rests(&self) -> bool {
        self.ends.iter().all(End::rests) && self.taps.iter().all(Receiver::is_idle)
    }
}

fn character(at: Duration, side: Side, read: Read, tells_damage: bool) -> Character {
    let Read { byte, error } = read;
    let is_zero = error.is_some() && !tells_damage;
    Character {
        at,
        side,
        byte: if is_zero { 0 } else { byte },
        error: error.filter(|_| tells_damage),
    }
}
