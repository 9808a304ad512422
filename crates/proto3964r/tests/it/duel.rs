//! Two stations on a noisy line that cannot take back what it was given: whatever is reported sent
//! has arrived.

mod line;
mod scripts;

use line::{ADAPTER, Duel, Habits, Noise, Tally};
use proto3964r::{Config, IdleNoise, IllegalDle, Line, Priority};

use crate::common::random::Random;

/// Telegrams of both sides together.
const TELEGRAMS: usize = 480;
/// Of each side in one duel.
const JOBS: usize = 10;

/// One in ten answers is damaged, and a block now and then.
const NOISY: Noise = Noise {
    spacing: 400,
    answers: 100,
    late: 0,
    late_ms: 2500,
    seen: false,
};

/// Short ones and long ones, that differ, with many control characters.
fn jobs(random: &mut Random, side: u8) -> Vec<Vec<u8>> {
    let job = |number: usize| {
        let len = match random.below(2) {
            0 => 100 + random.below(100),
            _ => random.below(12),
        };
        let mut byte = || match random.below(8) {
            0 => 0x02,
            1 => 0x10,
            2 => 0x15,
            _ => random.byte(),
        };
        let head = [side, u8::try_from(number).unwrap()];
        head.into_iter().chain((0..len).map(|_| byte())).collect()
    };
    (0..JOBS).map(job).collect()
}

/// Stations that fall back to idle in the middle of a bad block, as some foreign ones do: what is
/// left of the block then reads as the next STX, which they answer.
fn config(priority: Priority, line: Line) -> Config {
    Config {
        illegal_dle: IllegalDle::RejectAtOnce,
        idle_noise: IdleNoise::Ignore,
        ..Config::siemens_3964r(priority, line)
    }
}

/// What becomes of `TELEGRAMS` when the stations take their line for this one.
fn fight(line: Line, noise: Noise) -> Tally {
    let mut all = Tally::default();
    for seed in 1..=TELEGRAMS / (2 * JOBS) {
        let seed = u64::try_from(seed).unwrap();
        let mut random = Random::new(seed);
        let jobs = [jobs(&mut random, 0xA0), jobs(&mut random, 0xB0)];
        let configs = [Priority::High, Priority::Low].map(|priority| config(priority, line));
        let mut duel = Duel::new(configs, jobs, ADAPTER, Habits::default(), noise, seed);
        duel.run();
        for end in &duel.ends {
            all.sent += end.tally.sent;
            all.failed += end.tally.failed;
            all.falsely += end.tally.falsely;
        }
    }
    assert_eq!(all.sent + all.failed, TELEGRAMS);
    all
}

fn adapters() -> Line {
    Line::buffered(9600, 11)
}

/// Both begin with NAK and STX at the same time, which the adapters hand on in one piece.
#[test]
fn a_clean_line_carries_everything() {
    let clean = Noise {
        spacing: 0,
        answers: 0,
        ..NOISY
    };
    for line in [adapters(), Line::Instant] {
        let tally = fight(line, clean);
        assert_eq!((tally.sent, tally.falsely), (TELEGRAMS, 0), "{line:?}");
    }
}

#[test]
fn nothing_is_reported_sent_that_did_not_arrive() {
    let late = Noise { late: 100, ..NOISY };
    let late_only = Noise { answers: 0, ..late };
    for noise in [NOISY, late, late_only] {
        let tally = fight(adapters(), noise);
        println!("{noise:?}: {tally:?}");
        assert_eq!(tally.falsely, 0, "{noise:?}");
        assert!(tally.sent > TELEGRAMS * 9 / 10, "{tally:?}");
    }
}

/// The duel can tell: stations that believe the line to be instant are deceived.
#[test]
fn a_station_that_does_not_know_its_line_is_deceived() {
    let tally = fight(Line::Instant, NOISY);
    println!("{tally:?}");
    assert!(tally.falsely > 0);
}
