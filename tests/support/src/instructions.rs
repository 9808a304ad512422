//! Instructions, counted by callgrind: the same on a busy machine as on an idle one.

use std::process::{Command, ExitCode};
use std::{env, eprintln, println};

const CASE: &str = "INSTRUCTIONS_CASE";
const ROUNDS: &str = "INSTRUCTIONS_ROUNDS";

/// A case of a bench, and what it may cost.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Limit<'a> {
    /// Its name, by which it is run.
    pub case: &'a str,
    /// What is counted: `per step`.
    pub unit: &'a str,
    /// Units of a round.
    pub units: f64,
    /// Rounds of two runs, whose difference is the cost of the rounds alone.
    pub rounds: [u32; 2],
    /// The most instructions a unit on x86-64.
    pub most: f64,
}

/// The `main` of a bench: `run` runs a case so many rounds. The bench runs itself under valgrind,
/// twice for each of `limits`; it fails where one costs more, and says so where there is no
/// valgrind.
pub fn bench(run: impl Fn(&str, u32), limits: &[Limit<'_>]) -> ExitCode {
    if let (Ok(case), Ok(rounds)) = (env::var(CASE), env::var(ROUNDS)) {
        run(&case, rounds.parse().unwrap());
        return ExitCode::SUCCESS;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        eprintln!("skipped: there is no valgrind to count instructions with");
        return ExitCode::SUCCESS;
    }
    let judged = limits.iter().filter(|limit| !judge(limit));
    if judged.count() == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Prints the cost of a case; whether it is within the limit.
fn judge(limit: &Limit<'_>) -> bool {
    let [few, many] = limit.rounds;
    let of = |rounds| count(limit.case, rounds);
    let cost = (of(many) - of(few)) / (f64::from(many - few) * limit.units);
    let verdict = if cost <= limit.most { "ok" } else { "TOO MANY" };
    let Limit {
        case, unit, most, ..
    } = limit;
    println!("{case:43} {cost:7.2} instructions {unit}, at most {most:6.1}: {verdict}");
    cost <= *most
}

/// Instructions of a whole run, from callgrind's report.
fn count(case: &str, rounds: u32) -> f64 {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe().unwrap())
        .env(CASE, case)
        .env(ROUNDS, rounds.to_string())
        .output()
        .unwrap();
    let report = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{report}");
    let mut lines = report.lines();
    let collected = lines.find_map(|line| line.split("Collected :").nth(1));
    collected.unwrap().trim().parse().unwrap()
}
