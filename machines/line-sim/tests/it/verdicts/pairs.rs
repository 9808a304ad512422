//! Two faults at once, at one side or one at each.

use core::time::Duration;

use machine_sim::Random;
use monitor3964r::{Character, Diagnosis, Side, Verdict, diagnose};
use proto3964r::{Config, Line, Priority};

use super::case::{Case, Plan, Variation, between, other};

/// A fault of one side, and the verdict that names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    WithoutBcc,
    OtherBcc,
    NotDoubled,
    Late,
    NoReceiveBuffer,
    Pauses,
    BadReceiver,
}

const FAULTS: [Fault; 7] = [
    Fault::WithoutBcc,
    Fault::OtherBcc,
    Fault::NotDoubled,
    Fault::Late,
    Fault::NoReceiveBuffer,
    Fault::Pauses,
    Fault::BadReceiver,
];

impl Fault {
    fn put_into(self, plan: &mut Plan, random: &mut Random) {
        let Plan {
            settings, faults, ..
        } = plan;
        match self {
            Self::WithoutBcc => {
                let Config { priority, line, .. } = settings.config;
                let qvz_ms = settings.config.qvz_ms;
                settings.config = Config {
                    qvz_ms,
                    ..Config::siemens_3964(priority, line)
                };
            }
            Self::OtherBcc => faults.bcc_change = [0x13, 0x13],
            Self::NotDoubled => faults.doubles_no_dle = true,
            Self::Late => faults.delay = Duration::from_millis(between(random, 2100, 3000)),
            Self::NoReceiveBuffer => faults.keeps_telegrams = true,
            Self::Pauses => faults.pause = Duration::from_millis(between(random, 260, 600)),
            Self::BadReceiver => faults.receiver_error_rate = 0.15,
        }
    }

    fn is_named(self, side: Side, verdict: Verdict) -> bool {
        match verdict {
            Verdict::WithoutBcc { side: at } => self == Self::WithoutBcc && at == side,
            Verdict::OtherBcc { sender, .. } => self == Self::OtherBcc && sender == side,
            Verdict::NotDoubled { sender, .. } => self == Self::NotDoubled && sender == side,
            Verdict::Late { side: at, .. } => self == Self::Late && at == side,
            Verdict::NoReceiveBuffer { refuser } => {
                self == Self::NoReceiveBuffer && refuser == side
            }
            Verdict::Gaps { sender, .. } => self == Self::Pauses && sender == side,
            Verdict::GoodBlocksRejected { refuser, .. } => {
                self == Self::BadReceiver && refuser == side
            }
            _ => false,
        }
    }
}

/// What became of a pair.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    both: u32,
    one_and_more: u32,
    one: u32,
    none: u32,
}

fn judged(case: Case, faults: [Fault; 2], is_at_both: bool) -> (Diagnosis, [bool; 2]) {
    let mut random = case.random();
    let mut plans = case.plans();
    for plan in &mut plans {
        for (number, (_, job)) in plan.jobs.iter_mut().enumerate() {
            if number % 3 == 1 {
                job.extend([0x10, 0x41]);
            }
        }
    }
    let [first, second] = faults;
    first.put_into(&mut plans[0], &mut random);
    second.put_into(&mut plans[usize::from(is_at_both)], &mut random);
    let record: Vec<Character> = case.record(plans, false);
    let config = Config::siemens_3964r(Priority::Low, Line::paced(9600, 11));
    let found = diagnose(&record, &config);
    let sides = [
        case.faulty,
        if is_at_both {
            other(case.faulty)
        } else {
            case.faulty
        },
    ];
    let named = [0, 1].map(|at| {
        [Some(found.verdict), found.or, found.also]
            .into_iter()
            .flatten()
            .any(|verdict| faults[at].is_named(sides[at], verdict))
    });
    (found, named)
}

/// Where an answer is late the rules about blocks are silent: that the other side is at fault too
/// has no name, but is told.
#[test]
fn a_fault_without_a_name_is_told() {
    let mut told = 0;
    for seed in super::seeds() {
        let case = long(seed);
        let (found, named) = judged(case, [Fault::Late, Fault::NoReceiveBuffer], true);
        told += u32::from(named == [true, true] || named != [false, false] && found.more);
    }
    assert!(told >= TOLD_AT_LEAST, "{told}");
}

/// Of the eight lines of each kind: of one nothing is named that is at fault.
const TOLD_AT_LEAST: u32 = 6;

/// A line on which all faults of a pair have time to show.
fn long(seed: u64) -> Case {
    Case {
        sends: [true, true],
        longest: 12,
        seconds: 40,
        ..Case::new(seed, Variation::ALL[0])
    }
}

/// Prints what is named of each pair; `CASES` of each.
#[test]
#[ignore = "a table to read"]
fn shares_of_pairs() {
    let mut all = Share::default();
    for (index, first) in FAULTS.into_iter().enumerate() {
        for (number, second) in FAULTS.into_iter().enumerate() {
            for is_at_both in [false, true] {
                // At one side two that are different, in one order.
                if !is_at_both && number <= index || is_at_both && number < index {
                    continue;
                }
                let mut share = Share::default();
                let mut last = String::new();
                for seed in super::seeds() {
                    let (found, named) = judged(long(seed), [first, second], is_at_both);
                    match named {
                        [true, true] => share.both += 1,
                        [false, false] => {
                            share.none += 1;
                            last = found.verdict.to_string();
                        }
                        _ if found.more => share.one_and_more += 1,
                        _ => share.one += 1,
                    }
                }
                let place = if is_at_both { "each side" } else { "one side" };
                println!("{first:?} {second:?} {place}: {share:?} {last}");
                all.both += share.both;
                all.one_and_more += share.one_and_more;
                all.one += share.one;
                all.none += share.none;
            }
        }
    }
    println!("all: {all:?}");
}
