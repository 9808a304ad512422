//! One side of the line: a station, its circuits, what is wrong with them, and its user.

extern crate alloc;

use alloc::collections::VecDeque;
use core::time::Duration;

use machine_sim::Random;
use proto3964r::{
    CharacterError, Config, Event, Station, SubmitError, Transmit,
    ascii::{DLE, ETX, NAK, STX},
};

use crate::{
    BLOCK, Faults, Frame,
    uart::{Read, Receiver, Transmitter},
};

/// Parameters of one station and of its circuits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::exhaustive_structs, reason = "what a station is set to")]
pub struct StationSettings {
    /// Of the procedure; its [`line`](Config::line) is what the station takes the line for.
    pub config: Config,
    /// Of the circuits.
    pub frame: Frame,
}

#[derive(Clone, Debug)]
pub(crate) struct End {
    pub(crate) faults: Faults,
    pub(crate) station: Station<BLOCK>,
    pub(crate) transmitter: Transmitter,
    pub(crate) receiver: Receiver,
    jobs: VecDeque<(Duration, Vec<u8>)>,
    /// Characters and the time from which on they may leave.
    queue: VecDeque<(Duration, u8)>,
    /// Since its STX.
    sent: Vec<u8>,
    random: Random,
}

impl End {
    pub(crate) fn new(settings: StationSettings, seed: u64) -> Self {
        Self {
            faults: Faults::NONE,
            station: Station::new(settings.config),
            transmitter: Transmitter::new(settings.frame),
            receiver: Receiver::new(settings.frame),
            jobs: VecDeque::new(),
            queue: VecDeque::new(),
            sent: Vec::new(),
            random: Random::new(seed),
        }
    }

    pub(crate) fn set_faults(&mut self, faults: Faults) {
        if self.faults.is_dead && !faults.is_dead {
            self.station = Station::new(*self.station.config());
        }
        self.faults = faults;
    }

    /// Submits a telegram at that time, or when those before it have ended.
    pub(crate) fn plan(&mut self, at: Duration, telegram: &[u8]) -> Result<(), SubmitError> {
        let len = telegram.len();
        if len > BLOCK {
            let capacity = BLOCK;
            return Err(SubmitError::TooLong { len, capacity });
        }
        if telegram.is_empty() && !self.station.config().allow_empty {
            return Err(SubmitError::Empty);
        }
        self.jobs.push_back((at, telegram.to_vec()));
        Ok(())
    }

    /// Telegrams that wait or are under way.
    pub(crate) fn jobs(&self) -> usize {
        self.jobs.len() + usize::from(self.station.is_busy())
    }

    /// What the station does by now, and its user; tells the events.
    pub(crate) fn serve(&mut self, now: Duration, mut tell: impl FnMut(Event<'_>)) {
        if self.faults.is_dead {
            self.queue.clear();
            return;
        }
        self.station.handle_timeout(now);
        while !self.faults.keeps_telegrams
            && let Some(event) = self.station.poll_event()
        {
            tell(event);
        }
        if let Some((at, telegram)) = self.jobs.front()
            && *at <= now
            && self.station.submit(now, telegram).is_ok()
        {
            self.jobs.pop_front();
        }
        self.fetch(now);
        self.load(now);
    }

    /// Fetches what the station has to send: a character when the one before has left; all at once
    /// where its output is late.
    fn fetch(&mut self, now: Duration) {
        let mut out = [0; 64];
        loop {
            let room = self.room().min(out.len());
            let out = out.get_mut(..room).unwrap_or_default();
            let Some(transmit) = self.station.poll_transmit(now, out) else {
                return;
            };
            match transmit {
                Transmit::Discard => {
                    self.queue.clear();
                    self.sent.clear();
                }
                Transmit::Bytes(bytes) => {
                    let due = now + self.faults.delay;
                    self.queue.extend(bytes.iter().map(|&byte| (due, byte)));
                }
            }
        }
    }

    /// How many characters are fetched now; none still tells what to discard.
    fn room(&self) -> usize {
        if !self.faults.delay.is_zero() {
            usize::MAX
        } else {
            usize::from(self.queue.is_empty() && self.transmitter.is_free())
        }
    }

    /// Hands the transmitter the next character that may leave, with what is wrong with this side.
    fn load(&mut self, now: Duration) {
        if !self.transmitter.is_free() {
            return;
        }
        let Some((due, byte)) = self.queue.front_mut() else {
            return;
        };
        if *due > now {
            return;
        }
        let byte = *byte;
        if byte == STX && self.sent.len() < 2 {
            self.sent.clear();
        }
        if self.sent.len() == 2 && !self.faults.pause.is_zero() {
            *due = now + self.faults.pause;
            self.sent.push(byte);
            return;
        }
        self.queue.pop_front();
        if self.faults.doubles_no_dle && byte == DLE && self.ends_with_dle() {
            self.sent.push(byte);
            self.fetch(now);
            // The station reckons with its time on the wire.
            let after = now + self.transmitter.character();
            if let Some((due, _)) = self.queue.front_mut() {
                *due = after;
            }
            return;
        }
        let change = self.bcc_change();
        if change.is_some() {
            self.sent.clear();
        } else {
            self.sent.push(byte);
            if matches!(self.sent[..], [DLE | NAK, ..]) {
                self.sent.clear();
            }
        }
        let flipped = self.flipped_bits();
        self.transmitter
            .load(byte ^ change.unwrap_or_default(), flipped);
    }

    /// What is wrong with the next character, if it is the check character: DLE ETX has just left.
    fn bcc_change(&self) -> Option<u8> {
        let (&ETX, before) = self.sent.split_last()? else {
            return None;
        };
        let dles = before.iter().rev().take_while(|&&byte| byte == DLE);
        let is_end = dles.count() % 2 == 1;
        let payload_dles = self.sent.iter().filter(|&&byte| byte == DLE).count() / 2;
        let [mut odd, even] = self.faults.bcc_change;
        if self.faults.doubles_no_dle {
            odd ^= DLE;
        }
        is_end.then_some(if payload_dles % 2 == 1 { odd } else { even })
    }

    /// Whether a DLE of the payload has left that is to be doubled.
    fn ends_with_dle(&self) -> bool {
        let dles = self.sent.iter().rev().take_while(|&&byte| byte == DLE);
        self.sent.first() == Some(&STX) && dles.count() % 2 == 1
    }

    /// Bits of a character that noise inverts.
    fn flipped_bits(&mut self) -> u16 {
        if self.faults.bit_error_rate <= 0.0 {
            return 0;
        }
        let mut flipped = 0;
        for bit in 0..u16::BITS {
            if self.random.happens(self.faults.bit_error_rate) {
                flipped |= 1 << bit;
            }
        }
        flipped
    }

    /// What the receiver has read.
    pub(crate) fn hear(&mut self, now: Duration, read: Read) {
        if self.faults.is_deaf || self.faults.is_dead {
            return;
        }
        let is_lost = self.random.happens(self.faults.receiver_error_rate);
        let error = read.error.or(is_lost.then_some(CharacterError::Parity));
        match error {
            None => self.station.handle_byte(now, read.byte),
            Some(error) => self.station.handle_damaged(now, read.byte, error),
        }
    }

    /// When something happens here without a character from the line.
    pub(crate) fn next_due(&self) -> Option<Duration> {
        if self.faults.is_dead {
            return None;
        }
        let job = self.jobs.front().filter(|_| !self.station.is_busy());
        let job = job.map(|&(at, _)| at);
        let out = self.queue.front().map(|&(due, _)| due);
        let dues = [self.station.poll_timeout(), job, out];
        dues.into_iter().flatten().min()
    }

    pub(crate) fn rests(&self) -> bool {
        self.transmitter.is_free() && self.receiver.is_idle()
    }
}
