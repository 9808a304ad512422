//! Two stations over a line that loses, flips, doubles, inserts and delays characters.

mod line;

use line::{Faults, Outcome, Pair};
use proptest::prelude::*;
use proto3964r::{
    Check, Config, Conflict, IdleNoise, IllegalDle, Line, Priority, SilenceInBlock,
    frame::{encode, max_encoded_len},
};

use crate::common::{low_side::quiet, random::Random};

/// A generous end for any run: no run here needs half of it.
const HOUR_US: u64 = 3_600_000_000;

/// Jobs that differ from their neighbours, full of control characters.
///
/// `harmless` ones are without 00h, which the XOR does not feel, and without 03h, in front of
/// which one wrong or missing character can end the block early.
fn jobs(seed: u64, count: u8, harmless: bool) -> Vec<Vec<u8>> {
    let mut random = Random::new(seed);
    (1..=count)
        .map(|number| {
            let mut byte = || match random.below(8) {
                0 | 1 => 0x10,
                2 if !harmless => 0x03,
                3 => 0x02,
                4 => 0x15,
                5 if !harmless => 0x00,
                _ => u8::try_from(0x20 + random.below(0xE0)).unwrap(),
            };
            let mut job = vec![number | 0x40];
            job.extend((0..byte() % 24).map(|_| byte()));
            job
        })
        .collect()
}

/// Telegrams in order, with the repeats that a lost acknowledgement makes taken out.
fn without_repeats(received: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let mut telegrams = received.to_vec();
    telegrams.dedup();
    telegrams
}

/// Whether these characters end in a whole block of this payload with the right BCC.
fn ends_in_block(characters: &[u8], payload: &[u8]) -> bool {
    let mut body = vec![0; max_encoded_len(payload.len())];
    let len = encode(payload, Check::Bcc, &mut body).unwrap();
    characters.ends_with(&body[..len])
}

fn configs() -> [Config; 2] {
    [Priority::High, Priority::Low].map(|priority| Config::siemens_3964r(priority, Line::Instant))
}

/// On a clean line nothing is lost, repeated or refused, whoever sends when.
#[test]
fn a_clean_line_carries_everything_once() {
    for seed in 0..20 {
        let work = [jobs(seed, 40, false), jobs(seed + 100, 40, false)];
        // The start-up NAK of one crosses the first STX of the other.
        let mut pair = Pair::new(configs(), work.clone(), Faults::default(), 1146, seed);
        assert!(pair.run(HOUR_US).is_some());
        for side in 0..2 {
            assert_eq!(pair.ends[side].received, work[1 - side]);
            assert_eq!(pair.ends[side].outcomes, vec![Outcome::Sent; 40]);
            assert_eq!(pair.ends[side].same_priority, 0);
        }
    }
}

#[test]
fn the_same_priority_on_both_sides_ends_and_is_reported() {
    for priority in [Priority::High, Priority::Low] {
        let config = quiet(priority, Line::Instant);
        let work = [vec![b"A".to_vec()], vec![b"B".to_vec()]];
        let mut pair = Pair::new([config, config], work, Faults::default(), 1146, 1);
        assert!(pair.run(HOUR_US).is_some());
        assert!(
            pair.ends.iter().any(|end| end.same_priority > 0),
            "{priority:?}"
        );
    }
}

/// The Linux rule resolves what Siemens leaves to clock drift.
#[test]
fn yield_on_retry_resolves_two_high_stations() {
    let config = Config::siemens_3964r(Priority::High, Line::Instant);
    let yielding = Config {
        conflict: Conflict::YieldOnRetry,
        ..config
    };
    let work = [vec![b"A".to_vec()], vec![b"B".to_vec()]];
    let mut pair = Pair::new([config, yielding], work.clone(), Faults::default(), 1146, 1);
    assert!(pair.run(HOUR_US).is_some());
    for side in 0..2 {
        assert_eq!(pair.ends[side].received, work[1 - side]);
    }
}

/// Faults of all kinds, often.
fn rough() -> impl Strategy<Value = Faults> {
    (0..60_u32, 0..60_u32, 0..60_u32, 0..60_u32, 0..60_u32).prop_map(
        |(loss, flip, duplicate, insert, delay)| Faults {
            loss,
            flip,
            duplicate,
            insert,
            delay,
            gentle_gap: None,
        },
    )
}

/// At most one fault in a block, and none that makes an acknowledgement of something else.
fn gentle() -> impl Strategy<Value = Faults> {
    (0..40_u32, 0..40_u32, 0..40_u32, 0..40_u32).prop_map(|(loss, flip, duplicate, insert)| {
        Faults {
            loss,
            flip,
            duplicate,
            insert,
            delay: 0,
            gentle_gap: Some(120),
        }
    })
}

/// Any station that the configuration can make, with short times.
fn any_config(priority: Priority) -> impl Strategy<Value = Config> {
    (
        (150..600_u16, 30..150_u16, 200..2000_u16, 1..5_u8, 1..5_u8),
        prop_oneof![
            Just(IdleNoise::NakAfterSilence),
            Just(IdleNoise::NakAtOnce),
            Just(IdleNoise::Ignore)
        ],
        prop_oneof![
            Just(IllegalDle::RejectAtEnd),
            Just(IllegalDle::RejectAtOnce),
            Just(IllegalDle::Accept)
        ],
        prop_oneof![
            Just(Conflict::Wait),
            Just(Conflict::YieldOnRetry),
            Just(Conflict::Repeat)
        ],
        prop_oneof![
            Just(SilenceInBlock::Idle),
            Just(SilenceInBlock::ExpectRepeat)
        ],
    )
        .prop_map(
            move |((qvz, zvz, bwz, connection, transmission), noise, dle, conflict, silence)| {
                Config {
                    qvz_ms: qvz,
                    zvz_ms: zvz,
                    bwz_ms: bwz,
                    max_noise_s: 1,
                    connection_attempts: connection,
                    transmission_attempts: transmission,
                    idle_noise: noise,
                    illegal_dle: dle,
                    conflict,
                    silence_in_block: silence,
                    ..Config::siemens_3964r(priority, Line::Instant)
                }
            },
        )
}

proptest! {
    /// Whatever the line does, both stations come to rest with every job ended once, and what is
    /// handed to the user was a block with a right BCC on the line.
    #[test]
    fn every_job_ends(faults in rough(), seed in any::<u64>()) {
        let work = [jobs(seed, 12, false), jobs(!seed, 12, false)];
        let mut pair = Pair::new(configs(), work.clone(), faults, 1146, seed);
        prop_assert!(pair.run(HOUR_US).is_some(), "stuck: {pair:?}");
        for side in 0..2 {
            prop_assert_eq!(pair.ends[side].outcomes.len(), 12);
            let end = &pair.ends[side];
            for (telegram, came_in) in end.received.iter().zip(&end.came_in) {
                // A telegram that was not sent: errors that cancel in the XOR, which no BCC sees.
                prop_assert!(work[1 - side].contains(telegram) || ends_in_block(came_in, telegram));
            }
        }
    }

    /// The same for every policy, on both sides independently, and for equal priorities.
    #[test]
    fn every_job_ends_under_every_policy(
        a in any_config(Priority::High),
        b in prop_oneof![any_config(Priority::Low), any_config(Priority::High)],
        swap_to_low in any::<bool>(),
        faults in rough(),
        seed in any::<u64>(),
    ) {
        let priority = if swap_to_low { Priority::Low } else { a.priority };
        let a = Config { priority, ..a };
        let work = [jobs(seed, 6, false), jobs(!seed, 6, false)];
        let mut pair = Pair::new([a, b], work, faults, 1146, seed);
        prop_assert!(pair.run(HOUR_US).is_some(), "stuck: {pair:?}");
        prop_assert!(pair.ends.iter().all(|end| end.outcomes.len() == 6));
    }

    /// With at most one fault in a block of harmless bytes: everything is delivered, in order,
    /// intact; a telegram that is reported sent has arrived; only a lost acknowledgement makes a
    /// repeat.
    #[test]
    fn single_faults_do_no_harm(faults in gentle(), seed in any::<u64>()) {
        let work = [jobs(seed, 12, true), jobs(!seed, 12, true)];
        let mut pair = Pair::new(configs(), work.clone(), faults, 1146, seed);
        prop_assert!(pair.run(HOUR_US).is_some(), "stuck: {pair:?}");
        for side in 0..2 {
            prop_assert_eq!(&pair.ends[1 - side].outcomes, &vec![Outcome::Sent; 12]);
            prop_assert_eq!(&without_repeats(&pair.ends[side].received), &work[1 - side]);
        }
    }
}
