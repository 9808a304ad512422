//! Random scripts: any settings, any line, users that pause, look away and give up.
//!
//! `SCRIPTS=1000000 cargo test --release -p proto3964r --test it duel::scripts -- --nocapture` runs
//! more of them, `FIRST=n` begins at another one.

use core::time::Duration;

use proto3964r::ascii::NAK;
use proto3964r::frame::encode;
use proto3964r::{Check, Config, Conflict, IdleNoise, IllegalDle, Line, Priority, SilenceInBlock};
use test_support::setting;

use super::line::{Duel, Habits, Noise, Tally, Wire};
use crate::common::random::Random;

/// Longest payload: its block is shorter than the distance of two damages.
const LONGEST: u32 = 24;
/// Damages in blocks are at least so far apart.
const SPACING: u32 = 60;
/// Jobs of one side.
const JOBS: u32 = 3;

fn one_of<T: Copy>(random: &mut Random, all: &[T]) -> T {
    all[random.below(u32::try_from(all.len()).unwrap()) as usize]
}

/// The line as the stations know it, and as it is.
fn line(random: &mut Random) -> (Line, Wire) {
    let all: [(u32, u8); 4] = [(9600, 11), (1200, 11), (115_200, 10), (38_400, 10)];
    let (baud, bits) = one_of(random, &all);
    let character = Duration::from_nanos(u64::from(bits) * 1_000_000_000 / u64::from(baud));
    let instant = Wire {
        character: Duration::ZERO,
        way: Duration::ZERO,
        piece: Duration::ZERO,
        discards: true,
    };
    match random.below(3) {
        0 => (Line::Instant, instant),
        1 => {
            let wire = Wire {
                character,
                ..instant
            };
            (Line::paced(baud, bits), wire)
        }
        _ => {
            let wire = Wire {
                character,
                way: Duration::from_micros(random.below(3000).into()),
                piece: Duration::from_millis(random.below(17).into()),
                discards: false,
            };
            (Line::buffered(baud, bits), wire)
        }
    }
}

/// Any settings whose times are longer than the line's own.
fn config(random: &mut Random, priority: Priority, line: Line) -> Config {
    let mut ms = |from: u32, to: u32| u16::try_from(from + random.below(to - from)).unwrap();
    Config {
        qvz_ms: ms(300, 2500),
        zvz_ms: ms(100, 300),
        bwz_ms: ms(1000, 5000),
        buffer_wait_ms: ms(0, 500),
        // In every second script, telegrams are acknowledged when their user takes them.
        acknowledge_wait_ms: ms(100, 1000) * ms(0, 2),
        line,
        max_noise_s: u8::try_from(1 + random.below(10)).unwrap(),
        connection_attempts: u8::try_from(random.below(8)).unwrap(),
        transmission_attempts: u8::try_from(random.below(8)).unwrap(),
        priority,
        check: Check::Bcc, // without it a repeated STX is data to whoever waits for data
        conflict: one_of(
            random,
            &[Conflict::Wait, Conflict::YieldOnRetry, Conflict::Repeat],
        ),
        idle_noise: one_of(
            random,
            &[
                IdleNoise::NakAfterSilence,
                IdleNoise::NakAtOnce,
                IdleNoise::Ignore,
            ],
        ),
        illegal_dle: one_of(
            random,
            &[
                IllegalDle::RejectAtEnd,
                IllegalDle::RejectAtOnce,
                IllegalDle::Accept,
            ],
        ),
        silence_in_block: one_of(
            random,
            &[SilenceInBlock::Idle, SilenceInBlock::ExpectRepeat],
        ),
        allow_empty: true,
        nak_at_startup: random.below(2) == 0,
    }
}

/// Numbered, full of control characters, without ETX: a DLE before it could end the block early.
fn jobs(random: &mut Random, side: u8) -> Vec<Vec<u8>> {
    let job = |number: u32| {
        let len = random.below(LONGEST - 1);
        let mut byte = || match random.below(6) {
            0 => 0x02,
            1 => 0x10,
            2 => 0x15,
            _ => random.byte(),
        };
        let head = [side, 0xC0 + u8::try_from(number).unwrap()];
        let tail = (0..len)
            .map(|_| byte())
            .map(|byte| if byte == 0x03 { 0x04 } else { byte });
        head.into_iter().chain(tail).collect()
    };
    (0..1 + JOBS).map(job).collect()
}

/// Whether a NAK in place of its BCC, from a sender whose user gives up, makes a damaged block whole.
fn is_whole_by_nak(telegram: &[u8]) -> bool {
    let mut block = [0; 2 * LONGEST as usize + 3];
    let len = encode(telegram, Check::Bcc, &mut block).unwrap();
    block[len - 1] == NAK
}

/// What the partner's user has got is what was submitted, in order; `repeats` may follow each
/// other, and what is `given_up` may be damaged where nobody can see it.
fn assert_genuine(
    received: &[Vec<u8>],
    jobs: &[Vec<u8>],
    repeats: bool,
    given_up: bool,
    script: u64,
) {
    let hidden =
        |telegram: &&Vec<u8>| given_up && !jobs.contains(telegram) && is_whole_by_nak(telegram);
    let places: Vec<_> = received
        .iter()
        .filter(|telegram| !hidden(telegram))
        .map(|telegram| jobs.iter().position(|job| job == telegram))
        .collect();
    assert!(
        places.iter().all(Option::is_some),
        "script {script}: forged: {received:02X?} of {jobs:02X?}"
    );
    let ordered = places
        .windows(2)
        .all(|pair| pair[0] < pair[1] || (repeats && pair[0] == pair[1]));
    assert!(ordered, "script {script}: {places:?}");
}

fn play(script: u64, noise: Noise, habits: Habits) -> Tally {
    let mut random = Random::new(script);
    let (line, wire) = line(&mut random);
    let noisy = noise.answers > 0;
    let mut priorities = [Priority::High, Priority::Low];
    priorities.rotate_left(usize::from(random.below(2) == 0));
    let mut configs = priorities.map(|priority| config(&mut random, priority, line));
    // As the manuals want it: STX repeated before the partner has given up would be data.
    configs[1].qvz_ms = configs[0].qvz_ms;
    for config in &mut configs {
        // Whoever falls out of a bad block takes what is left of it for a block of its own.
        if noisy && config.illegal_dle == IllegalDle::RejectAtOnce {
            config.illegal_dle = IllegalDle::RejectAtEnd;
        }
    }
    let jobs = [jobs(&mut random, 0xA0), jobs(&mut random, 0xB0)];
    let mut duel = Duel::new(configs, jobs.clone(), wire, habits, noise, script);
    duel.run();
    let mut all = Tally::default();
    for (side, jobs) in jobs.iter().enumerate() {
        let (end, partner) = (&duel.ends[side], &duel.ends[1 - side]);
        assert_eq!(
            end.tally.sent + end.tally.failed,
            jobs.len(),
            "script {script}"
        );
        assert_genuine(
            &partner.received,
            jobs,
            noisy || habits.cancelled > 0,
            noisy && habits.cancelled > 0,
            script,
        );
        for job in &end.sent {
            assert!(
                partner.received.contains(job),
                "script {script}: {job:02X?} lost: {configs:#?} {wire:?}"
            );
        }
        all.sent += end.tally.sent;
        all.failed += end.tally.failed;
        all.cancelled += end.tally.cancelled;
        all.received += end.received.len();
    }
    all
}

fn play_all(noise: Noise, habits: Habits) -> Tally {
    let (first, count) = (setting("FIRST", 1), setting("SCRIPTS", 3000));
    let mut all = Tally::default();
    for script in first..first + count {
        let tally = play(script, noise, habits);
        all.sent += tally.sent;
        all.failed += tally.failed;
        all.cancelled += tally.cancelled;
        all.received += tally.received;
    }
    println!("{count} scripts: {all:?}");
    all
}

const CLEAN: Noise = Noise {
    spacing: 0,
    answers: 0,
    late: 0,
    late_ms: 1,
    seen: true,
};

const ROUGH: Noise = Noise {
    spacing: SPACING,
    answers: 300,
    late: 60,
    late_ms: 80,
    seen: true,
};

const PROMPT: Habits = Habits {
    pause_ms: 400,
    absent: 0,
    cancelled: 0,
};

const CARELESS: Habits = Habits {
    pause_ms: 400,
    absent: 100,
    cancelled: 100,
};

/// In one of these a block is damaged and then given up at its BCC, which the NAK happens to be.
const WHOLE_BY_NAK: u64 = 3917;

#[test]
fn a_nak_in_place_of_the_bcc_can_make_a_damaged_block_whole() {
    play(WHOLE_BY_NAK, ROUGH, CARELESS);
}

#[test]
fn scripts_on_a_clean_line() {
    let tally = play_all(CLEAN, PROMPT);
    assert_eq!(tally.sent, tally.received);
}

#[test]
fn scripts_with_careless_users() {
    play_all(CLEAN, CARELESS);
}

#[test]
fn scripts_on_a_rough_line() {
    play_all(ROUGH, PROMPT);
}

#[test]
fn scripts_on_a_rough_line_with_careless_users() {
    play_all(ROUGH, CARELESS);
}
