//! Two stations, what lies between each and the wire, and their users.

extern crate alloc;

use alloc::collections::VecDeque;
use core::{mem, time::Duration};

use proto3964r::{Config, Event, Station, Transmit};

use crate::common::random::Random;

/// Longest block.
pub(crate) const BLOCK: usize = 256;
/// No duel needs half of it.
const LIMIT: Duration = Duration::from_hours(2);

/// What lies between a station and the wire.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wire {
    /// Time of a character.
    pub(crate) character: Duration,
    /// From the program to the wire.
    pub(crate) way: Duration,
    /// What has come in is handed on at multiples of this; zero for at once.
    pub(crate) piece: Duration,
    /// What has not left can be called back.
    pub(crate) discards: bool,
}

/// A USB adapter at 9600 bit/s, 11 bits: what it has taken goes out, and what comes in is handed on
/// in pieces.
pub(crate) const ADAPTER: Wire = Wire {
    character: Duration::from_nanos(1_145_833),
    way: Duration::from_millis(1),
    piece: Duration::from_millis(4),
    discards: false,
};

/// How a station is used.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Habits {
    /// Longest pause before a job, in ms.
    pub(crate) pause_ms: u32,
    /// After so many in 1000 looks for events there is none for up to 300 ms.
    pub(crate) absent: u32,
    /// So many in 1000 jobs are given up within 200 ms.
    pub(crate) cancelled: u32,
}

/// One station, its way to the wire and its user.
pub(crate) struct End {
    station: Station<BLOCK>,
    wire: Wire,
    habits: Habits,
    random: Random,
    /// The user looks for events from then on.
    back_at: Duration,
    /// The next job is not submitted before.
    job_at: Duration,
    cancel_at: Option<Duration>,
    jobs: VecDeque<Vec<u8>>,
    /// The job that the station has, and how many telegrams the partner had received before it.
    open: Option<(Vec<u8>, usize)>,
    /// Characters in the adapter, and when each has left.
    leaving: VecDeque<(Duration, u8)>,
    last_left: Duration,
    /// The last one that left was not the last.
    several: bool,
    /// Characters that have come in, and when the adapter hands them on.
    arrived: VecDeque<(Duration, u8)>,
    pub(crate) received: Vec<Vec<u8>>,
    /// Jobs that were reported as sent.
    pub(crate) sent: Vec<Vec<u8>>,
    pub(crate) tally: Tally,
}

/// What became of the jobs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) sent: usize,
    /// Among them those that were cancelled.
    pub(crate) failed: usize,
    pub(crate) cancelled: usize,
    /// Telegrams that came in.
    pub(crate) received: usize,
    /// Reported sent, and the partner's user had not got them.
    pub(crate) falsely: usize,
}

impl End {
    fn new(config: Config, jobs: Vec<Vec<u8>>, wire: Wire, habits: Habits, seed: u64) -> Self {
        Self {
            station: Station::new(config),
            wire,
            habits,
            random: Random::new(seed),
            back_at: Duration::ZERO,
            job_at: Duration::ZERO,
            cancel_at: None,
            jobs: jobs.into(),
            open: None,
            leaving: VecDeque::new(),
            last_left: Duration::ZERO,
            several: false,
            arrived: VecDeque::new(),
            received: Vec::new(),
            sent: Vec::new(),
            tally: Tally::default(),
        }
    }

    /// What is due now; the outcomes are judged by what the partner has received so far.
    fn work(&mut self, now: Duration, partner: &[Vec<u8>]) {
        self.station.handle_timeout(now);
        if self.cancel_at.is_some_and(|at| at <= now) {
            self.cancel_at = None;
            self.tally.cancelled += usize::from(self.station.cancel(now));
        }
        let due = self.arrived.iter().take_while(|(at, _)| *at <= now).count();
        let piece: Vec<u8> = self.arrived.drain(..due).map(|(_, byte)| byte).collect();
        let mut rest = &piece[..];
        loop {
            rest = &rest[self.station.handle_bytes(now, rest)..];
            self.take_events(now, partner);
            self.submit(now, partner);
            self.hand_over(now);
            if rest.is_empty() {
                break;
            }
        }
    }

    fn take_events(&mut self, now: Duration, partner: &[Vec<u8>]) {
        if now < self.back_at {
            return;
        }
        if self.random.below(1000) < self.habits.absent {
            self.back_at = now + Duration::from_millis((1 + self.random.below(300)).into());
            return;
        }
        while let Some(event) = self.station.poll_event() {
            match event {
                Event::Received(telegram) => {
                    let telegram = telegram.to_vec();
                    let is_held = self.station.config().acknowledge_wait_ms > 0;
                    if !is_held || self.station.accept(now) {
                        self.received.push(telegram);
                    }
                }
                Event::Sent { .. } => {
                    let (job, before) = self.open.take().unwrap();
                    self.tally.sent += 1;
                    self.tally.falsely += usize::from(!partner[before..].contains(&job));
                    self.sent.push(job);
                    self.job_ended(now);
                }
                Event::Failed(_) => {
                    self.open = None;
                    self.job_ended(now);
                    self.tally.failed += 1;
                }
                _ => {}
            }
        }
    }

    fn job_ended(&mut self, now: Duration) {
        self.cancel_at = None;
        let pause = self.random.below(self.habits.pause_ms + 1);
        self.job_at = now + Duration::from_millis(pause.into());
    }

    fn submit(&mut self, now: Duration, partner: &[Vec<u8>]) {
        if now >= self.job_at
            && !self.station.is_busy()
            && let Some(job) = self.jobs.pop_front()
        {
            self.station.submit(now, &job).unwrap();
            self.open = Some((job, partner.len()));
            if self.random.below(1000) < self.habits.cancelled {
                let after = Duration::from_millis(self.random.below(200).into());
                self.cancel_at = Some(now + after);
            }
        }
    }

    /// Writes everything, and calls back what has not begun to leave.
    fn hand_over(&mut self, now: Duration) {
        let mut out = [0; 64];
        while let Some(transmit) = self.station.poll_transmit(now, &mut out) {
            let Wire { character, way, .. } = self.wire;
            let bytes = match transmit {
                Transmit::Bytes(bytes) => bytes,
                Transmit::Discard => {
                    if self.wire.discards {
                        self.leaving.retain(|&(at, _)| at <= now + character);
                    }
                    continue;
                }
            };
            for &byte in bytes {
                let free = self.leaving.back().map_or(now, |&(at, _)| at);
                let begin = free.max(now + way);
                self.leaving.push_back((begin + character, byte));
            }
        }
    }

    fn next_due(&self, now: Duration) -> Option<Duration> {
        let arrival = self.arrived.front().map(|&(at, _)| at);
        let leaving = self.leaving.front().map(|&(at, _)| at);
        let next_job = (!self.jobs.is_empty()).then_some(self.job_at);
        let user = [Some(self.back_at), next_job, self.cancel_at];
        let user = user.into_iter().flatten().filter(|&at| at > now);
        [arrival, leaving, self.station.poll_timeout()]
            .into_iter()
            .flatten()
            .chain(user)
            .min()
    }

    fn is_finished(&self, now: Duration) -> bool {
        self.jobs.is_empty() && self.open.is_none() && self.next_due(now).is_none()
    }
}

/// Two ends, and what the line does to characters.
pub(crate) struct Duel {
    pub(crate) ends: [End; 2],
    now: Duration,
    random: Random,
    noise: Noise,
    /// Characters of blocks until the next damage.
    ahead: u32,
}

/// So many in 1000 characters of blocks are damaged, when only what is seen is.
const BLOCKS: u32 = 30;

/// What the line does to characters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Of the characters of blocks one in so many to twice as many is damaged. More than a block
    /// has, so that no two errors cancel in a BCC; 0 for none.
    pub(crate) spacing: u32,
    /// So many in 1000 lone characters (STX, DLE, NAK) are damaged.
    pub(crate) answers: u32,
    /// So many in 1000 lone characters come late, with all that follow, by up to `late_ms`.
    pub(crate) late: u32,
    pub(crate) late_ms: u32,
    /// Only what a receiver can see: no DLE, ETX or doubled character comes of it, the BCC changes,
    /// by other than a STX, and between two damages lie `spacing` characters, alone or in blocks.
    pub(crate) seen: bool,
}

impl Duel {
    pub(crate) fn new(
        configs: [Config; 2],
        jobs: [Vec<Vec<u8>>; 2],
        wire: Wire,
        habits: Habits,
        noise: Noise,
        seed: u64,
    ) -> Self {
        let [a, b] = configs;
        let [a_jobs, b_jobs] = jobs;
        Self {
            ends: [
                End::new(a, a_jobs, wire, habits, !seed),
                End::new(b, b_jobs, wire, habits, !seed ^ 1 << 40),
            ],
            now: Duration::ZERO,
            random: Random::new(seed),
            noise,
            ahead: noise.spacing,
        }
    }

    /// Until every job has ended and the line is at rest.
    pub(crate) fn run(&mut self) {
        loop {
            for side in 0..2 {
                let partner = mem::take(&mut self.ends[1 - side].received);
                self.ends[side].work(self.now, &partner);
                self.ends[1 - side].received = partner;
            }
            if self.ends.iter().all(|end| end.is_finished(self.now)) {
                return;
            }
            let due = self
                .ends
                .iter()
                .filter_map(|end| end.next_due(self.now))
                .min();
            self.now = self.now.max(due.expect("nothing is to come"));
            assert!(self.now < LIMIT, "the stations do not come to rest");
            for side in 0..2 {
                self.carry(side);
            }
        }
    }

    /// Brings what has left one adapter to the other.
    fn carry(&mut self, side: usize) {
        while let Some(&(at, byte)) = self.ends[side].leaving.front()
            && at <= self.now
        {
            self.ends[side].leaving.pop_front();
            let Wire {
                character, piece, ..
            } = self.ends[side].wire;
            let end = &mut self.ends[side];
            let last_of_several = mem::replace(&mut end.several, !end.leaving.is_empty());
            let alone = character.is_zero() || at > end.last_left + 2 * character;
            let lone = alone && !last_of_several && end.leaving.is_empty();
            self.ends[side].last_left = at;
            let mut handed_on = at;
            if !piece.is_zero() {
                let steps = at.as_nanos().div_ceil(piece.as_nanos());
                handed_on = piece * u32::try_from(steps).unwrap();
            }
            if lone && self.random.below(1000) < self.noise.late {
                handed_on += Duration::from_millis(self.random.below(self.noise.late_ms).into());
            }
            let arrived = &self.ends[1 - side].arrived;
            handed_on = handed_on.max(arrived.back().map_or(Duration::ZERO, |&(at, _)| at));
            for byte in self.pass(byte, lone) {
                self.ends[1 - side].arrived.push_back((handed_on, byte));
            }
        }
    }

    fn damages(&mut self, lone: bool) -> bool {
        let Noise {
            spacing,
            answers,
            seen,
            ..
        } = self.noise;
        if lone && !seen {
            return self.random.below(1000) < answers;
        }
        if self.ahead > 0 || spacing == 0 {
            self.ahead = self.ahead.saturating_sub(1);
            return false;
        }
        // What is seen is waited for, alone or in a block.
        if seen && self.random.below(1000) >= if lone { answers } else { BLOCKS } {
            return false;
        }
        self.ahead = spacing + self.random.below(spacing);
        true
    }

    /// What arrives for a character: itself, or with one wrong bit, or nothing, or one more.
    fn pass(&mut self, byte: u8, lone: bool) -> Vec<u8> {
        if !self.damages(lone) {
            return vec![byte];
        }
        let arrived = match self.random.below(4) {
            0 => vec![],
            1 => vec![byte, self.random.byte()],
            _ => vec![byte ^ 1 << self.random.below(8)],
        };
        // What it does to the BCC: nothing, or what a repeated STX among the data makes up for.
        let change = arrived.iter().fold(byte, |xor, byte| xor ^ byte);
        let hidden = [0x00, 0x02].contains(&change)
            || arrived.last() == Some(&byte)
            || matches!(arrived.last(), Some(0x03 | 0x10));
        if self.noise.seen && hidden {
            vec![byte]
        } else {
            arrived
        }
    }
}
