//! Any characters at any time on both sides of a line, in front of the monitor and the diagnosis.
#![no_main]

use std::time::Duration;

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use monitor3964r::{Character, Observation, Observations, Side, diagnose};
use proto3964r::Check;
use proto3964r::frame::{encode, max_encoded_len};

/// Longest payload that is kept.
const LONGEST: usize = 24;
/// The most that one character means.
const MOST_OBSERVATIONS: usize = 6;

type Monitor = monitor3964r::Monitor<LONGEST>;

fuzz_target!(|data: &[u8]| {
    let _ = run(&mut Unstructured::new(data));
});

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let config = pose2pulse_fuzz::config(u, 0)?;
    let mut monitor = Monitor::new(config);
    let mut now = Duration::ZERO;
    let mut spoken = [Vec::new(), Vec::new()];
    let mut record = Vec::new();
    while !u.is_empty() {
        let event: u8 = u.arbitrary()?;
        let side = if event & 1 == 0 { Side::A } else { Side::B };
        let byte = match event >> 5 {
            0 => 0x02,
            1 => 0x03,
            2 | 3 => 0x10,
            4 => 0x15,
            _ => u.arbitrary()?,
        };
        let mut hear = |at, error| {
            record.push(Character {
                at,
                side,
                byte,
                error,
            });
        };
        let heard = &mut spoken[usize::from(event & 1)];
        match event >> 1 & 15 {
            0 => {
                now += Duration::from_millis(u.int_in_range(0..=6000)?);
                for observation in monitor.handle_timeout(now) {
                    let _ = observation.to_string();
                }
                comes_to_rest(&mut monitor, now);
            }
            1 => {
                heard.push(byte);
                let error = pose2pulse_fuzz::line_error(u)?;
                hear(now, Some(error));
                check(
                    monitor.handle_damaged(now, side, byte, error),
                    &spoken,
                    config.check,
                );
            }
            step => {
                now += Duration::from_millis(u64::from(step / 4));
                heard.push(byte);
                hear(now, None);
                check(monitor.handle_byte(now, side, byte), &spoken, config.check);
            }
        }
    }
    assert!(!diagnose(&record, &config).to_string().is_empty());
    if let Some(due) = monitor.poll_timeout() {
        let due = due.max(now);
        monitor.handle_timeout(due).for_each(drop);
        comes_to_rest(&mut monitor, due);
    }
    Ok(())
}

/// What was due has been reported, and is so once.
fn comes_to_rest(monitor: &mut Monitor, now: Duration) {
    assert!(monitor.poll_timeout().is_none_or(|due| due > now));
    assert_eq!(monitor.handle_timeout(now).count(), 0);
}

/// The count is as foretold, and a payload is what the side has said last.
fn check(observations: Observations<'_>, spoken: &[Vec<u8>; 2], check: Check) {
    let (least, most) = observations.size_hint();
    assert!(Some(least) == most && least <= MOST_OBSERVATIONS);
    let mut count = 0;
    for observation in observations {
        count += 1;
        assert!(!observation.to_string().is_empty());
        if let Observation::Block { by, payload } = observation {
            let mut body = [0; max_encoded_len(LONGEST)];
            let len = encode(payload, check, &mut body).expect("the buffer is long enough");
            assert!(spoken[usize::from(by == Side::B)].ends_with(&body[..len]));
        }
    }
    assert_eq!(count, least);
}
