//! One station, and a port of a PC at the other end of its line.

extern crate alloc;

use alloc::collections::VecDeque;
use core::time::Duration;

use proto3964r::{CharacterError, SubmitError};

use crate::{
    Faults, Frame, StationSettings,
    end::End,
    steps::{step_at, time},
    uart::{Read, Receiver, Transmitter},
};

/// A station, whose partner is whoever calls this, character by character. Time begins at zero.
#[derive(Clone, Debug)]
pub struct Bench {
    end: End,
    transmitter: Transmitter,
    receiver: Receiver,
    queue: VecDeque<u8>,
    step: u64,
}

impl Bench {
    /// A line without faults, and a port for [`Frame::USUAL`]; random faults follow from the seed.
    #[must_use]
    pub fn new(settings: StationSettings, seed: u64) -> Self {
        Self {
            end: End::new(settings, seed),
            transmitter: Transmitter::new(Frame::USUAL),
            receiver: Receiver::new(Frame::USUAL),
            queue: VecDeque::new(),
            step: 0,
        }
    }

    /// What is wrong at the station from now on.
    pub fn set_faults(&mut self, faults: Faults) {
        self.end.set_faults(faults);
    }

    /// Opens the port anew, for other characters.
    pub fn set_frame(&mut self, frame: Frame) {
        self.transmitter = Transmitter::new(frame);
        self.receiver = Receiver::new(frame);
        self.queue.clear();
    }

    /// Gives the station a telegram to send from a time on, after those that it has.
    ///
    /// # Errors
    /// [`SubmitError::TooLong`] for more than [`BLOCK`](crate::BLOCK) bytes; [`SubmitError::Empty`]
    /// where the station sends no empty ones.
    pub fn plan(&mut self, at: Duration, telegram: &[u8]) -> Result<(), SubmitError> {
        self.end.plan(at, telegram)
    }

    /// The time by now.
    #[must_use]
    pub const fn now(&self) -> Duration {
        time(self.step)
    }

    /// Sends a character, after those that are under way.
    pub fn send(&mut self, byte: u8) {
        self.queue.push_back(byte);
    }

    /// Runs until the port has read a character, at most until a time.
    pub fn hear(&mut self, until: Duration) -> Option<(u8, Option<CharacterError>)> {
        let end = step_at(until);
        while self.step < end {
            if let Some(Read { byte, error }) = self.advance(end) {
                return Some((byte, error));
            }
        }
        None
    }

    /// One step; or, where the line rests, all until the next thing is due.
    fn advance(&mut self, end: u64) -> Option<Read> {
        let now = self.now();
        if self.transmitter.is_free()
            && let Some(byte) = self.queue.pop_front()
        {
            self.transmitter.load(byte, 0);
        }
        let mut read = None;
        if !self.rests() {
            let (to_station, to_port) = (self.transmitter.step(), self.end.transmitter.step());
            let hears_both = self.end.faults.hears_itself;
            let level = to_station && (to_port || !hears_both);
            if let Some(read) = self.end.receiver.step(level) {
                self.end.hear(now, read);
            }
            read = self.receiver.step(to_port);
        }
        self.end.serve(now, |_| {});
        // Whoever is told of a character is told of its time.
        let next = if read.is_none() && self.rests() && self.queue.is_empty() {
            self.end.next_due().map_or(end, step_at)
        } else {
            self.step
        };
        self.step = next.clamp(self.step + 1, end.max(self.step + 1));
        read
    }

    fn rests(&self) -> bool {
        self.end.rests() && self.transmitter.is_free() && self.receiver.is_idle()
    }
}
