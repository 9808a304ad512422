//! Random rows of a PVT table: every step against the exact cubic, in 256-bit integers.
//!
//! `CUBIC_ROWS=10000000 cargo test --release -p pvt-steps --test it cubic_exact:: -- --nocapture`
//! for a long run.
#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "exact numbers are compared as integers, statistics as floats"
)]

mod axis;
mod exact;
mod rows;

use axis::Axis;
use pvt_steps::{MinIntervals, PvtKnot};
use rows::{any_i64, any_row, any_u64, knot, next_row};
use test_support::{Random, setting};

/// A step, in the unit of positions here.
const STEP: i128 = 1 << 56;

#[derive(Debug, Default)]
struct Statistics {
    rows: u64,
    too_fast: u64,
    too_quick: u64,
    joined_too_quick: u64,
    steps: u64,
    segments: u64,
    /// Steps where only the place can be said.
    by_place: u64,
    due_or_late: u64,
    worst_ticks: f64,
    worst_place: f64,
    joined_segments: u64,
    joined_bytes: u64,
    joined_worst_ticks: f64,
}

impl Statistics {
    fn print(&self) {
        println!("{self:#?}");
        let a_segment = |segments| self.steps as f64 / segments as f64;
        println!("steps a segment: {}", a_segment(self.segments));
        println!(
            "joined: {} steps a segment, {} bytes a step",
            a_segment(self.joined_segments),
            self.joined_bytes as f64 / self.steps as f64
        );
    }
}

/// Axes of 50 rows each: the least intervals and the first knot, and the row after a knot.
fn every_step_is_in_its_place(
    max_steps: usize,
    begin: impl Fn(&mut Random) -> (MinIntervals, PvtKnot),
    row: impl Fn(&mut Random, PvtKnot, MinIntervals) -> (u32, PvtKnot),
) {
    let rows = setting("CUBIC_ROWS", 10_000);
    let mut random = Random::new(setting("CUBIC_SEED", 1));
    let mut seen = Statistics::default();
    while seen.rows < rows {
        let (least, start) = begin(&mut random);
        let mut axis = Axis::new(start, least, max_steps);
        for _ in 0..50 {
            let (ticks, to) = row(&mut random, axis.knot, least);
            // Refused: another one.
            let _ = axis.row(ticks, to, &mut seen);
            if axis.cut {
                break;
            }
        }
        axis.finish(&mut seen);
    }
    seen.print();
    assert!(seen.worst_ticks < 1.0 && seen.joined_worst_ticks < 1.0);
}

#[test]
fn every_step_of_random_rows_is_in_its_place() {
    let begin = |random: &mut Random| {
        let least = MinIntervals {
            step_ticks: [1, 2, 10, 100, 1000][random.below(5) as usize],
            reversal_ticks: [1, 4, 30, 200, 2000][random.below(5) as usize],
        };
        (least, knot(random.within(-1e3, 1e3), 0.0))
    };
    every_step_is_in_its_place(usize::MAX, begin, next_row);
}

#[test]
fn every_step_of_any_rows_is_in_its_place() {
    let begin = |random: &mut Random| {
        let least = MinIntervals {
            step_ticks: any_u64(random),
            reversal_ticks: any_u64(random),
        };
        let start = PvtKnot {
            position: any_i64(random),
            velocity: any_i64(random),
        };
        (least, start)
    };
    every_step_is_in_its_place(2000, begin, any_row);
}
