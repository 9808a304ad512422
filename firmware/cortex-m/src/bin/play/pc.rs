//! `play plan FILE` writes the PC's line. `play check TRACE` compares edges, in the order of their
//! joints, with the segments: direction by direction, and tick by tick up to a constant latency.

use std::collections::BTreeMap;
use std::{env, fs};

use cortex_m_firmware::Hash;
use cortex_m_firmware::arm_line::{MAX_BYTES, Planner, Segments, TICK_HZ, plan};
use stepper_sync::Direction;

/// The latest that an edge may come: both joints at once, one after the other, in ticks.
const MAX_LATENCY_TICKS: u32 = 250;
/// With `-icount shift=5`.
const INSTRUCTION_NS: u32 = 1 << 5;

pub fn main() {
    let arguments: Vec<_> = env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["plan", file] => fs::write(file, loaded(&segments(Planner::Pc))).expect("a writable file"),
        ["check", file] => check(&fs::read_to_string(file).expect("a trace")),
        _ => panic!("play plan FILE, or play check TRACE"),
    }
}

/// Each joint's segments as bytes.
fn segments(planner: Planner) -> [Vec<u8>; 2] {
    let mut wire = [[0; MAX_BYTES]; 2];
    let [first, second] = plan(planner, &mut wire);
    let [shoulder, elbow] = wire;
    [shoulder[..first].to_vec(), elbow[..second].to_vec()]
}

/// What the board finds in its memory.
fn loaded(segments: &[Vec<u8>; 2]) -> Vec<u8> {
    let lengths = segments.each_ref().map(|bytes| bytes.len() as u32);
    let lengths = lengths.iter().flat_map(|length| length.to_le_bytes());
    lengths.chain(segments.concat()).collect()
}

/// Sign and ticks since the start of each step.
fn predicted(wire: &[u8]) -> Vec<(char, u32)> {
    let mut ticks = 0;
    let step = |(interval, direction)| {
        ticks += interval;
        let sign = if direction == Direction::Positive {
            '+'
        } else {
            '-'
        };
        (sign, ticks)
    };
    Segments::decoded(wire).steps().map(step).collect()
}

fn check(trace: &str) {
    let mut played: BTreeMap<(&str, usize), Vec<(char, u32)>> = BTreeMap::new();
    let mut planning_ticks = 0;
    for line in trace.lines() {
        match line.split(' ').collect::<Vec<_>>()[..] {
            [who, joint, sign, ticks] => played
                .entry((who, joint.parse().expect("a joint")))
                .or_default()
                .push((sign.parse().expect("a sign"), ticks.parse().expect("ticks"))),
            ["planned", ticks, hash] => {
                planning_ticks = ticks.parse().expect("ticks");
                let mut own = Hash::default();
                let segments = segments(Planner::Board).concat();
                segments.iter().for_each(|&byte| own.add(byte.into()));
                assert_eq!(hash, own.value().to_string(), "the board's segments");
            }
            _ => panic!("not a line of a trace: {line}"),
        }
    }
    for (who, planner) in [("pc", Planner::Pc), ("board", Planner::Board)] {
        let segments = segments(planner);
        let mut latencies = Vec::new();
        for (joint, wire) in segments.iter().enumerate() {
            let (wanted, found) = (predicted(wire), &played[&(who, joint)]);
            assert_eq!(found.len(), wanted.len(), "steps of joint {joint}, {who}");
            for (number, (wanted, found)) in wanted.iter().zip(found).enumerate() {
                let place = format!("step {number} of joint {joint}, {who}");
                assert_eq!(found.0, wanted.0, "{place}: direction");
                let latency = found.1.checked_sub(wanted.1);
                let latency = latency.unwrap_or_else(|| panic!("{place}: too early"));
                assert!(
                    latency <= MAX_LATENCY_TICKS,
                    "{place}: {latency} ticks late"
                );
                latencies.push(latency);
            }
        }
        latencies.sort_unstable();
        let at = |share: usize| instructions(latencies[(latencies.len() - 1) * share / 100]);
        println!(
            "{who};line;{};{};{};{};{}",
            latencies.len(),
            segments.concat().len(),
            at(0),
            at(50),
            at(100),
        );
    }
    println!("planning;board;{}", instructions(planning_ticks));
}

fn instructions(ticks: u32) -> u32 {
    let ns = u64::from(ticks) * (1_000_000_000 / u64::from(TICK_HZ));
    (ns / u64::from(INSTRUCTION_NS)) as u32
}
