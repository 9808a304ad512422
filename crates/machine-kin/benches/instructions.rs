//! Instructions of what a planner asks of a segment, counted by callgrind: the arms' own proofs
//! beside those that follow from their inverses alone, and of a whole plan.
#![expect(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a bench stops at once"
)]

#[path = "../tests/it/common/arms.rs"]
mod arms;

use core::fmt::Debug;
use core::hint::black_box;
use std::process::ExitCode;

use delta_kin::{Delta, DeltaPath, Dimensions};
use machine_kin::path_timing::{Accuracy, AxisLimits, Curve, Knot, Path, Span, Table};
use machine_kin::{Elbow, Machine, MachinePath};
use scara_kin::{Arm, ArmPath};
use test_support::instructions::{Limit, bench};

use arms::{RotaryDelta, TwoLinks};

/// The segments of a path that keep a hundredth of a millimetre.
fn spans<P: Path<Axes = [f64; N]>, const N: usize>(
    path: &P,
    departure: impl Fn(&&P, &Span<[f64; N]>) -> f64,
) -> Vec<Span<[f64; N]>>
where
    P::Error: Debug,
{
    let joint = AxisLimits {
        speed: 6.0,
        acceleration: 100.0,
        jerk: None,
    };
    let accuracy = Accuracy {
        min_segments: 8,
        max_departure: 0.01,
        max_time_ratio: f64::INFINITY,
    };
    let mut knots = vec![Knot::default(); 1000];
    let table = Table::plan_within([path], [joint; N], accuracy, departure, &mut knots);
    table.expect("it can be planned").spans().collect()
}

/// Asks for all segments' check, or bound, so many times, or plans a path anew; how many segments
/// it has.
fn ask<P: Path<Axes = [f64; N]>, const N: usize>(
    path: impl Fn() -> P,
    departure: impl Fn(&P, &Span<[f64; N]>) -> f64,
    what: What,
    rounds: u32,
) -> usize
where
    P::Error: Debug,
{
    let planned = |path: &P| spans(path, |path, span| departure(path, span));
    let kept = path();
    let spans = planned(&kept);
    for _ in 0..rounds {
        if matches!(what, What::Plan) {
            drop(black_box(planned(&path())));
            continue;
        }
        for span in &spans {
            match what {
                What::Check => drop(black_box(kept.check(black_box(span)))),
                _ => drop(black_box(departure(&kept, black_box(span)))),
            }
        }
    }
    spans.len()
}

#[derive(Clone, Copy)]
enum What {
    Check,
    Bound,
    /// The path made and planned.
    Plan,
}

/// By hand, or from the inverse alone.
#[derive(Clone, Copy)]
enum By {
    Hand,
    Inverse,
}

fn arm(curve: Curve<2>, by: By, what: What, rounds: u32) -> usize {
    let curve = black_box(curve);
    match by {
        By::Hand => {
            let arm = Arm::new(132.0, 132.0).expect("lengths");
            let path = || arm.path(curve, scara_kin::Elbow::Right).expect("a path");
            ask(path, ArmPath::departure, what, rounds)
        }
        By::Inverse => {
            let machine = TwoLinks {
                upper: 132.0,
                fore: 132.0,
                base: [0.0; 3],
            };
            let path = || machine.path(curve, Elbow::Right).expect("a path");
            ask(path, MachinePath::departure, what, rounds)
        }
    }
}

fn delta(curve: Curve<3>, by: By, what: What, rounds: u32) -> usize {
    let curve = black_box(curve);
    match by {
        By::Hand => {
            let delta = Delta::new(Dimensions {
                base: 42.0,
                platform: 18.0,
                upper: 120.0,
                lower: 243.0,
            })
            .expect("lengths");
            let path = || delta.path(curve).expect("a path");
            ask(path, DeltaPath::departure, what, rounds)
        }
        By::Inverse => {
            let machine = RotaryDelta {
                radius: 24.0,
                upper: 120.0,
                lower: 243.0,
                zero: 0.0,
            };
            let path = || machine.path(curve, ()).expect("a path");
            ask(path, MachinePath::departure, what, rounds)
        }
    }
}

/// A case: path, by hand or not, check or bound, and the most instructions for a segment.
const CASES: [(&str, f64); 30] = [
    ("arm, line, plan by hand", 12_000.0),
    ("arm, line, plan", 80_000.0),
    ("arm, line, check by hand", 140.0),
    ("arm, line, check", 5700.0),
    ("arm, line, bound by hand", 4000.0),
    ("arm, line, bound", 21_500.0),
    ("arm, arc, plan by hand", 48_000.0),
    ("arm, arc, plan", 113_000.0),
    ("arm, arc, check by hand", 140.0),
    ("arm, arc, check", 7800.0),
    ("arm, arc, bound by hand", 6300.0),
    ("arm, arc, bound", 24_000.0),
    ("arm, curve, plan by hand", 21_500.0),
    ("arm, curve, plan", 150_000.0),
    ("arm, curve, check by hand", 140.0),
    ("arm, curve, check", 10_900.0),
    ("arm, curve, bound by hand", 4600.0),
    ("arm, curve, bound", 25_600.0),
    ("Delta, line, plan by hand", 22_500.0),
    ("Delta, line, plan", 172_000.0),
    ("Delta, line, check by hand", 160.0),
    ("Delta, line, check", 11_800.0),
    ("Delta, line, bound by hand", 8500.0),
    ("Delta, line, bound", 53_500.0),
    ("Delta, arc, plan by hand", 93_000.0),
    ("Delta, arc, plan", 250_000.0),
    ("Delta, arc, check by hand", 160.0),
    ("Delta, arc, check", 12_800.0),
    ("Delta, arc, bound by hand", 21_000.0),
    ("Delta, arc, bound", 55_500.0),
];

/// Runs a case; the number of its segments.
fn run(case: &str, rounds: u32) -> usize {
    let by = if case.ends_with("by hand") {
        By::Hand
    } else {
        By::Inverse
    };
    let what = match case {
        _ if case.contains("check") => What::Check,
        _ if case.contains("bound") => What::Bound,
        _ => What::Plan,
    };
    let flat = match case {
        _ if case.starts_with("arm, line") => Curve::line([-80.0, 100.0], [80.0, 100.0]),
        _ if case.starts_with("arm, arc") => {
            Curve::arc([180.0, 0.0], [130.0, 0.0], [0.0, 1.0], 3.0)
        }
        _ => Curve::bezier([
            [-100.0, 100.0],
            [-50.0, 220.0],
            [60.0, 60.0],
            [120.0, 150.0],
        ]),
    };
    if case.starts_with("arm") {
        return arm(flat.expect("a curve"), by, what, rounds);
    }
    let curve = if case.starts_with("Delta, line") {
        Curve::line([50.0, 50.0, -300.0], [-50.0, 50.0, -280.0])
    } else {
        let centre = [0.0, 0.0, -260.0];
        Curve::arc([60.0, 0.0, -260.0], centre, [0.0, 1.0, 0.0], 3.0)
    };
    delta(curve.expect("a curve"), by, what, rounds)
}

fn main() -> ExitCode {
    let limits = CASES.map(|(case, most)| Limit {
        case,
        unit: "per segment",
        units: f64::from(u32::try_from(run(case, 0)).unwrap()),
        rounds: [1, 3],
        most,
    });
    let run = |case: &str, rounds| {
        run(case, rounds);
    };
    bench(run, &limits)
}
