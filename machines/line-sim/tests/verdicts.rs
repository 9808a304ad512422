//! Verdicts on simulated lines: any data and times, either side at fault, one fault or none.
#![cfg(test)]

use core::time::Duration;
use std::env;

use line_sim::{Faults, Frame, Parity, Simulation, StationSettings};
use machine_sim::Random;
use proptest::{prelude::*, test_runner::RngSeed};
use proto3964r::{Character, Config, Diagnosis, Formula, Line, Priority, Side, Verdict, diagnose};

/// One station, what is wrong with it, and its user.
#[derive(Clone, Debug)]
struct Plan {
    settings: StationSettings,
    faults: Faults,
    /// When the jobs are submitted, in ms.
    jobs: Vec<(u64, Vec<u8>)>,
    /// From when on it is dead, in ms.
    dead_from_ms: Option<u64>,
}

/// What the lines of a case have in common.
#[derive(Clone, Copy, Debug)]
struct Case {
    seed: u64,
    /// Which side the fault is at.
    faulty: Side,
    /// Who sends: the faulty side, the other.
    sends: [bool; 2],
    /// Whether the faulty side has high priority.
    is_high: bool,
    /// Longest payload.
    longest: u64,
    /// In both directions.
    bit_error_rate: f64,
    seconds: u64,
}

fn cases() -> impl Strategy<Value = Case> {
    (
        any::<u64>(),
        any::<bool>(),
        prop_oneof![Just([true, true]), Just([true, false]), Just([false, true])],
        any::<bool>(),
        prop_oneof![Just(3_u64), Just(12), Just(48)],
    )
        .prop_map(|(seed, is_a, sends, is_high, longest)| Case {
            seed,
            faulty: if is_a { Side::A } else { Side::B },
            sends,
            is_high,
            longest,
            bit_error_rate: 0.0,
            seconds: 20,
        })
}

/// `CASES` of each kind from `SEED` on; without them the same few each time.
fn config() -> ProptestConfig {
    let number = |name, usual| env::var(name).map_or(usual, |text| text.parse().unwrap());
    ProptestConfig {
        cases: u32::try_from(number("CASES", 12)).unwrap(),
        rng_seed: RngSeed::Fixed(number("SEED", 1)),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

const fn other(side: Side) -> Side {
    match side {
        Side::A => Side::B,
        Side::B => Side::A,
    }
}

impl Case {
    /// The faulty side and the other one, before the fault.
    fn plans(&self) -> [Plan; 2] {
        let line = Line::paced(9600, 11);
        let priorities = if self.is_high {
            [Priority::High, Priority::Low]
        } else {
            [Priority::Low, Priority::High]
        };
        let mut random = Random::new(self.seed);
        let mut number = 0;
        priorities.map(|priority| {
            let mut jobs = Vec::new();
            let mut at = 200 + random.next_u64() % 1000;
            while at < self.seconds * 1000 {
                let len = 1 + random.next_u64() % self.longest;
                let data = (0..len).map(|place| match random.next_u64() % 6 {
                    0 if place > 0 => 0x10,
                    1 => 0x03,
                    2 => 0x02,
                    _ => random.next_u64().to_be_bytes()[0] | 0x20,
                });
                jobs.push((at, data.collect()));
                at += 400 + random.next_u64() % 1500;
            }
            if !self.sends[number] {
                jobs.clear();
            }
            number += 1;
            Plan {
                settings: StationSettings {
                    config: Config::siemens_3964r(priority, line),
                    frame: Frame::USUAL,
                },
                faults: Faults {
                    bit_error_rate: self.bit_error_rate,
                    ..Faults::NONE
                },
                jobs,
                dead_from_ms: None,
            }
        })
    }

    fn record(&self, plans: [Plan; 2], one_wire: bool) -> Vec<Character> {
        let [faulty, partner] = plans;
        let plans = match self.faulty {
            Side::A => [faulty, partner],
            Side::B => [partner, faulty],
        };
        record(&plans, one_wire, self.seconds * 1000, self.seed)
    }

    fn diagnose(&self, plans: [Plan; 2]) -> Diagnosis {
        judge(&self.record(plans, false))
    }
}

/// What the tap hears up to this time, in ms; `one_wire` joins both directions.
fn record(plans: &[Plan; 2], one_wire: bool, until_ms: u64, seed: u64) -> Vec<Character> {
    let mut line = Simulation::new(plans.each_ref().map(|plan| plan.settings), seed);
    line.set_one_wire(one_wire);
    let mut deaths = Vec::new();
    for (side, plan) in [Side::A, Side::B].into_iter().zip(plans) {
        line.set_faults(side, plan.faults);
        for (at, job) in &plan.jobs {
            line.plan(side, Duration::from_millis(*at), job).unwrap();
        }
        deaths.extend(plan.dead_from_ms.map(|at| (at, side, plan.faults)));
    }
    deaths.sort_by_key(|&(at, ..)| at);
    for (at, side, faults) in deaths {
        line.run_until(Duration::from_millis(at));
        let is_dead = true;
        line.set_faults(side, Faults { is_dead, ..faults });
    }
    line.run_until(Duration::from_millis(until_ms));
    line.heard().to_vec()
}

fn frame(baud: u32, parity: Parity) -> Frame {
    Frame::new(baud, parity).unwrap()
}

fn judge(record: &[Character]) -> Diagnosis {
    let config = Config::siemens_3964r(Priority::Low, Line::paced(9600, 11));
    diagnose(record, &config)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn nothing_is_wrong(case in cases()) {
        let [mut a, b] = case.plans();
        let jobs = a.jobs.len() + b.jobs.len();
        a.settings.config.nak_at_startup = case.seed % 2 == 0;
        let found = case.diagnose([a, b]);
        prop_assert_eq!(found.verdict, Verdict::Works, "{}", found);
        // One may be under way at the end.
        let telegrams = usize::try_from(found.a.telegrams + found.b.telegrams).unwrap();
        prop_assert!(telegrams + 4 >= jobs, "{} of {}", telegrams, jobs);
    }

    #[test]
    fn noise(case in cases(), bit_error_rate in 1e-5..4e-4) {
        let case = Case { bit_error_rate, seconds: 60, ..case };
        let found = case.diagnose(case.plans());
        prop_assert!(
            matches!(found.verdict, Verdict::Works | Verdict::WorksWithRepeats { .. } | Verdict::BadBlocks { .. }),
            "{}", found
        );
    }

    #[test]
    fn another_frame(case in cases(), other in prop_oneof![
        Just(frame(9600, Parity::None)),
        Just(frame(9600, Parity::Odd)),
        Just(frame(38_400, Parity::Even)),
        Just(frame(19_200, Parity::Even)),
        Just(frame(4800, Parity::Even)),
        Just(frame(2400, Parity::Even)),
        Just(frame(4800, Parity::None)),
    ]) {
        // A side without telegrams shows a missing parity bit to nobody.
        let case = Case { sends: [true, case.sends[1]], ..case };
        let [mut faulty, partner] = case.plans();
        faulty.settings.frame = other;
        let found = case.diagnose([faulty, partner]);
        let side = case.faulty;
        // A missing parity bit shows as such where STX, DLE and NAK mostly stand alone.
        let is_named = found.verdict == Verdict::Garbage { side }
            || found.verdict == Verdict::NoParity { side }
                && other == frame(9600, Parity::None);
        prop_assert!(is_named, "{}", found);
    }

    #[test]
    fn an_open_wire(case in cases()) {
        let [mut faulty, partner] = case.plans();
        faulty.faults.is_deaf = true;
        let found = case.diagnose([faulty, partner]);
        let not_heard = Verdict::NotHeard { speaker: other(case.faulty), listener: case.faulty };
        if case.sends[0] {
            // Without a hint of who hears whom, in step from the start, two that insist look alike.
            let or = [Some(not_heard), Some(Verdict::NeitherHears)];
            let is_named = found.verdict == not_heard
                || matches!(found.verdict, Verdict::SamePriority { .. }) && or.contains(&found.or);
            prop_assert!(is_named, "{}", found);
        } else {
            prop_assert_eq!(found.verdict, Verdict::NoAnswer { silent: case.faulty }, "{}", found);
            prop_assert_eq!(found.or, Some(not_heard));
        }
    }

    #[test]
    fn both_wires_open(case in cases()) {
        let case = Case { sends: [true, true], seconds: 60, ..case };
        let plans = case.plans().map(|mut plan| {
            plan.faults.is_deaf = true;
            plan
        });
        let found = case.diagnose(plans);
        prop_assert!([Some(found.verdict), found.or].contains(&Some(Verdict::NeitherHears)), "{}", found);
    }

    #[test]
    fn a_dead_side(case in cases(), dead_from_ms in prop_oneof![Just(0_u64), 5000..10_000_u64]) {
        let case = Case { sends: [case.sends[0], true], seconds: 30, ..case };
        let [mut faulty, partner] = case.plans();
        faulty.dead_from_ms = Some(dead_from_ms);
        let found = case.diagnose([faulty, partner]);
        if dead_from_ms == 0 {
            prop_assert_eq!(found.verdict, Verdict::NoAnswer { silent: case.faulty }, "{}", found);
        } else {
            prop_assert!(
                matches!(found.verdict, Verdict::NoLongerAnswers { silent, .. } if silent == case.faulty),
                "{}", found
            );
        }
    }

    #[test]
    fn the_same_priority(case in cases(), priority in prop_oneof![Just(Priority::Low), Just(Priority::High)]) {
        let case = Case { sends: [true, true], seconds: 40, ..case };
        let [mut a, mut b] = case.plans();
        a.settings.config.priority = priority;
        b.settings.config.priority = priority;
        // Jobs that meet.
        for (one, two) in a.jobs.iter_mut().zip(&mut b.jobs) {
            two.0 = one.0;
        }
        let found = case.diagnose([a, b]);
        prop_assert_eq!(found.verdict, Verdict::SamePriority { priority }, "{}", found);
    }

    #[test]
    fn without_bcc(case in cases(), delay_ms in 0..5_u64, quiet in any::<bool>()) {
        let [mut faulty, partner] = case.plans();
        let Config { priority, line, .. } = faulty.settings.config;
        faulty.settings.config = Config::siemens_3964(priority, line);
        if quiet {
            faulty.settings.config.qvz_ms = 2000;
        }
        faulty.faults.delay = Duration::from_millis(delay_ms);
        let found = case.diagnose([faulty, partner]);
        prop_assert_eq!(found.verdict, Verdict::WithoutBcc { side: case.faulty }, "{}", found);
    }

    #[test]
    fn another_bcc(case in cases(), (formula, bcc_change) in prop_oneof![
        Just((Formula::Undoubled, [0x10, 0])),
        Just((Formula::WithStx, [2, 2])),
        Just((Formula::WithoutEnd, [0x13, 0x13])),
        Just((Formula::StartValue { difference: 0xFF }, [0xFF, 0xFF])),
    ]) {
        let case = Case { sends: [true, case.sends[1]], longest: 12, ..case };
        let [mut faulty, partner] = case.plans();
        for (number, (_, job)) in faulty.jobs.iter_mut().enumerate() {
            job.retain(|&byte| byte != 0x10);
            if number % 2 == 0 {
                job.extend([0x41, 0x10]);
            }
        }
        faulty.faults.bcc_change = bcc_change;
        let found = case.diagnose([faulty, partner]);
        prop_assert_eq!(found.verdict, Verdict::OtherBcc { sender: case.faulty, formula }, "{}", found);
    }

    #[test]
    fn late_answers(case in cases(), delay_ms in 2050..6000_u64) {
        let case = Case { sends: [false, true], seconds: 40, ..case };
        let [mut faulty, partner] = case.plans();
        faulty.faults.delay = Duration::from_millis(delay_ms);
        let found = case.diagnose([faulty, partner]);
        let Verdict::Late { side, delay, .. } = found.verdict else {
            return Err(TestCaseError::fail(format!("{found}")));
        };
        prop_assert_eq!(side, case.faulty);
        prop_assert!(delay.as_millis().abs_diff(delay_ms.into()) < 5, "{:?}", delay);
    }

    #[test]
    fn late_for_a_short_qvz(case in cases(), delay_ms in 600..1500_u64) {
        let case = Case { sends: [false, true], seconds: 40, ..case };
        let [mut faulty, mut partner] = case.plans();
        faulty.faults.delay = Duration::from_millis(delay_ms);
        partner.settings.config.qvz_ms = 550;
        let found = case.diagnose([faulty, partner]);
        let Verdict::Late { side, delay, qvz } = found.verdict else {
            return Err(TestCaseError::fail(format!("{found}")));
        };
        prop_assert_eq!(side, case.faulty);
        prop_assert!(delay.as_millis().abs_diff(delay_ms.into()) < 5, "{:?}", delay);
        prop_assert!(qvz.as_millis().abs_diff(550) < 5, "{:?}", qvz);
    }

    #[test]
    fn echo(case in cases()) {
        let case = Case { seconds: 20, ..case };
        let found = judge(&case.record(case.plans(), true));
        prop_assert!([Some(found.verdict), found.or].contains(&Some(Verdict::Echo)), "{}", found);
    }

    #[test]
    fn own_echo(case in cases()) {
        let case = Case { sends: [true, case.sends[1]], ..case };
        let [mut faulty, partner] = case.plans();
        faulty.faults.hears_itself = true;
        let found = case.diagnose([faulty, partner]);
        prop_assert_eq!(found.verdict, Verdict::OwnEcho { side: case.faulty }, "{}", found);
    }

    #[test]
    fn pauses(case in cases(), pause_ms in 260..600_u64) {
        let case = Case { sends: [true, case.sends[1]], longest: 12, ..case };
        let [mut faulty, partner] = case.plans();
        faulty.faults.pause = Duration::from_millis(pause_ms);
        let found = case.diagnose([faulty, partner]);
        prop_assert!(
            matches!(found.verdict, Verdict::Gaps { sender, .. } if sender == case.faulty),
            "{}", found
        );
    }

    #[test]
    fn no_receive_buffer(case in cases()) {
        let case = Case { sends: [false, true], ..case };
        let [mut faulty, partner] = case.plans();
        faulty.faults.keeps_telegrams = true;
        let found = case.diagnose([faulty, partner]);
        prop_assert_eq!(found.verdict, Verdict::NoReceiveBuffer { refuser: case.faulty }, "{}", found);
    }

    #[test]
    fn a_bad_receiver(case in cases()) {
        let case = Case { sends: [case.sends[0], true], longest: 48, ..case };
        let [mut faulty, partner] = case.plans();
        faulty.faults.receiver_error_rate = 0.15;
        let found = case.diagnose([faulty, partner]);
        let is_named = [Some(found.verdict), found.or].into_iter().flatten().any(|verdict| {
            matches!(verdict, Verdict::GoodBlocksRejected { refuser, .. } if refuser == case.faulty)
        });
        prop_assert!(is_named, "{}", found);
    }
}
