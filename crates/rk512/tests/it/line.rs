//! Two endpoints with a simulated clock over a transport that loses, repeats and delays whole
//! blocks, and whose reports are late and may be wrong.

use core::time::Duration;

use proptest::prelude::*;
use rk512::{
    Area, Command, Config, DataBlock, Endpoint, Event, JobError, MAX_DATA, Memory, Outcome,
};

/// Longest way of a block, of its repeat and of the report to its sender.
const LONGEST_MS: u64 = 1000;
/// A repeat of a reaction comes at most this long after the reaction: the repeat of the
/// command, the wait for the transport and the way back, each at most `LONGEST_MS`, once for
/// the reaction in the transport's hands and once for the error that follows it.
const REPEATS_MS: u64 = 6 * LONGEST_MS;
/// Words of the partner's data blocks.
const WORDS: usize = 600;
/// More than any run needs; reaching it means that the endpoints talk for ever.
const STEPS: usize = 100_000;

/// What happens to one block.
#[derive(Clone, Copy, Debug)]
struct Fate {
    arrives: Option<u64>,
    repeat: Option<u64>,
    report: u64,
    delivered: bool,
}

const CLEAN: Fate = Fate {
    arrives: Some(20),
    repeat: None,
    report: 20,
    delivered: true,
};

#[derive(Clone, Copy, Debug)]
struct Order {
    send: bool,
    start: u8,
    words: u16,
}

#[derive(Debug)]
enum Happening {
    Report(bool),
    Block(Vec<u8>),
}

struct Side {
    endpoint: Endpoint<{ 2 * WORDS }>,
    /// What the partner writes.
    written: [u8; 2 * WORDS],
    /// What the partner reads.
    constant: [u8; 2 * WORDS],
    orders: Vec<Order>,
    current: Option<(Order, Vec<u8>)>,
    outcomes: Vec<Result<(), JobError>>,
}

fn memory<'a>(written: &'a mut [u8], constant: &'a mut [u8]) -> Memory<'a, 2> {
    Memory::new([DataBlock::db(1, written), DataBlock::db(2, constant)])
}

/// Words that differ from their neighbours, and from those of another salt.
fn words(salt: u16, count: usize) -> impl Iterator<Item = u8> {
    let step = |word: u16| word.wrapping_add(0x9E37);
    core::iter::successors(Some(salt), move |&word| Some(step(word)))
        .flat_map(u16::to_be_bytes)
        .take(2 * count)
}

impl Side {
    fn new(config: Config, mut orders: Vec<Order>, salt: u16) -> Self {
        orders.reverse();
        let mut constant = [0; 2 * WORDS];
        for (to, from) in constant.iter_mut().zip(words(salt, WORDS)) {
            *to = from;
        }
        Self {
            endpoint: Endpoint::new(config),
            written: [0; 2 * WORDS],
            constant,
            orders,
            current: None,
            outcomes: Vec::new(),
        }
    }

    fn start_next(&mut self) {
        if self.current.is_some() {
            return;
        }
        let Some(order) = self.orders.pop() else {
            return;
        };
        let salt = u16::try_from(self.outcomes.len() * 77 + 1).unwrap();
        let data: Vec<u8> = words(salt, usize::from(order.words)).collect();
        let (command, given) = if order.send {
            (
                Command::send(Area::db(1, order.start), order.words),
                &data[..],
            )
        } else {
            (
                Command::fetch(Area::db(2, order.start), order.words),
                &[][..],
            )
        };
        let taken = self.endpoint.submit(command.unwrap(), given);
        taken.expect("no job runs");
        self.current = Some((order, data));
    }

    /// Notes the outcome of the own job; the partner's memory must bear it out.
    fn check_outcome(&mut self, partner: &Self) {
        let outcome = loop {
            match self.endpoint.poll_event() {
                Some(Event::Own(outcome)) => break outcome,
                Some(Event::Partner(_)) => {}
                None => return,
            }
        };
        let (order, data) = self.current.take().expect("one outcome for each job");
        let from = 2 * usize::from(order.start);
        let place = from..from + data.len();
        self.outcomes.push(match outcome {
            Outcome::Sent { .. } => {
                assert!(data == partner.written[place], "sent but not there");
                Ok(())
            }
            Outcome::Fetched { data, .. } => {
                assert!(data == &partner.constant[place], "fetched but not so");
                Ok(())
            }
            Outcome::Failed { error, .. } => Err(error),
            other => panic!("{other:?}"),
        });
    }

    fn happens(&mut self, now: Duration, happening: Happening) {
        let mut plc = memory(&mut self.written, &mut self.constant);
        match happening {
            Happening::Report(true) => self.endpoint.handle_delivered(now),
            Happening::Report(false) => self.endpoint.handle_failed(now, &mut plc),
            Happening::Block(block) => self.endpoint.handle_block(now, &block, &mut plc),
        }
    }
}

struct Line {
    now: Duration,
    sides: [Side; 2],
    fates: Vec<Fate>,
    ahead: Vec<(Duration, usize, Happening)>,
    blocks: usize,
}

impl Line {
    fn new(config: Config, orders: [Vec<Order>; 2], mut fates: Vec<Fate>) -> Self {
        fates.reverse();
        let [left, right] = orders;
        Self {
            now: Duration::ZERO,
            sides: [Side::new(config, left, 3), Side::new(config, right, 5)],
            fates,
            ahead: Vec::new(),
            blocks: 0,
        }
    }

    fn transmit(&mut self, side: usize) {
        let Some(telegram) = self.sides[side].endpoint.poll_transmit(self.now) else {
            return;
        };
        self.blocks += 1;
        let fate = self.fates.pop().unwrap_or(CLEAN);
        let now = self.now;
        let at = |millis| now + Duration::from_millis(millis);
        for arrival in [fate.arrives, fate.repeat].into_iter().flatten() {
            let block = Happening::Block(telegram.to_vec());
            self.ahead.push((at(arrival), 1 - side, block));
        }
        let report = Happening::Report(fate.delivered);
        self.ahead.push((at(fate.report), side, report));
    }

    /// Until nothing is to come.
    fn run(&mut self) {
        for _ in 0..STEPS {
            for side in 0..2 {
                let [left, right] = &mut self.sides;
                let (own, partner) = if side == 0 {
                    (left, right)
                } else {
                    (right, left)
                };
                own.check_outcome(partner);
                own.start_next();
                self.transmit(side);
            }
            let timeouts = self.sides.iter().filter_map(|s| s.endpoint.poll_timeout());
            let ahead = self.ahead.iter().map(|(at, ..)| *at);
            let Some(next) = timeouts.chain(ahead).min() else {
                return;
            };
            self.now = self.now.max(next);
            // Of what happens at one moment, reports come first.
            let due = self
                .ahead
                .iter()
                .enumerate()
                .filter(|(_, a)| a.0 <= self.now);
            let first = due.min_by_key(|(_, (at, _, happening))| {
                (*at, matches!(happening, Happening::Block(_)))
            });
            if let Some((index, _)) = first {
                let (_, side, happening) = self.ahead.remove(index);
                self.sides[side].happens(self.now, happening);
            }
            for side in &mut self.sides {
                let mut plc = memory(&mut side.written, &mut side.constant);
                side.endpoint.handle_timeout(self.now, &mut plc);
            }
        }
        panic!("the endpoints talk for ever");
    }

    /// Every job has ended, and the line has come to rest.
    fn check_rest(&mut self, jobs: [usize; 2]) {
        for (side, jobs) in self.sides.iter_mut().zip(jobs) {
            assert_eq!(side.outcomes.len(), jobs, "one outcome for each job");
            assert!(!side.endpoint.is_busy());
            assert_eq!(side.endpoint.poll_timeout(), None);
            assert!(side.endpoint.poll_transmit(self.now).is_none());
        }
    }

    /// On a line that is clean again the very next jobs succeed.
    fn check_recovered(&mut self) {
        let order = |send| Order {
            send,
            start: 1,
            words: 200,
        };
        self.fates.clear();
        // The last reaction of a job that failed may still be on its way.
        self.now += Duration::from_millis(REPEATS_MS);
        for side in &mut self.sides {
            side.outcomes.clear();
            side.orders = vec![order(true), order(false)];
        }
        self.run();
        for side in &self.sides {
            assert_eq!(side.outcomes, [Ok(()), Ok(())]);
        }
    }
}

fn config() -> Config {
    Config {
        resync: Duration::from_millis(REPEATS_MS),
        ..Config::DEFAULT
    }
}

fn orders() -> impl Strategy<Value = Vec<Order>> {
    let order = (any::<bool>(), any::<u8>(), 1u16..330);
    let order = order.prop_map(|(send, start, words)| Order { send, start, words });
    prop::collection::vec(order, 0..6)
}

/// Mostly good blocks; `repeats` says whether some arrive twice.
fn fates(repeats: bool) -> impl Strategy<Value = Vec<Fate>> {
    let way = || prop_oneof![3 => Just(20), 1 => 0..=LONGEST_MS];
    let arrives = prop::option::weighted(0.85, way());
    let repeat = prop::option::weighted(0.2, way());
    let told = prop_oneof![5 => Just(true), 1 => Just(false)];
    let fate = (arrives, repeat, way(), told);
    let fate = fate.prop_map(move |(arrives, repeat, report, delivered)| Fate {
        arrives,
        repeat: repeat.filter(|_| repeats),
        report,
        delivered,
    });
    prop::collection::vec(fate, 0..120)
}

#[test]
fn a_clean_line_carries_every_job_both_ways_at_once() {
    let order = |i: u16| Order {
        send: i.is_multiple_of(2),
        start: u8::try_from(i).unwrap(),
        words: 3 * i + 1,
    };
    let orders: Vec<Order> = (0..100).map(order).collect();
    let mut line = Line::new(config(), [orders.clone(), orders.clone()], Vec::new());
    line.run();
    line.check_rest([100, 100]);
    for side in &line.sides {
        assert!(side.outcomes.iter().all(Result::is_ok));
    }
    let telegrams = |order: &Order| 2 * (2 * usize::from(order.words)).div_ceil(MAX_DATA);
    let expected: usize = orders.iter().map(telegrams).sum();
    assert_eq!(line.blocks, 2 * expected);
}

#[test]
fn one_lost_block_fails_one_job() {
    for lost in 0..6 {
        let mut fates = vec![CLEAN; lost];
        fates.push(Fate {
            arrives: None,
            ..CLEAN
        });
        let order = Order {
            send: true,
            start: 0,
            words: 150,
        };
        let mut line = Line::new(config(), [vec![order; 2], Vec::new()], fates);
        line.run();
        let outcomes = &line.sides[0].outcomes;
        let time = Duration::from_secs(20);
        assert_eq!(*outcomes, [Err(JobError::NoReaction(time)), Ok(())]);
    }
}

proptest! {
    /// Without repeats nothing needs a pause between good telegrams.
    #[test]
    fn loss_and_delay(a in orders(), b in orders(), fates in fates(false)) {
        let jobs = [a.len(), b.len()];
        let mut line = Line::new(config(), [a, b], fates);
        line.run();
        line.check_rest(jobs);
        line.check_recovered();
    }

    /// With repeats the pause keeps done jobs true.
    #[test]
    fn loss_delay_and_repeats(a in orders(), b in orders(), fates in fates(true)) {
        let jobs = [a.len(), b.len()];
        let config = Config {
            quiet: Duration::from_millis(REPEATS_MS),
            ..config()
        };
        let mut line = Line::new(config, [a, b], fates);
        line.run();
        line.check_rest(jobs);
        line.check_recovered();
    }
}
