//! Two stations in simulated time, with a line between them that does damage.

extern crate alloc;

use alloc::collections::VecDeque;
use core::time::Duration;

use proto3964r::{Config, Event, Failure, Line, Station, Transmit};

use crate::common::random::Random;

/// Longest block on these lines.
pub(crate) const BLOCK: usize = 48;

/// Characters that a transmitter circuit queues: a discard has something to drop.
const FIFO: usize = 16;

/// What the line does to characters, each a chance in 1000.
#[derive(Clone, Debug, Default)]
pub(crate) struct Faults {
    pub(crate) loss: u32,
    pub(crate) flip: u32,
    pub(crate) duplicate: u32,
    pub(crate) insert: u32,
    pub(crate) delay: u32,
    /// Damage never makes a DLE of another character, and leaves so many characters between faults.
    pub(crate) gentle_gap: Option<u32>,
}

/// In microseconds, rounded up.
fn micros(time: Duration) -> u64 {
    u64::try_from(time.as_nanos().div_ceil(1000)).unwrap()
}

/// How a job ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Sent,
    Failed(Failure),
}

/// One station with its circuits and its user.
#[derive(Debug)]
pub(crate) struct End {
    pub(crate) station: Station<BLOCK>,
    pub(crate) jobs: Vec<Vec<u8>>,
    pub(crate) outcomes: Vec<Outcome>,
    pub(crate) received: Vec<Vec<u8>>,
    pub(crate) same_priority: u32,
    /// Characters that came in since the last telegram.
    raw: Vec<u8>,
    /// For each telegram received: the characters up to its end.
    pub(crate) came_in: Vec<Vec<u8>>,
    fifo: VecDeque<u8>,
    shift_until: u64,
    arriving: VecDeque<(u64, u8)>,
}

impl End {
    fn new(config: Config, jobs: Vec<Vec<u8>>) -> Self {
        Self {
            station: Station::new(config),
            jobs,
            outcomes: Vec::new(),
            received: Vec::new(),
            same_priority: 0,
            raw: Vec::new(),
            came_in: Vec::new(),
            fifo: VecDeque::new(),
            shift_until: 0,
            arriving: VecDeque::new(),
        }
    }

    /// Gives the next job, fills the circuit and takes the events.
    fn serve(&mut self, now: u64) {
        let time = Duration::from_micros(now);
        loop {
            if let Some(job) = self
                .jobs
                .get(self.outcomes.len())
                .filter(|_| !self.station.is_busy())
            {
                self.station.submit(time, job).unwrap();
            }
            match self.station.poll_event() {
                None => break,
                Some(Event::Received(payload)) => {
                    self.received.push(payload.to_vec());
                    self.came_in.push(core::mem::take(&mut self.raw));
                }
                Some(Event::Sent { len }) => {
                    assert_eq!(len, self.jobs[self.outcomes.len()].len());
                    self.outcomes.push(Outcome::Sent);
                }
                Some(Event::Failed(failure)) => self.outcomes.push(Outcome::Failed(failure)),
                Some(Event::SamePriority) => self.same_priority += 1,
                Some(_) => {}
            }
        }
        let mut out = [0; FIFO];
        while self.fifo.len() < FIFO
            && let Some(transmit) = self
                .station
                .poll_transmit(time, &mut out[self.fifo.len()..])
        {
            match transmit {
                Transmit::Discard => self.fifo.clear(),
                Transmit::Bytes(bytes) => self.fifo.extend(bytes),
            }
        }
    }

    fn next_due(&self) -> Option<u64> {
        let shift = (!self.fifo.is_empty()).then_some(self.shift_until);
        let arrival = self.arriving.front().map(|&(time, _)| time);
        let timeout = self.station.poll_timeout().map(micros);
        [shift, arrival, timeout].into_iter().flatten().min()
    }

    fn is_finished(&self) -> bool {
        self.outcomes.len() == self.jobs.len()
            && self.next_due().is_none()
            && self.station.is_idle()
    }
}

/// Two ends and the line between them.
#[derive(Debug)]
pub(crate) struct Pair {
    pub(crate) ends: [End; 2],
    pub(crate) now: u64,
    faults: Faults,
    character_us: u64,
    random: Random,
    /// In both directions.
    characters_since_fault: u32,
}

impl Pair {
    pub(crate) fn new(
        configs: [Config; 2],
        jobs: [Vec<Vec<u8>>; 2],
        faults: Faults,
        character_us: u32,
        seed: u64,
    ) -> Self {
        let line = Line::Paced {
            character_ns: 1000 * character_us,
        };
        let [a, b] = configs.map(|config| Config { line, ..config });
        let [a_jobs, b_jobs] = jobs;
        Self {
            ends: [End::new(a, a_jobs), End::new(b, b_jobs)],
            now: 0,
            faults,
            character_us: u64::from(character_us),
            random: Random::new(seed),
            characters_since_fault: 0,
        }
    }

    /// Lets time pass until both are idle with every job ended; the end time, `None` past `limit`.
    pub(crate) fn run(&mut self, limit: u64) -> Option<u64> {
        for end in &mut self.ends {
            end.serve(0);
        }
        while !self.ends.iter().all(End::is_finished) {
            let due = self.ends.iter().filter_map(End::next_due).min()?;
            self.now = self.now.max(due);
            if self.now > limit {
                return None;
            }
            for side in 0..2 {
                self.step(side);
            }
        }
        Some(self.now)
    }

    /// What is due at one end.
    fn step(&mut self, side: usize) {
        let now = self.now;
        let end = &mut self.ends[side];
        if end.shift_until <= now
            && let Some(byte) = end.fifo.pop_front()
        {
            end.shift_until = now + self.character_us;
            self.carry(1 - side, byte);
        }
        let end = &mut self.ends[side];
        let time = Duration::from_micros(now);
        if end
            .arriving
            .front()
            .is_some_and(|&(arrival, _)| arrival <= now)
        {
            let (_, byte) = end.arriving.pop_front().unwrap();
            end.raw.push(byte);
            end.station.handle_byte(time, byte);
        }
        end.station.handle_timeout(time);
        end.serve(now);
    }

    fn happens(&mut self, per_mille: u32) -> bool {
        self.random.below(1000) < per_mille
    }

    /// Puts a character on its way, or what the line makes of it.
    fn carry(&mut self, to: usize, byte: u8) {
        let mut arrival = self.now + self.character_us;
        self.characters_since_fault = self.characters_since_fault.saturating_add(1);
        let gentle = self.faults.gentle_gap.is_some();
        let spared = self
            .faults
            .gentle_gap
            .is_some_and(|gap| self.characters_since_fault <= gap);
        let mut carried = vec![byte];
        if !spared {
            let Faults {
                loss,
                flip,
                duplicate,
                insert,
                delay,
                ..
            } = self.faults;
            if self.happens(flip) {
                let damaged = byte ^ 1 << self.random.below(8);
                if !(gentle && damaged == 0x10) {
                    carried = vec![damaged];
                }
            } else if self.happens(loss) {
                carried.clear();
            } else if self.happens(duplicate) && !(gentle && byte == 0x10) {
                carried.push(byte);
            } else if self.happens(insert) {
                let inserted = self.random.byte();
                if !(gentle && (inserted == 0x10 || inserted == 0)) {
                    carried.insert(0, inserted);
                }
            }
            if carried != [byte] {
                self.characters_since_fault = 0;
            }
            if self.happens(delay) {
                arrival += u64::from(self.random.below(300_000));
            }
        }
        let arriving = &mut self.ends[to].arriving;
        let last = arriving.back().map_or(0, |&(time, _)| time);
        arriving.extend(carried.into_iter().map(|byte| (arrival.max(last), byte)));
    }
}
