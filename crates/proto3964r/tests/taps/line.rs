//! Two stations, their circuits, the wires between them with a fault, and a tap.

extern crate alloc;

use alloc::collections::VecDeque;
use core::time::Duration;

use proto3964r::{Character, Config, Side, Station, Transmit};

use crate::{
    random::Random,
    uart::{Receiver, STEP_NS, Setting, Transmitter, USUAL},
};

/// Longest payload.
const BLOCK: usize = 64;

/// One station, what is wrong with it, and its user.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) config: Config,
    pub(crate) setting: Setting,
    /// When the jobs are submitted, in ms.
    pub(crate) jobs: Vec<(u64, Vec<u8>)>,
    /// From when on it is dead, in ms.
    pub(crate) dead_from_ms: u64,
    /// Each output comes so much later, in ms.
    pub(crate) delay_ms: u64,
    /// Nothing reaches its receiver.
    pub(crate) is_deaf: bool,
    /// It hears its own characters too.
    pub(crate) hears_itself: bool,
    /// Nobody fetches what it receives.
    pub(crate) keeps_telegrams: bool,
    /// Every block pauses for so many ms.
    pub(crate) pause_ms: u64,
    /// XOR on its check characters: where its payload has an odd and an even number of 10h.
    pub(crate) bcc_change: [u8; 2],
    /// Of 1000 characters, how many leave damaged.
    pub(crate) damage: u32,
    /// Of 1000 characters, how many its receiver takes for damaged.
    pub(crate) deafness: u32,
}

impl Plan {
    pub(crate) fn new(config: Config) -> Self {
        Self {
            config,
            setting: USUAL,
            jobs: Vec::new(),
            dead_from_ms: u64::MAX,
            delay_ms: 0,
            is_deaf: false,
            hears_itself: false,
            keeps_telegrams: false,
            pause_ms: 0,
            bcc_change: [0; 2],
            damage: 0,
            deafness: 0,
        }
    }
}

#[derive(Debug)]
struct End {
    plan: Plan,
    station: Station<BLOCK>,
    jobs: VecDeque<(u64, Vec<u8>)>,
    transmitter: Transmitter,
    receiver: Receiver,
    tap: Receiver,
    /// Characters and the time from which they may leave, in ns.
    queue: VecDeque<(u64, u8)>,
    /// Since its STX.
    sent: Vec<u8>,
    now: u64,
    random: Random,
}

impl End {
    fn new(plan: Plan, seed: u64) -> Self {
        Self {
            station: Station::new(plan.config),
            jobs: plan.jobs.iter().cloned().collect(),
            transmitter: Transmitter::new(plan.setting),
            receiver: Receiver::new(plan.setting),
            tap: Receiver::new(USUAL),
            queue: VecDeque::new(),
            sent: Vec::new(),
            now: 0,
            random: Random::new(seed),
            plan,
        }
    }

    fn is_alive(&self) -> bool {
        self.now / 1_000_000 < self.plan.dead_from_ms
    }

    fn time(&self) -> Duration {
        Duration::from_nanos(self.now)
    }

    fn serve(&mut self) {
        if !self.is_alive() {
            self.queue.clear();
            return;
        }
        let time = self.time();
        self.station.handle_timeout(time);
        while !self.plan.keeps_telegrams && self.station.poll_event().is_some() {}
        if let Some((at, job)) = self.jobs.front()
            && at * 1_000_000 <= self.now
            && !self.station.is_busy()
        {
            self.station.submit(time, job).unwrap();
            self.jobs.pop_front();
        }
        let mut out = [0; 64];
        loop {
            let bytes = match self.station.poll_transmit(time, &mut out) {
                None => break,
                Some(Transmit::Discard) => {
                    self.queue.clear();
                    self.sent.clear();
                    continue;
                }
                Some(Transmit::Bytes(bytes)) => bytes.to_vec(),
            };
            for byte in bytes {
                let due = self.now + self.plan.delay_ms * 1_000_000;
                self.queue.push_back((due, byte));
            }
        }
    }

    /// The next character that may leave, with what is wrong with this station.
    fn load(&mut self) {
        let Some(&(due, byte)) = self.queue.front() else {
            return;
        };
        if due > self.now || !self.transmitter.is_free() {
            return;
        }
        if byte == 2 && self.sent.len() < 2 {
            self.sent.clear();
        }
        if self.sent.len() == 2 && self.plan.pause_ms > 0 {
            self.sent.push(byte);
            self.queue[0].0 = self.now + self.plan.pause_ms * 1_000_000;
            return;
        }
        self.queue.pop_front();
        let mut byte = byte;
        if self.is_bcc() {
            let is_even = self.payload_dles().is_multiple_of(2);
            byte ^= self.plan.bcc_change[usize::from(is_even)];
            self.sent.clear();
        } else {
            self.sent.push(byte);
            if matches!(self.sent[..], [0x10 | 0x15, ..]) {
                self.sent.clear();
            }
        }
        self.transmitter.load(byte);
    }

    /// Whether DLE ETX has just left.
    fn is_bcc(&self) -> bool {
        let Some((&0x03, before)) = self.sent.split_last() else {
            return false;
        };
        let dles = before.iter().rev().take_while(|&&byte| byte == 0x10);
        dles.count() % 2 == 1
    }

    fn payload_dles(&self) -> usize {
        self.sent.iter().filter(|&&byte| byte == 0x10).count() / 2
    }

    /// What the circuit has read.
    fn hear(&mut self, read: Option<u8>) {
        if self.plan.is_deaf || !self.is_alive() {
            return;
        }
        let time = self.time();
        match read.filter(|_| self.random.below(1000) >= self.plan.deafness) {
            Some(byte) => self.station.handle_byte(time, byte),
            None => self
                .station
                .handle_damaged(time, 0, proto3964r::LineError::Parity),
        }
    }

    fn next_due(&self) -> u64 {
        let timeout = self
            .station
            .poll_timeout()
            .map(|due| u64::try_from(due.as_nanos()).unwrap());
        let timeout = timeout.filter(|_| self.is_alive());
        let job = self.jobs.front().filter(|_| !self.station.is_busy());
        let job = job.map(|&(at, _)| at * 1_000_000);
        let out = self.queue.front().map(|&(due, _)| due);
        [timeout, job, out]
            .into_iter()
            .flatten()
            .min()
            .unwrap_or(u64::MAX)
    }

    fn rests(&self) -> bool {
        self.transmitter.is_free() && self.receiver.is_idle() && self.tap.is_idle()
    }
}

/// What the tap hears up to this time, in ms; `one_wire` joins both directions.
pub(crate) fn record(plans: [Plan; 2], one_wire: bool, until_ms: u64, seed: u64) -> Vec<Character> {
    let [a, b] = plans;
    let mut ends = [End::new(a, seed), End::new(b, seed + 1)];
    let mut record = Vec::new();
    let mut now = 0;
    while now < until_ms * 1_000_000 {
        for end in &mut ends {
            end.now = now;
            end.serve();
            end.load();
        }
        let mut levels = ends.each_mut().map(|end| end.transmitter.step());
        for (end, level) in ends.iter_mut().zip(&mut levels) {
            if !*level && end.plan.damage > 0 && end.random.below(1000 * 40) < end.plan.damage {
                *level = true;
            }
        }
        let both = levels[0] && levels[1];
        for (number, side) in [Side::A, Side::B].into_iter().enumerate() {
            let heard = if one_wire { both } else { levels[number] };
            if let Some(read) = ends[number].tap.step(heard) {
                record.push(Character {
                    at: Duration::from_nanos(now),
                    side,
                    byte: read.unwrap_or(0),
                    error: None,
                });
            }
            let arriving = if one_wire || ends[number].plan.hears_itself {
                both
            } else {
                levels[1 - number]
            };
            if let Some(read) = ends[number].receiver.step(arriving) {
                ends[number].hear(read);
            }
        }
        now += STEP_NS;
        if ends.iter().all(End::rests) {
            for end in &mut ends {
                end.serve();
            }
            now = now.max(
                ends.iter()
                    .map(End::next_due)
                    .min()
                    .unwrap_or(u64::MAX)
                    .min(until_ms * 1_000_000),
            );
        }
    }
    record
}
