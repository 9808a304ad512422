//! Two stations behind adapters: what an adapter has taken goes out, and what comes in is handed on
//! in pieces.

extern crate alloc;

use alloc::collections::VecDeque;
use core::{mem, time::Duration};

use proto3964r::{Config, Event, Station, Transmit};

/// Longest block.
pub(crate) const BLOCK: usize = 256;
/// 11 bits at 9600 bit/s.
const CHARACTER: Duration = Duration::from_nanos(1_145_833);
/// An adapter hands on what has come in as often as that.
const PIECE: Duration = Duration::from_millis(4);
/// From the program to the wire.
const WAY: Duration = Duration::from_millis(1);
/// No duel needs half of it.
const LIMIT: Duration = Duration::from_hours(2);

/// A small generator of numbers, the same on every machine (xorshift64*).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = u32::try_from(self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32).unwrap();
        u32::try_from((u64::from(high) * u64::from(end)) >> 32).unwrap()
    }

    pub(crate) fn byte(&mut self) -> u8 {
        u8::try_from(self.below(256)).unwrap()
    }
}

/// One station, its adapter and its user.
pub(crate) struct End {
    station: Station<BLOCK>,
    jobs: VecDeque<Vec<u8>>,
    /// The job that the station has, and how many telegrams the partner had received before it.
    open: Option<(Vec<u8>, usize)>,
    /// Characters in the adapter, and when each has left.
    leaving: VecDeque<(Duration, u8)>,
    last_left: Duration,
    /// Characters that have come in, and when the adapter hands them on.
    arrived: VecDeque<(Duration, u8)>,
    pub(crate) received: Vec<Vec<u8>>,
    pub(crate) tally: Tally,
}

/// What became of the jobs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) sent: usize,
    pub(crate) failed: usize,
    /// Reported sent, and the partner's user had not got them.
    pub(crate) falsely: usize,
}

impl End {
    fn new(config: Config, jobs: Vec<Vec<u8>>) -> Self {
        Self {
            station: Station::new(config),
            jobs: jobs.into(),
            open: None,
            leaving: VecDeque::new(),
            last_left: Duration::ZERO,
            arrived: VecDeque::new(),
            received: Vec::new(),
            tally: Tally::default(),
        }
    }

    /// What is due now; the outcomes are judged by what the partner has received so far.
    fn work(&mut self, now: Duration, partner: &[Vec<u8>]) {
        self.station.handle_timeout(now);
        let due = self.arrived.iter().take_while(|(at, _)| *at <= now).count();
        let piece: Vec<u8> = self.arrived.drain(..due).map(|(_, byte)| byte).collect();
        let mut rest = &piece[..];
        loop {
            rest = &rest[self.station.handle_bytes(now, rest)..];
            self.take_events(partner);
            self.submit(now, partner);
            self.hand_over(now);
            if rest.is_empty() {
                break;
            }
        }
    }

    fn take_events(&mut self, partner: &[Vec<u8>]) {
        while let Some(event) = self.station.poll_event() {
            match event {
                Event::Received(telegram) => self.received.push(telegram.to_vec()),
                Event::Sent { .. } => {
                    let (job, before) = self.open.take().unwrap();
                    self.tally.sent += 1;
                    self.tally.falsely += usize::from(!partner[before..].contains(&job));
                }
                Event::Failed(_) => {
                    self.open = None;
                    self.tally.failed += 1;
                }
                _ => {}
            }
        }
    }

    fn submit(&mut self, now: Duration, partner: &[Vec<u8>]) {
        if !self.station.is_busy()
            && let Some(job) = self.jobs.pop_front()
        {
            self.station.submit(now, &job).unwrap();
            self.open = Some((job, partner.len()));
        }
    }

    /// Writes everything into the adapter, which cannot give it back.
    fn hand_over(&mut self, now: Duration) {
        let mut out = [0; 64];
        while let Some(transmit) = self.station.poll_transmit(now, &mut out) {
            let Transmit::Bytes(bytes) = transmit else {
                continue;
            };
            for &byte in bytes {
                let free = self.leaving.back().map_or(now, |&(at, _)| at);
                let begin = free.max(now + WAY);
                self.leaving.push_back((begin + CHARACTER, byte));
            }
        }
    }

    fn next_due(&self) -> Option<Duration> {
        let arrival = self.arrived.front().map(|&(at, _)| at);
        let leaving = self.leaving.front().map(|&(at, _)| at);
        [arrival, leaving, self.station.poll_timeout()]
            .into_iter()
            .flatten()
            .min()
    }

    fn is_finished(&self) -> bool {
        self.jobs.is_empty() && self.open.is_none() && self.next_due().is_none()
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

/// What the line does to characters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Of the characters of blocks one in so many to twice as many is damaged. More than a block
    /// has, so that no two errors cancel in a BCC; 0 for none.
    pub(crate) spacing: u32,
    /// So many in 1000 lone characters (STX, DLE, NAK) are damaged.
    pub(crate) answers: u32,
    /// So many in 1000 lone characters come late, with all that follow.
    pub(crate) late: u32,
}

impl Duel {
    pub(crate) fn new(
        configs: [Config; 2],
        jobs: [Vec<Vec<u8>>; 2],
        noise: Noise,
        seed: u64,
    ) -> Self {
        let [a, b] = configs;
        let [a_jobs, b_jobs] = jobs;
        Self {
            ends: [End::new(a, a_jobs), End::new(b, b_jobs)],
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
            if self.ends.iter().all(End::is_finished) {
                return;
            }
            let due = self.ends.iter().filter_map(End::next_due).min();
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
            let lone = at > self.ends[side].last_left + 2 * CHARACTER
                && self.ends[side].leaving.is_empty();
            self.ends[side].last_left = at;
            let steps = at.as_nanos().div_ceil(PIECE.as_nanos());
            let mut handed_on = PIECE * u32::try_from(steps).unwrap();
            if lone && self.random.below(1000) < self.noise.late {
                handed_on += Duration::from_millis(self.random.below(2500).into());
            }
            let arrived = &self.ends[1 - side].arrived;
            handed_on = handed_on.max(arrived.back().map_or(Duration::ZERO, |&(at, _)| at));
            for byte in self.pass(byte, lone) {
                self.ends[1 - side].arrived.push_back((handed_on, byte));
            }
        }
    }

    /// What arrives for a character: itself, or with one wrong bit, or nothing, or one more.
    fn pass(&mut self, byte: u8, lone: bool) -> Vec<u8> {
        let damaged = if lone {
            self.random.below(1000) < self.noise.answers
        } else if self.ahead > 0 || self.noise.spacing == 0 {
            self.ahead = self.ahead.saturating_sub(1);
            false
        } else {
            self.ahead = self.noise.spacing + self.random.below(self.noise.spacing);
            true
        };
        if !damaged {
            return vec![byte];
        }
        match self.random.below(4) {
            0 => vec![],
            1 => vec![byte, self.random.byte()],
            _ => vec![byte ^ 1 << self.random.below(8)],
        }
    }
}
