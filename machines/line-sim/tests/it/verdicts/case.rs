//! A line with its fault, its users and its tap, and what the tap has heard.

use core::time::Duration;

use line_sim::{Faults, Frame, Simulation, StationSettings};
use machine_sim::Random;
use monitor3964r::{Character, Side};
use proto3964r::{Config, Line, Priority};

/// One station, what is wrong with it, and its user.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) settings: StationSettings,
    pub(crate) faults: Faults,
    /// When the jobs are submitted, in ms.
    pub(crate) jobs: Vec<(u64, Vec<u8>)>,
    /// From when on it is dead, in ms.
    pub(crate) dead_from_ms: Option<u64>,
}

/// What makes a line harder to judge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Variation {
    /// The capture begins and ends anywhere.
    pub(crate) is_cut: bool,
    /// Some bits of both directions arrive inverted.
    pub(crate) is_noisy: bool,
}

impl Variation {
    pub(crate) const ALL: [Self; 4] = [
        Self::new(false, false),
        Self::new(true, false),
        Self::new(false, true),
        Self::new(true, true),
    ];

    const fn new(is_cut: bool, is_noisy: bool) -> Self {
        Self { is_cut, is_noisy }
    }
}

/// What the lines of all kinds have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) seed: u64,
    /// Which side the fault is at.
    pub(crate) faulty: Side,
    /// Who sends: the faulty side, the other.
    pub(crate) sends: [bool; 2],
    /// Whether the faulty side has high priority.
    pub(crate) is_high: bool,
    /// Longest payload.
    pub(crate) longest: u64,
    /// In both directions.
    pub(crate) bit_error_rate: f64,
    pub(crate) seconds: u64,
    pub(crate) variation: Variation,
    /// Whether the tap tells which characters are damaged.
    pub(crate) tells_damage: bool,
}

/// One bit in 10,000: of blocks of 20 bytes two in a hundred arrive damaged.
const LIGHT_NOISE: f64 = 1e-4;

impl Case {
    pub(crate) fn new(seed: u64, variation: Variation) -> Self {
        let mut random = Random::new(seed);
        let is_b = random.happens(0.5);
        let sends = *pick(&mut random, &[[true, true], [true, false], [false, true]]);
        Self {
            seed,
            faulty: if is_b { Side::B } else { Side::A },
            sends,
            is_high: random.happens(0.5),
            longest: *pick(&mut random, &[3, 12, 48, 160]),
            bit_error_rate: if variation.is_noisy { LIGHT_NOISE } else { 0.0 },
            seconds: 20,
            variation,
            tells_damage: random.happens(0.5),
        }
    }

    /// Random numbers of a kind's own.
    pub(crate) const fn random(&self) -> Random {
        Random::new(!self.seed)
    }

    /// The faulty side and the other one, before the fault.
    pub(crate) fn plans(&self) -> [Plan; 2] {
        let line = Line::paced(9600, 11);
        let priorities = if self.is_high {
            [Priority::High, Priority::Low]
        } else {
            [Priority::Low, Priority::High]
        };
        let mut random = Random::new(self.seed);
        let mut number = 0;
        priorities.map(|priority| {
            let mut jobs = self.jobs(&mut random);
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

    fn jobs(&self, random: &mut Random) -> Vec<(u64, Vec<u8>)> {
        let mut jobs = Vec::new();
        let mut at = between(random, 200, 1200);
        while at < self.seconds * 1000 {
            let len = between(random, 1, self.longest + 1);
            let data = (0..len).map(|place| match random.next_u64() % 6 {
                0 if place > 0 => 0x10,
                1 => 0x03,
                2 => 0x02,
                _ => random.next_u64().to_be_bytes()[0] | 0x20,
            });
            jobs.push((at, data.collect()));
            at += between(random, 400, 1900);
        }
        jobs
    }

    /// What the tap hears; `one_wire` joins both directions.
    pub(crate) fn record(&self, plans: [Plan; 2], one_wire: bool) -> Vec<Character> {
        let [faulty, partner] = plans;
        let plans = match self.faulty {
            Side::A => [faulty, partner],
            Side::B => [partner, faulty],
        };
        let mut line = Simulation::new(plans.each_ref().map(|plan| plan.settings), self.seed);
        line.set_one_wire(one_wire);
        line.set_tells_damage(self.tells_damage);
        let mut deaths = Vec::new();
        for (side, plan) in [Side::A, Side::B].into_iter().zip(&plans) {
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
        line.run_until(Duration::from_secs(self.seconds));
        self.cut(line.heard()).to_vec()
    }

    /// A fifth at most is missing at each end of a capture that is cut.
    fn cut<'r>(&self, record: &'r [Character]) -> &'r [Character] {
        if !self.variation.is_cut {
            return record;
        }
        let mut random = Random::new(self.seed ^ 1);
        let fifth = self.seconds * 200;
        let from = Duration::from_millis(between(&mut random, 0, fifth));
        let to = Duration::from_millis(self.seconds * 1000 - between(&mut random, 0, fifth));
        let begin = record.partition_point(|heard| heard.at < from);
        let end = record.partition_point(|heard| heard.at < to);
        &record[begin..end]
    }
}

pub(crate) const fn other(side: Side) -> Side {
    match side {
        Side::A => Side::B,
        Side::B => Side::A,
    }
}

pub(crate) fn pick<'c, T>(random: &mut Random, choices: &'c [T]) -> &'c T {
    let count = u64::try_from(choices.len()).unwrap();
    &choices[usize::try_from(random.next_u64() % count).unwrap()]
}

/// A whole number from the first one on, below the second one.
pub(crate) const fn between(random: &mut Random, from: u64, to: u64) -> u64 {
    from + random.next_u64() % (to - from)
}
