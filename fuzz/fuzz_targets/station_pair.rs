//! Two stations of any settings on a line that loses, changes, doubles and damages characters as
//! the fuzzer wants: every job ends once, and once the line is clean it carries telegrams again.
#![no_main]

use std::collections::VecDeque;
use std::time::Duration;

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use proto3964r::{Config, Event, Station, Transmit};

/// Longest block.
const LONGEST: usize = 16;
/// Rounds in which two stations must come to rest, each one deadline: all attempts of both, twice.
const MOST_ROUNDS: usize = 1000;

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let check = pose2pulse_fuzz::check(u)?;
    // Less than 20 ms of QVZ would leave no time for a receive buffer.
    let configs = [
        pose2pulse_fuzz::config(u, 20)?,
        pose2pulse_fuzz::config(u, 20)?,
    ];
    let mut line = Line {
        ends: configs.map(|config| End {
            station: Station::new(Config {
                check,
                line: proto3964r::Line::Instant, // all that is carried arrives at once
                ..config
            }),
            job: None,
            received: Vec::new(),
        }),
        way: [VecDeque::new(), VecDeque::new()],
        now: Duration::ZERO,
    };
    while !u.is_empty() {
        let happening: u8 = u.arbitrary()?;
        let side = usize::from(happening & 1);
        match happening >> 1 & 7 {
            0 => line.submit(side, u)?,
            1 => line.ends[side].cancel(line.now),
            2 => line.time_passes(),
            // The first characters on the way, each with its fate.
            _ => {
                line.speak();
                for _ in 0..=happening >> 4 {
                    line.carry(side, u)?;
                }
            }
        }
        line.ends[side].poll_events(line.now);
    }
    line.come_to_rest();
    for from in 0..2 {
        line.deliver_fresh(from);
    }
    Ok(())
}

struct End {
    station: Station<LONGEST>,
    job: Option<Vec<u8>>,
    received: Vec<Vec<u8>>,
}

impl End {
    fn cancel(&mut self, now: Duration) {
        assert!(!self.station.cancel(now) || self.job.is_some());
    }

    /// Takes the events; whether the job was sent.
    fn poll_events(&mut self, now: Duration) -> bool {
        let mut sent = false;
        while let Some(event) = self.station.poll_event() {
            match event {
                Event::Received(payload) => {
                    let payload = payload.to_vec();
                    let is_held = self.station.config().acknowledge_wait_ms > 0;
                    if !is_held || self.station.accept(now) {
                        self.received.push(payload);
                    }
                }
                Event::Sent { len } => {
                    assert_eq!(self.job.take().map(|job| job.len()), Some(len));
                    sent = true;
                }
                Event::Failed(_) => assert!(self.job.take().is_some()),
                _ => {}
            }
        }
        sent
    }
}

struct Line {
    ends: [End; 2],
    /// Characters that each end has sent and the other has not got.
    way: [VecDeque<u8>; 2],
    now: Duration,
}

impl Line {
    fn submit(&mut self, side: usize, u: &mut Unstructured<'_>) -> Result<()> {
        let len = u.int_in_range(0..=LONGEST)?;
        let payload = u.bytes(len.min(u.len()))?;
        let end = &mut self.ends[side];
        if end.station.submit(self.now, payload).is_ok() {
            assert_eq!(end.job.replace(payload.to_vec()), None);
        }
        Ok(())
    }

    /// Both stations put all that they have on the line.
    fn speak(&mut self) {
        let mut out = [0; 8];
        for (end, way) in self.ends.iter_mut().zip(&mut self.way) {
            while let Some(transmit) = end.station.poll_transmit(self.now, &mut out) {
                match transmit {
                    Transmit::Bytes(bytes) => way.extend(bytes),
                    Transmit::Discard => way.clear(),
                }
            }
        }
    }

    /// Brings one character of `side` to the other end, or what becomes of it.
    fn carry(&mut self, side: usize, u: &mut Unstructured<'_>) -> Result<()> {
        let Some(byte) = self.way[side].pop_front() else {
            return Ok(());
        };
        let (station, now) = (&mut self.ends[1 - side].station, self.now);
        match u.arbitrary::<u8>()? {
            0 => {}
            1 => station.handle_byte(now, u.arbitrary()?),
            2 => [byte, byte]
                .into_iter()
                .for_each(|byte| station.handle_byte(now, byte)),
            3 => station.handle_damaged(now, byte, pose2pulse_fuzz::line_error(u)?),
            4 => station.handle_break(now),
            _ => station.handle_byte(now, byte),
        }
        Ok(())
    }

    /// To the next deadline.
    fn time_passes(&mut self) {
        let due = self
            .ends
            .iter()
            .filter_map(|end| end.station.poll_timeout());
        self.now = self.now.max(due.min().unwrap_or(self.now));
        for end in &mut self.ends {
            end.station.handle_timeout(self.now);
        }
    }

    /// Carries everything, without damage, until nobody says anything; whether a job was sent.
    fn exchange(&mut self) -> [bool; 2] {
        let mut sent = [false; 2];
        for _ in 0..MOST_ROUNDS {
            self.speak();
            if self.way.iter().all(VecDeque::is_empty) {
                return sent;
            }
            for side in 0..2 {
                while let Some(byte) = self.way[side].pop_front() {
                    self.ends[1 - side].station.handle_byte(self.now, byte);
                    sent[1 - side] |= self.ends[1 - side].poll_events(self.now);
                }
            }
        }
        panic!(
            "endless talk: {:?}",
            self.ends.each_ref().map(|end| &end.station)
        );
    }

    /// A clean line and time: both stations become idle, their jobs ended.
    fn come_to_rest(&mut self) {
        for _ in 0..MOST_ROUNDS {
            for end in &mut self.ends {
                end.poll_events(self.now);
            }
            self.exchange();
            for end in &mut self.ends {
                end.poll_events(self.now);
            }
            if self
                .ends
                .iter()
                .all(|end| end.station.poll_timeout().is_none())
            {
                for end in &self.ends {
                    assert!(end.station.is_idle() && !end.station.is_busy());
                    assert_eq!(end.job, None);
                }
                return;
            }
            self.time_passes();
        }
        panic!(
            "no rest: {:?}",
            self.ends.each_ref().map(|end| &end.station)
        );
    }

    /// One telegram from an idle station to an idle station over a clean line.
    fn deliver_fresh(&mut self, from: usize) {
        let payload = [0x10, 0x03, 0x02, 0x15];
        let end = &mut self.ends[from];
        end.station.submit(self.now, &payload).expect("it is idle");
        end.job = Some(payload.to_vec());
        let before = self.ends[1 - from].received.len();
        assert!(self.exchange()[from]);
        assert_eq!(self.ends[1 - from].received[before..], [payload]);
        self.come_to_rest();
    }
}
