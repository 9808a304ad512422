//! From a curve of the tool to the last edge: a two-link arm and a rotary Delta at 72 MHz.
//!
//! What a user calls, on one core: the path of a curve, which is looked at whole, `plan_within`,
//! rows and edges. Steps a second, the best of several rounds, and instructions a step by
//! callgrind, for which the bench runs itself under valgrind where there is one; with `--times` the
//! steps alone, for `klipper/run`. The curves are lines of 100 to 190 mm from rest to rest at 300
//! mm/s, 0.01 mm off at most.

use core::hint::black_box;
use std::env;
use std::process::Command;
use std::time::Instant;

use delta_kin::{Delta, DeltaPath};
use path_timing::{Accuracy, AxisLimits, Curve, Knot, Path, Row, Span, Table, ToolLimits};
use pvt_steps::{AxisSegments, PvtKnot, PvtQuantiser, PvtSteps, SegmentPlayer};
use scara_kin::{Arm, ArmPath, Elbow};
use stepper_sync::{Rate, StepDirTiming, StepScale};

const CASE: &str = "PIPELINE_CASE";
const ROUNDS: &str = "PIPELINE_ROUNDS";

/// That of the READMEs.
const ACCURACY: Accuracy = Accuracy {
    min_segments: 8,
    max_departure: 0.01,
    max_time_ratio: f64::INFINITY,
};
const TOOL: ToolLimits = ToolLimits {
    feed: 300.0,
    acceleration: Some(5000.0),
};

/// Steps of a turn: of an arm's joint by fine and coarse microsteps, of a Delta's of 16 and of full
/// steps through 27:1.
const ARM_STEPS: [f64; 2] = [32_000.0, 3200.0];
const DELTA_STEPS: [f64; 2] = [86_400.0, 5400.0];

/// Of a joint, in rad and s.
const LIMITS: AxisLimits = AxisLimits {
    speed: 4.0,
    acceleration: 60.0,
    jerk: None,
};

/// How the edges come out.
#[derive(Clone, Copy)]
enum Edges {
    /// All axes in time order.
    Merged,
    /// Each axis for its own timer.
    EachAxis,
}

/// Takes rows, counts steps.
struct Emitter<const N: usize> {
    rows: PvtQuantiser<N>,
    merged: PvtSteps<N>,
    axes: [AxisSegments; N],
    players: [SegmentPlayer; N],
    edges: Edges,
    steps: u64,
    /// So that nothing is left out.
    ticks: u64,
}

impl<const N: usize> Emitter<N> {
    fn new(start: [f64; N], case: Case) -> Self {
        let rate = Rate::from_hz(72_000_000).expect("not zero");
        let scale = StepScale::new(case.steps_per_turn / core::f64::consts::TAU).expect("in range");
        let rows = PvtQuantiser::new(rate, [scale; N], start).expect("in range");
        let least = StepDirTiming::DRV8825.min_intervals(rate);
        Self {
            merged: PvtSteps::new(rows.knots(), least),
            axes: rows
                .knots()
                .map(|knot: PvtKnot| AxisSegments::new(knot, least)),
            players: [const { SegmentPlayer::new() }; N],
            rows,
            edges: case.edges,
            steps: 0,
            ticks: 0,
        }
    }

    fn row(&mut self, row: &Row<[f64; N]>) {
        let row = self.rows.row(row.time_s, row.position, row.velocity);
        let row = row.expect("slow enough");
        match self.edges {
            Edges::Merged => {
                self.merged.push(&row).expect("slow enough");
                for step in &mut self.merged {
                    self.steps += 1;
                    self.ticks ^= step.ticks;
                }
            }
            Edges::EachAxis => {
                let axes = self.axes.iter_mut().zip(&mut self.players);
                for ((axis, player), knot) in axes.zip(row.knots) {
                    axis.push(row.ticks, knot).expect("slow enough");
                    for segment in axis.by_ref() {
                        self.steps += u64::from(segment.count());
                        self.ticks += player.load(&segment);
                        for interval in player.by_ref() {
                            self.ticks += u64::from(interval);
                        }
                    }
                }
            }
        }
    }
}

/// What came of some lines.
#[derive(Clone, Copy, Default)]
struct Made {
    steps: u64,
    segments: usize,
    /// Of the motion.
    duration_s: f64,
}

impl Made {
    fn plus(self, other: Self) -> Self {
        Self {
            steps: self.steps + other.steps,
            segments: self.segments + other.segments,
            duration_s: self.duration_s + other.duration_s,
        }
    }
}

/// Plans a path and makes its edges.
fn run<
    P: Path<Axes = [f64; N], Error: core::fmt::Debug> + Clone + core::fmt::Debug,
    const N: usize,
>(
    path: P,
    departure: fn(&P, &Span<[f64; N]>) -> f64,
    case: Case,
    knots: &mut [Knot<[f64; N]>],
) -> Made {
    let limits = [LIMITS; N];
    let table = Table::plan_within([path], limits, case.accuracy, departure, knots);
    let table = table.expect("within limits");
    let mut rows = table.rows();
    let start = rows.next().expect("a row");
    let mut emitter = Emitter::new(start.position, case);
    for row in rows {
        emitter.row(&row);
    }
    black_box(emitter.ticks);
    Made {
        steps: emitter.steps,
        segments: table.len() - 1,
        duration_s: table.duration_s(),
    }
}

fn arm_lines() -> Vec<Curve<2>> {
    let ends = (0..12_u32).map(|k| {
        let k = f64::from(k);
        [[-90.0 + 4.0 * k, 90.0 + 9.0 * k], [95.0, 190.0 - 9.0 * k]]
    });
    ends.map(|[from, to]| Curve::line(from, to).expect("a line").with_tool(TOOL))
        .collect()
}

fn delta_lines() -> Vec<Curve<3>> {
    let lines = (0..12_u32).map(|k| {
        let k = f64::from(k);
        let from = [-80.0 + 3.0 * k, -40.0 + 5.0 * k, -260.0];
        let to = [80.0, 40.0 - 5.0 * k, -285.0 + 2.0 * k];
        Curve::line(from, to).expect("a line").with_tool(TOOL)
    });
    lines.collect()
}

/// The machines, and the memory for their knots.
struct Machines {
    arm: Arm,
    delta: Delta,
    arm_knots: Vec<Knot<[f64; 2]>>,
    delta_knots: Vec<Knot<[f64; 3]>>,
    arm_lines: Vec<Curve<2>>,
    delta_lines: Vec<Curve<3>>,
}

impl Machines {
    fn new() -> Self {
        Self {
            arm: pose2pulse_bench::arm(),
            delta: pose2pulse_bench::delta(),
            arm_knots: vec![Knot::default(); 400],
            delta_knots: vec![Knot::default(); 400],
            arm_lines: arm_lines(),
            delta_lines: delta_lines(),
        }
    }

    /// All lines of a machine.
    fn run(&mut self, case: Case) -> Made {
        let mut made = Made::default();
        if case.is_arm {
            for line in &self.arm_lines {
                let path = black_box(&self.arm).path(black_box(*line), Elbow::Right);
                let path = path.expect("in reach");
                made = made.plus(run(path, ArmPath::departure, case, &mut self.arm_knots));
            }
        } else {
            for line in &self.delta_lines {
                let path = black_box(&self.delta).path(black_box(*line));
                let path = path.expect("in reach");
                made = made.plus(run(path, DeltaPath::departure, case, &mut self.delta_knots));
            }
        }
        made
    }
}

/// What is run.
#[derive(Clone, Copy)]
struct Case {
    is_arm: bool,
    steps_per_turn: f64,
    edges: Edges,
    accuracy: Accuracy,
}

fn cases() -> impl Iterator<Item = (String, Case)> {
    let machines = [("arm", true, ARM_STEPS), ("delta", false, DELTA_STEPS)];
    let fine = machines.into_iter().flat_map(|(name, is_arm, steps)| {
        steps.map(|steps_per_turn| (name, is_arm, steps_per_turn))
    });
    fine.flat_map(|(name, is_arm, steps_per_turn)| {
        [
            ("in time order", Edges::Merged),
            ("each axis", Edges::EachAxis),
        ]
        .map(|(how, edges)| {
            let case = Case {
                is_arm,
                steps_per_turn,
                edges,
                accuracy: ACCURACY,
            };
            (
                format!("{name}, {steps_per_turn} steps a turn, {how}"),
                case,
            )
        })
    })
}

/// What a case makes in a round, and the seconds of the fastest of some rounds.
fn rounds(case: Case, rounds: u32) -> (Made, f64) {
    let mut machines = Machines::new();
    let (mut made, mut fastest_s) = (Made::default(), f64::INFINITY);
    for _ in 0..rounds {
        let start = Instant::now();
        made = machines.run(case);
        fastest_s = fastest_s.min(start.elapsed().as_secs_f64());
    }
    (made, fastest_s)
}

/// Instructions of a whole run, from callgrind's report.
fn instructions(case: &str, count: u32) -> Option<f64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe().ok()?)
        .env(CASE, case)
        .env(ROUNDS, count.to_string())
        .output()
        .ok()?;
    let report = String::from_utf8_lossy(&output.stderr).into_owned();
    let collected = report
        .lines()
        .find_map(|line| line.split("Collected :").nth(1))?;
    collected.trim().parse().ok()
}

fn main() {
    if let (Ok(name), Ok(count)) = (env::var(CASE), env::var(ROUNDS)) {
        let (_, case) = cases().find(|it| it.0 == name).expect("a case");
        rounds(case, count.parse().expect("a number"));
        return;
    }
    let only_times = env::args().any(|argument| argument == "--times");
    const FEW: u32 = 2;
    const MANY: u32 = 12;
    for (name, case) in cases() {
        let (made, fastest_s) = rounds(case, 30);
        let steps = made.steps as f64;
        let millions = steps / fastest_s / 1e6;
        if only_times {
            println!("{name};{millions}");
            continue;
        }
        let a_segment = steps / made.segments as f64;
        let counted = instructions(&name, MANY).zip(instructions(&name, FEW));
        let counted = counted.map_or("no valgrind".to_owned(), |(many, few)| {
            let a_step = (many - few) / f64::from(MANY - FEW) / steps;
            format!("{a_step:.0} instructions a step")
        });
        let finest = Case {
            accuracy: Accuracy {
                min_segments: 399,
                ..ACCURACY
            },
            ..case
        };
        let slower = made.duration_s / Machines::new().run(finest).duration_s;
        println!(
            "{name}: {millions:.0} million steps/s, {counted}, {a_segment:.0} a segment, \
             {slower:.4} of the time of 399 segments"
        );
    }
}
