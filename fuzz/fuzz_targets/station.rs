//! Any characters, line errors, jobs and delays in front of one station.
//!
//! A twin sees the same one character at a time: both must say and send the same. Every job ends
//! once; what is reported as sent or received stood on the line; nothing goes on for ever.
#![no_main]

use std::time::Duration;

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use proto3964r::frame::{IllegalDle, encode, max_encoded_len};
use proto3964r::{Cause, Config, Event, Line, Station, Transmit};

/// Longest block.
const LONGEST: usize = 24;
/// Rounds in which a station must come to rest: above 7 * 8 attempts with one deadline each.
const MOST_ROUNDS: usize = 200;

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let config = pose2pulse_fuzz::config(u, 0)?;
    let mut scene = Scene::new(config);
    while !u.is_empty() {
        scene.happen(u)?;
    }
    scene.come_to_rest();
    Ok(())
}

struct Scene {
    /// Fed in pieces.
    station: Station<LONGEST>,
    /// Fed character by character.
    twin: Station<LONGEST>,
    now: Duration,
    job: Option<Vec<u8>>,
    /// All characters that came in; `None` for what was damaged.
    heard: Vec<Option<u8>>,
    /// All characters that went out since the job was given.
    sent: Vec<u8>,
}

impl Scene {
    fn new(config: Config) -> Self {
        Self {
            station: Station::new(config),
            twin: Station::new(config),
            now: Duration::ZERO,
            job: None,
            heard: Vec::new(),
            sent: Vec::new(),
        }
    }

    fn happen(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        let happening: u8 = u.arbitrary()?;
        match happening & 15 {
            0 | 1 => {
                self.now += match happening >> 4 {
                    0 => Duration::from_secs(u.arbitrary::<u32>()?.into()),
                    1 => Duration::from_nanos(u.arbitrary::<u32>()?.into()),
                    _ => Duration::from_millis(u.int_in_range(0..=6000)?),
                };
                self.time_passes();
            }
            2 => {
                let due = self.station.poll_timeout().unwrap_or(self.now);
                self.now = self.now.max(due);
                self.time_passes();
            }
            3 | 4 => self.submit(u)?,
            5 => {
                assert_eq!(self.station.cancel(self.now), self.twin.cancel(self.now));
            }
            6 => {
                self.heard.push(None);
                self.station.handle_break(self.now);
                self.twin.handle_break(self.now);
            }
            7 => {
                let (byte, error) = (u.arbitrary()?, pose2pulse_fuzz::line_error(u)?);
                self.heard.push(None);
                self.station.handle_damaged(self.now, byte, error);
                self.twin.handle_damaged(self.now, byte, error);
            }
            8 => self.take(1 + usize::from(happening >> 4)),
            9 => self.take(usize::MAX),
            10 => self.hear(vec![0x02]),
            11 => self.hear(vec![0x10]),
            12 => {
                let mut body = [0; max_encoded_len(LONGEST)];
                let payload = piece(u, happening >> 3 & 30)?;
                let check = self.station.config().check;
                let len = encode(payload, check, &mut body).expect("the buffer is long enough");
                self.hear([&[0x02], &body[..len]].concat());
            }
            13 if happening >> 4 & 1 == 0 => {
                assert_eq!(self.station.accept(self.now), self.twin.accept(self.now));
            }
            13 => assert_eq!(self.station.refuse(self.now), self.twin.refuse(self.now)),
            _ => self.hear(piece(u, happening >> 4)?.to_vec()),
        }
        if happening >> 6 != 3 {
            self.poll_events();
        }
        self.agree();
        Ok(())
    }

    fn submit(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        let len = u.int_in_range(0..=LONGEST + 1)?;
        let payload = u.bytes(len.min(u.len()))?;
        let taken = self.station.submit(self.now, payload);
        assert_eq!(taken, self.twin.submit(self.now, payload));
        if taken.is_ok() {
            assert_eq!(self.job.replace(payload.to_vec()), None);
            self.sent.clear();
        }
        Ok(())
    }

    fn hear(&mut self, characters: Vec<u8>) {
        let mut rest = &characters[..];
        while !rest.is_empty() {
            rest = &rest[self.station.handle_bytes(self.now, rest)..];
        }
        for &byte in &characters {
            self.twin.handle_byte(self.now, byte);
        }
        self.heard.extend(characters.into_iter().map(Some));
    }

    fn time_passes(&mut self) {
        self.station.handle_timeout(self.now);
        self.twin.handle_timeout(self.now);
    }

    /// Hands up to `most` characters to the line.
    fn take(&mut self, most: usize) {
        let mut room = vec![0; most.min(3 * LONGEST)];
        let mut together = Vec::new();
        loop {
            let free = room.len().min(most - together.len());
            match self.station.poll_transmit(self.now, &mut room[..free]) {
                Some(Transmit::Bytes(bytes)) => together.extend(bytes),
                Some(Transmit::Discard) => {}
                None => break,
            }
        }
        let twin = std::iter::from_fn(|| self.twin_byte());
        assert_eq!(twin.take(most).collect::<Vec<_>>(), together);
        self.sent.extend(together);
    }

    /// The twin's next character. A line that takes them one at a time has sent the one before,
    /// which only an instant line has at once.
    fn twin_byte(&mut self) -> Option<u8> {
        if self.twin.config().line == Line::Instant {
            return self.twin.poll_transmit_byte(self.now);
        }
        loop {
            match self.twin.poll_transmit(self.now, &mut [0])? {
                Transmit::Bytes(bytes) => return bytes.first().copied(),
                Transmit::Discard => {}
            }
        }
    }

    fn poll_events(&mut self) {
        while let Some(event) = self.station.poll_event() {
            assert_eq!(self.twin.poll_event(), Some(event));
            let config = *self.twin.config();
            let body = |payload: &[u8]| {
                let mut body = [0; max_encoded_len(LONGEST)];
                let len = encode(payload, config.check, &mut body).expect("it is short");
                body[..len].to_vec()
            };
            match event {
                Event::Received(payload) if config.illegal_dle != IllegalDle::Accept => {
                    let body: Vec<_> = body(payload).into_iter().map(Some).collect();
                    assert!(self.heard.windows(body.len()).any(|heard| heard == body));
                }
                Event::Sent { len } => {
                    let job = self.job.take().expect("a job under way");
                    assert_eq!(len, job.len());
                    let body = body(&job);
                    // Not at the end: who polls late may have answered the partner since.
                    assert!(self.sent.windows(body.len()).any(|sent| sent == body));
                }
                Event::Failed(failure) => {
                    assert!(self.job.take().is_some());
                    assert!(failure.attempts <= 7 || failure.cause == Cause::Cancelled);
                }
                _ => {}
            }
        }
        assert_eq!(self.twin.poll_event(), None);
    }

    fn agree(&self) {
        let (station, twin) = (&self.station, &self.twin);
        assert_eq!(station.poll_timeout(), twin.poll_timeout());
        assert_eq!(station.is_idle(), twin.is_idle());
        assert_eq!(station.is_busy(), twin.is_busy());
    }

    /// Nothing comes in any more: the job ends, and the station is idle.
    fn come_to_rest(&mut self) {
        for _ in 0..MOST_ROUNDS {
            self.poll_events();
            self.take(usize::MAX);
            self.agree();
            let Some(due) = self.station.poll_timeout() else {
                self.poll_events();
                assert!(self.station.is_idle() && !self.station.is_busy());
                assert_eq!(self.job, None);
                return;
            };
            self.now = self.now.max(due);
            self.time_passes();
        }
        panic!("no rest: {:?}", self.station);
    }
}

/// The next few bytes of the input.
fn piece<'a>(u: &mut Unstructured<'a>, len: u8) -> Result<&'a [u8]> {
    u.bytes(usize::from(len).min(u.len()).min(LONGEST))
}
