//! The board's edges against what was sent, and against the line.

use std::f64::consts::TAU;
use std::fmt::Write;

use cortex_m_firmware::arm_line::{
    END_MM, JOINT, LEAST, START_MM, STEPS_PER_TURN, TICK_HZ, arm, path,
};
use cortex_m_firmware::stream::{Batch, Joints};
use path_timing::Path;
use scara_kin::Joints as Angles;
use stepper_sync::Direction;

use super::Result;

/// The latest that an edge may come: the next step of its joint may be due then, and the timer
/// would not have been told of the one after it.
const MAX_LATENCY_TICKS: u64 = LEAST.step_ticks;
/// Each joint is within half a step of the path, both links in a row; that far from the line is the
/// tool, and 1 um for the cubics between rows.
const TOLERANCE_MM: f64 = 0.75 * 264.0 * TAU / STEPS_PER_TURN + 0.001;
/// Speeds near a rest are those between two steps, half a step and one and a half away from it.
const SPEED_MARGIN: f64 = 1.2;
/// Steps before a rest whose speeds are looked at.
const LAST_STEPS: usize = 50;
/// The trace has 31 bits of the clock.
const CLOCK_MASK: u64 = u32::MAX as u64 >> 1;

/// A step: when, and 1 or -1.
type Step = (u64, i32);

/// What the board says.
#[derive(Default)]
struct Trace {
    zero: u64,
    /// Plan and clock ticks of each start from rest.
    starts: Vec<[u64; 2]>,
    steps: Joints<Vec<Step>>,
}

impl Trace {
    fn parse(text: &str) -> Result<Self> {
        let mut trace = Self::default();
        for line in text.lines() {
            match line.split(' ').collect::<Vec<_>>()[..] {
                ["clock", zero] => trace.zero = zero.parse()?,
                ["start", plan, clock] => trace.starts.push([plan.parse()?, clock.parse()?]),
                ["step", joint, sign, clock] => {
                    let steps = &mut trace.steps[joint.parse::<usize>()?];
                    let before = steps.last().map_or(0, |step| step.0);
                    // It counts down, and wraps.
                    let now = trace.zero.wrapping_sub(clock.parse()?) & CLOCK_MASK;
                    let since = now.wrapping_sub(before) & CLOCK_MASK;
                    let sign = if sign == "+" { 1 } else { -1 };
                    steps.push((before + since, sign));
                }
                _ => return Err(format!("not a line of a trace: {line}").into()),
            }
        }
        Ok(trace)
    }
}

/// What was played, from rest to rest: the ticks of the plan at its start, and the steps.
struct Motion {
    begin: u64,
    steps: Joints<Vec<Step>>,
}

fn motions(mut record: &[u8]) -> Result<(usize, Vec<Motion>)> {
    let (mut batches, mut motions) = (0, Vec::new());
    let mut last = [0; 2];
    while let Some((&rests, rest)) = record.split_first() {
        let (len, rest) = rest.split_first_chunk().ok_or("the record is cut off")?;
        let (bytes, rest) = rest.split_at(u32::from_le_bytes(*len) as usize);
        record = rest;
        let batch = Batch::decode(bytes).map_err(|error| format!("{error:?}"))?;
        batches += 1;
        if batch.head.from_rest {
            motions.push(Motion {
                begin: batch.head.ticks[0],
                steps: [Vec::new(), Vec::new()],
            });
        }
        let motion = motions.last_mut().ok_or("it does not begin at rest")?;
        for joint in 0..2 {
            let tail = (rests == 1).then(|| batch.tail[joint].steps());
            for (ticks, direction) in batch.steps[joint].steps().chain(tail.into_iter().flatten()) {
                last[joint] += ticks;
                let sign = if direction == Direction::Positive {
                    1
                } else {
                    -1
                };
                motion.steps[joint].push((last[joint], sign));
            }
        }
    }
    Ok((batches, motions))
}

pub fn check(record: &[u8], trace: &str) -> Result<String> {
    let (batches, motions) = motions(record)?;
    let trace = Trace::parse(trace)?;
    assert_eq!(trace.starts.len(), motions.len(), "starts from rest");
    let mut latencies = Vec::new();
    for joint in 0..2 {
        let mut found = trace.steps[joint].iter();
        for (motion, start) in motions.iter().zip(&trace.starts) {
            assert_eq!(motion.begin, start[0], "where a motion begins");
            for (number, &(ticks, sign)) in motion.steps[joint].iter().enumerate() {
                let place = format!(
                    "joint {joint}, step {number} from plan tick {}",
                    motion.begin
                );
                let &(clock, found) = found
                    .next()
                    .unwrap_or_else(|| panic!("{place}: is missing"));
                assert_eq!(found, sign, "{place}: direction");
                let latency = clock.checked_sub(start[1] + ticks - start[0]);
                let latency = latency.unwrap_or_else(|| panic!("{place}: too early"));
                assert!(
                    latency <= MAX_LATENCY_TICKS,
                    "{place}: {latency} ticks late"
                );
                latencies.push(latency);
            }
            brakes(&motion.steps[joint]);
        }
        assert_eq!(
            found.next(),
            None,
            "steps of joint {joint} that nobody has sent"
        );
    }
    on_line(&trace.steps);
    let mut summary = String::new();
    write!(
        summary,
        "{} steps in {batches} batches, {} rests on the way; at most {} ticks late",
        latencies.len(),
        motions.len() - 1,
        latencies.iter().max().unwrap_or(&0)
    )?;
    Ok(summary)
}

/// Towards a rest a joint is no faster than it can brake.
fn brakes(steps: &[Step]) {
    let acceleration = JOINT.acceleration / TAU * STEPS_PER_TURN;
    for (left, pair) in steps.windows(2).rev().take(LAST_STEPS).enumerate() {
        let speed = f64::from(TICK_HZ) / (pair[1].0 - pair[0].0) as f64;
        let max = (2.0 * acceleration * (left as f64 + 2.0)).sqrt() * SPEED_MARGIN;
        assert!(speed <= max, "{speed} steps/s, {left} steps before a rest");
    }
}

/// The tool is on the line after each step, and at its end after the last.
fn on_line(steps: &Joints<Vec<Step>>) {
    let scale = STEPS_PER_TURN / TAU;
    let path = path();
    let at = |s| path.point(s).expect("on the line").position;
    let whole = |joints: [f64; 2]| joints.map(|angle| (angle * scale).round() as i32);
    let mut now = whole(at(0.0));
    let joint = |joint: usize| {
        steps[joint]
            .iter()
            .map(move |&(ticks, sign)| (ticks, joint, sign))
    };
    let mut all: Vec<_> = joint(0).chain(joint(1)).collect();
    all.sort_unstable();
    let way = [END_MM[0] - START_MM[0], END_MM[1] - START_MM[1]];
    for (ticks, joint, sign) in all {
        now[joint] += sign;
        let [shoulder, elbow] = now.map(|steps| f64::from(steps) / scale);
        let tool = arm().forward(Angles::new(shoulder, elbow));
        let (dx, dy) = (tool.x - START_MM[0], tool.y - START_MM[1]);
        let off = (dx * way[1] - dy * way[0]).abs() / way[0].hypot(way[1]);
        assert!(off <= TOLERANCE_MM, "{off} mm off the line at tick {ticks}");
    }
    assert_eq!(now, whole(at(path.length())), "the end");
}
