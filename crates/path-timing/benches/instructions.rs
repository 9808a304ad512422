//! Instructions per point of a dense file, counted by callgrind: smoothing, look-ahead, rows.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a bench fails loudly")]

use core::hint::black_box;
use std::process::ExitCode;

use path_timing::{AxisLimits, Knot, LookAhead, Smoothed, Vertex};
use test_support::instructions::{Limit, bench};

/// Points of a circle of 40 mm so far apart, in mm, and the most instructions for each.
const CASES: [(&str, f64, f64); 6] = [
    ("0.05 mm apart", 0.05, 1500.0),
    ("0.1 mm apart", 0.1, 2000.0),
    ("0.2 mm apart", 0.2, 3000.0),
    ("0.5 mm apart", 0.5, 9000.0),
    ("1 mm apart", 1.0, 10_000.0),
    ("2 mm apart", 2.0, 14_000.0),
];
const POINTS: u32 = 2000;

const AXIS: AxisLimits = AxisLimits {
    speed: 300.0,
    acceleration: 3000.0,
    jerk: None,
};

fn run(case: &str, rounds: u32) {
    let step_mm = CASES.iter().find(|(name, ..)| *name == case);
    let (_, step_mm, _) = step_mm.unwrap_or_else(|| panic!("no case {case}"));
    let points: Vec<[f64; 2]> = (0..POINTS)
        .scan(0.0_f64, |angle, _| {
            *angle += step_mm / 40.0;
            let (sin, cos) = angle.sin_cos();
            Some([cos, sin].map(|x| (x * 40_000.0).round() / 1000.0))
        })
        .collect();
    for _ in 0..rounds {
        let (mut vertices, mut window) = ([Vertex::default(); 24], [Knot::default(); 64]);
        let points = black_box(&points).iter().copied();
        let curves = Smoothed::new(points, 0.01, &mut vertices).unwrap();
        let curves = curves.map(Result::unwrap);
        let rows = LookAhead::new(curves, [AXIS; 2], |_| Ok(1), &mut window).unwrap();
        black_box(rows.last());
    }
}

fn main() -> ExitCode {
    let limits = CASES.map(|(case, _, most)| Limit {
        case,
        unit: "per point",
        units: f64::from(POINTS),
        rounds: [1, 4],
        most,
    });
    bench(run, &limits)
}
