//! Two endpoints over two 3964R stations and a line of 9600 bit/s that damages bytes, with a
//! simulated clock.

use alloc::collections::VecDeque;
use core::time::Duration;

use proptest::prelude::*;
use proto3964r::{Config as LineConfig, Event as LineEvent, Line, Priority, Station};
use rk512::{Area, Command, Config, DataBlock, Endpoint, Event, MAX_TELEGRAM, Memory, Outcome};

/// 11 bits (8E1) at 9600 bit/s.
const CHARACTER: Duration = Duration::from_micros(1146);
/// Bytes of the data blocks and of the longest job.
const DATA: usize = 400;
/// Longer than a repeat: QVZ (2 s), the transfer of a block, and the same again.
const QUIET: Duration = Duration::from_secs(6);
/// More than any run needs; reaching it means that something is stuck.
const STEPS: usize = 1_000_000;

/// What happens to a byte.
#[derive(Clone, Copy, Debug)]
enum Damage {
    Flip(u8),
    Lose,
    Insert(u8),
}

/// One direction of the line.
#[derive(Default)]
struct Wire {
    free_at: Duration,
    bytes: VecDeque<(Duration, u8)>,
    /// Bytes until the damage, from the damage before.
    damages: VecDeque<(usize, Damage)>,
}

impl Wire {
    fn put(&mut self, now: Duration, byte: u8) {
        self.free_at = now + CHARACTER;
        let damage = match self.damages.front_mut() {
            Some((0, damage)) => {
                let damage = *damage;
                self.damages.pop_front();
                Some(damage)
            }
            Some((ahead, _)) => {
                *ahead -= 1;
                None
            }
            None => None,
        };
        let at = self.free_at;
        match damage {
            None => self.bytes.push_back((at, byte)),
            Some(Damage::Flip(bit)) => self.bytes.push_back((at, byte ^ (1 << bit))),
            Some(Damage::Lose) => {}
            Some(Damage::Insert(other)) => self.bytes.extend([(at, byte), (at, other)]),
        }
    }
}

struct Side {
    endpoint: Endpoint<DATA>,
    station: Station<MAX_TELEGRAM>,
    out: Wire,
    db1: [u8; DATA],
    read_back: Option<Vec<u8>>,
    jobs: u8,
    failures: usize,
    salt: u8,
    /// Takes outdated telegrams back.
    recalls: bool,
}

impl Side {
    fn new(priority: Priority, config: Config, jobs: u8, out: Wire) -> Self {
        Self {
            endpoint: Endpoint::new(config),
            station: Station::new(LineConfig::siemens_3964r(priority, Line::paced(9600, 11))),
            out,
            db1: [0; DATA],
            read_back: None,
            jobs,
            failures: 0,
            salt: 1,
            recalls: true,
        }
    }

    /// The control characters of 3964R and what is near them.
    fn data(&self, job: u8) -> Vec<u8> {
        let alphabet = [0x02, 0x03, 0x10, 0x15, self.salt, job, 0x00];
        let count = 2 * (usize::from(job) % 5 * 37 + 10);
        let step = usize::from(job) + 3;
        let byte = |i: usize| alphabet[(i * step + i / 7) % alphabet.len()];
        (0..count).map(byte).collect()
    }

    /// Writes, reads back, compares; a job that failed is repeated.
    fn work(&mut self) {
        let Some(job) = self.jobs.checked_sub(1) else {
            return;
        };
        let data = self.data(job);
        while let Some(event) = self.endpoint.poll_event() {
            match event {
                Event::Own(Outcome::Sent { .. }) => self.read_back = Some(data.clone()),
                Event::Own(Outcome::Fetched { data, .. }) => {
                    assert!(self.read_back.take().is_some_and(|sent| sent == data));
                    self.jobs = job;
                    return;
                }
                Event::Own(Outcome::Failed { .. }) => self.failures += 1,
                _ => {}
            }
        }
        if !self.endpoint.is_busy() {
            let words = u16::try_from(data.len() / 2).unwrap();
            let area = Area::db(1, job);
            let (command, data) = if self.read_back.is_some() {
                (Command::fetch(area, words), &[][..])
            } else {
                (Command::send(area, words), &data[..])
            };
            self.endpoint.submit(command.unwrap(), data).unwrap();
        }
    }

    fn step(&mut self, now: Duration, incoming: &mut Wire) {
        while incoming.bytes.front().is_some_and(|&(at, _)| at <= now) {
            let (_, byte) = incoming.bytes.pop_front().unwrap();
            self.station.handle_byte(now, byte);
        }
        self.station.handle_timeout(now);
        let mut plc = Memory::new([DataBlock::db(1, &mut self.db1)]);
        self.endpoint.handle_timeout(now, &mut plc);
        while let Some(event) = self.station.poll_event() {
            match event {
                LineEvent::Received(block) => self.endpoint.handle_block(now, block, &mut plc),
                LineEvent::Sent { .. } => self.endpoint.handle_delivered(now),
                LineEvent::Failed(_) => self.endpoint.handle_failed(now, &mut plc),
                _ => {}
            }
            if self.recalls && self.endpoint.wants_recall() {
                self.station.cancel(now);
            }
        }
        self.work();
        if !self.station.is_busy()
            && let Some(telegram) = self.endpoint.poll_transmit(now)
        {
            self.station.submit(now, &telegram).unwrap();
        }
        if self.out.free_at <= now
            && let Some(byte) = self.station.poll_transmit_byte(now)
        {
            self.out.put(now, byte);
        }
    }

    fn next(&self, now: Duration) -> Option<Duration> {
        let station = self.station.poll_timeout();
        let arrival = self.out.bytes.front().map(|&(at, _)| at);
        let free = Some(self.out.free_at).filter(|&at| at > now);
        let all = [station, arrival, free, self.endpoint.poll_timeout()];
        all.into_iter().flatten().min()
    }
}

/// Runs until both have written and read back all their data; returns the failed jobs.
fn run(config: Config, recalls: bool, jobs: u8, damages: [VecDeque<(usize, Damage)>; 2]) -> usize {
    let mut now = Duration::ZERO;
    let [left, right] = damages.map(|damages| Wire {
        damages,
        ..Wire::default()
    });
    let mut low = Side::new(Priority::Low, config, jobs, left);
    let mut high = Side::new(Priority::High, config, jobs, right);
    high.salt = 7;
    (low.recalls, high.recalls) = (recalls, recalls);
    for _ in 0..STEPS {
        low.step(now, &mut high.out);
        high.step(now, &mut low.out);
        if low.jobs == 0 && high.jobs == 0 {
            return low.failures + high.failures;
        }
        let next = low.next(now).into_iter().chain(high.next(now)).min();
        // Events that wait to be polled are polled a microsecond later.
        let soon = now + Duration::from_micros(1);
        now = next.expect("nothing is to come").max(soon);
    }
    panic!("stuck at {now:?}, {} and {} jobs left", low.jobs, high.jobs);
}

#[test]
fn both_write_and_read_at_once() {
    let failures = run(Config::DEFAULT, true, 40, Default::default());
    assert_eq!(failures, 0);
}

fn damages() -> impl Strategy<Value = VecDeque<(usize, Damage)>> {
    let damage = prop_oneof![
        4 => (0u8..8).prop_map(Damage::Flip),
        1 => Just(Damage::Lose),
        1 => any::<u8>().prop_map(Damage::Insert),
    ];
    // At most one in a block: two can cancel in the BCC.
    prop::collection::vec((300usize..900, damage), 0..20).prop_map(VecDeque::from)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    /// Every job ends, and what is read back is what was written.
    #[test]
    fn a_damaging_line(low in damages(), high in damages()) {
        run(Config::DEFAULT, true, 8, [low, high]);
    }

    /// The same with transports that take nothing back: the pause does it.
    #[test]
    fn a_damaging_line_without_recall(low in damages(), high in damages()) {
        let config = Config {
            quiet: QUIET,
            resync: QUIET,
            ..Config::DEFAULT
        };
        run(config, false, 8, [low, high]);
    }
}
