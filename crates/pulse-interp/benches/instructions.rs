//! Instructions per step, counted by callgrind: the same on a busy machine as on an idle one.
//!
//! The bench runs itself under valgrind, twice per case with different numbers of paths; the
//! difference is the cost of the steps alone. It fails when a case costs more than its limit, and
//! says so when there is no valgrind.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a bench fails loudly")]

use core::hint::black_box;
use std::{
    env,
    process::{Command, ExitCode},
};

use pulse_interp::{Arc, Line, Move, Rule, Turn};

const CASE: &str = "PULSE_INTERP_BENCH_CASE";
const ROUNDS: &str = "PULSE_INTERP_BENCH_ROUNDS";

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

/// Instructions of a whole run, from callgrind's report.
fn instructions(case: &str, rounds: u32) -> u64 {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe().unwrap())
        .env(CASE, case)
        .env(ROUNDS, rounds.to_string())
        .output()
        .unwrap();
    let report = String::from_utf8_lossy(&output.stderr).into_owned();
    let collected = report
        .lines()
        .find_map(|line| line.split("Collected :").nth(1));
    collected
        .unwrap_or_else(|| panic!("{report}"))
        .trim()
        .parse()
        .unwrap()
}

#[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
fn per_step(case: &str) -> f64 {
    let (few, many) = (2, 42);
    let difference = instructions(case, many) - instructions(case, few);
    difference as f64 / (f64::from(many - few) * steps(case) as f64)
}

fn main() -> ExitCode {
    if let (Ok(case), Ok(rounds)) = (env::var(CASE), env::var(ROUNDS)) {
        run(&case, rounds.parse().unwrap());
        return ExitCode::SUCCESS;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        eprintln!("skipped: there is no valgrind to count instructions with");
        return ExitCode::SUCCESS;
    }
    let mut code = ExitCode::SUCCESS;
    for (case, limit) in CASES {
        let cost = per_step(case);
        let verdict = if cost <= limit { "ok" } else { "TOO MANY" };
        println!("{case:15} {cost:6.2} instructions per step, at most {limit:4.1}: {verdict}");
        if cost > limit {
            code = ExitCode::FAILURE;
        }
    }
    code
}
