//! Instructions per step, counted by callgrind.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a bench fails loudly")]

use core::hint::black_box;
use std::process::ExitCode;

use pulse_interp::{Arc, Line, Move, Rule, Turn};
use test_support::instructions::{Limit, bench};

/// Name, and the most instructions per step on x86-64, the sum over the steps included.
const CASES: [(&str, f64); 6] = [
    ("line, published", 13.5),
    ("line, nearest", 13.5),
    ("line, bresenham", 13.5),
    ("arc, published", 13.5),
    ("arc, nearest", 13.5),
    ("arc, midpoint", 15.0),
];

/// One by one, as an interrupt or a `for` loop takes them.
fn sum(steps: impl Iterator<Item = Move>) -> u32 {
    let mut sum = 0_u32;
    for step in steps {
        sum = sum.wrapping_add(step as u32);
    }
    sum
}

/// Steps of one path.
fn steps(case: &str) -> u64 {
    match case {
        "line, bresenham" => line().moves().remaining(),
        "arc, midpoint" => circle().moves().remaining(),
        line_case if line_case.starts_with("line") => line().steps(Rule::Published).remaining(),
        _ => circle().steps(Rule::Published).remaining(),
    }
}

fn line() -> Line {
    Line::new(black_box([6180, -3820])).unwrap()
}

fn circle() -> Arc {
    Arc::new(black_box([1250, 0]), [1250, 0], Turn::CounterClockwise).unwrap()
}

fn run(case: &str, rounds: u32) {
    for _ in 0..rounds {
        let sum = match case {
            "line, published" => sum(black_box(line().steps(Rule::Published))),
            "line, nearest" => sum(black_box(line().steps(Rule::Nearest))),
            "line, bresenham" => sum(black_box(line().moves())),
            "arc, published" => sum(black_box(circle().steps(Rule::Published))),
            "arc, nearest" => sum(black_box(circle().steps(Rule::Nearest))),
            "arc, midpoint" => sum(black_box(circle().moves())),
            other => panic!("no case {other}"),
        };
        black_box(sum);
    }
}

fn main() -> ExitCode {
    #[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
    let limits = CASES.map(|(case, most)| Limit {
        case,
        unit: "per step",
        units: steps(case) as f64,
        rounds: [2, 42],
        most,
    });
    bench(run, &limits)
}
