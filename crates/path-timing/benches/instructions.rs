//! Instructions per point of a dense file, counted by callgrind: smoothing, look-ahead, rows; for
//! arms also the path of the joints, and as many segments as keep the departure's proven bound. And
//! per row and impulse of a shaped motion.
#![expect(clippy::unwrap_used, reason = "a bench fails loudly")]

use core::hint::black_box;
use std::process::ExitCode;

use delta_kin::{Delta, DeltaPath, Dimensions};
use path_timing::{
    AxisLimits, Curve, Knot, LookAhead, Mode, Path, Row, Shaped, Shaper, Smoothed, Table, Vertex,
    Waypoint, segments_within,
};
use scara_kin::{Arm, ArmPath, Elbow, Joints};
use test_support::Random;
use test_support::instructions::{Limit, bench};

/// Who runs the points.
#[derive(Clone, Copy)]
enum Machine {
    Cartesian,
    TwoLinks,
    ThreeArms,
}

/// Points of a circle of 40 mm so far apart, in mm, and the most instructions for each.
const CASES: [(&str, Machine, f64, f64); 10] = [
    ("0.05 mm apart", Machine::Cartesian, 0.05, 900.0),
    ("0.1 mm apart", Machine::Cartesian, 0.1, 1500.0),
    ("0.2 mm apart", Machine::Cartesian, 0.2, 2600.0),
    ("0.5 mm apart", Machine::Cartesian, 0.5, 9000.0),
    ("1 mm apart", Machine::Cartesian, 1.0, 11_000.0),
    ("2 mm apart", Machine::Cartesian, 2.0, 25_000.0),
    ("arm, 0.2 mm apart", Machine::TwoLinks, 0.2, 9200.0),
    ("arm, 1 mm apart", Machine::TwoLinks, 1.0, 42_000.0),
    ("Delta, 0.2 mm apart", Machine::ThreeArms, 0.2, 21_500.0),
    ("Delta, 1 mm apart", Machine::ThreeArms, 1.0, 100_000.0),
];

/// As many of the Cartesian machine; arms take long under callgrind.
const fn points(machine: Machine) -> u32 {
    match machine {
        Machine::Cartesian => 2000,
        Machine::TwoLinks | Machine::ThreeArms => 200,
    }
}

/// A stream along so many corners with limits of jerk.
const SMOOTH: &str = "a knot with jerk";
const CORNERS: u32 = 100;
/// Its rows.
const KNOTS: u32 = 2361;

/// Of smoothing, and of the joints' cubics, in mm.
const TOLERANCE_MM: f64 = 0.01;

/// Of a Cartesian axis in mm; of a joint in rad.
const LINEAR: AxisLimits = AxisLimits {
    speed: 300.0,
    acceleration: 3000.0,
    jerk: None,
};
const JOINT: AxisLimits = AxisLimits {
    speed: 6.0,
    acceleration: 100.0,
    jerk: None,
};

/// Points of a circle with three decimals, from its centre.
fn circle(count: u32, step_mm: f64) -> Vec<[f64; 2]> {
    (0..count)
        .map(|n| {
            let (sin, cos) = (f64::from(n) * step_mm / 40.0).sin_cos();
            [cos, sin].map(|x| (x * 40_000.0).round() / 1000.0)
        })
        .collect()
}

fn smoothed<const D: usize>(
    points: impl Iterator<Item = [f64; D]>,
    vertices: &mut [Vertex<D>],
) -> impl Iterator<Item = Curve<D>> {
    let points = points.map(Waypoint::from);
    let curves = Smoothed::new(points, TOLERANCE_MM, vertices).unwrap();
    curves.map(Result::unwrap)
}

fn cartesian(points: &[[f64; 2]]) {
    let (mut vertices, mut window) = ([Vertex::default(); 24], [Knot::default(); 64]);
    let curves = smoothed(points.iter().copied(), &mut vertices);
    let rows = LookAhead::new(curves, [LINEAR; 2], |_| Ok(1), &mut window).unwrap();
    black_box(rows.last());
}

fn arm(points: &[[f64; 2]]) {
    let arm = Arm::new(132.0, 132.0).unwrap();
    let (mut vertices, mut window) = ([Vertex::default(); 24], [Knot::default(); 64]);
    let points = points.iter().map(|[x, y]| [*x, y + 150.0]);
    let mut joints = None;
    let paths = smoothed(points, &mut vertices).map(|curve| {
        let path = match joints {
            Some(joints) => arm.path_from(curve, Elbow::Right, joints),
            None => arm.path(curve, Elbow::Right),
        };
        let path = path.unwrap();
        let [shoulder, elbow] = path.point(path.length()).unwrap().position;
        joints = Some(Joints::new(shoulder, elbow));
        path
    });
    let segments = |path: &ArmPath| segments_within(path, 1, TOLERANCE_MM, ArmPath::departure);
    let rows = LookAhead::new(paths, [JOINT; 2], segments, &mut window).unwrap();
    black_box(rows.last());
}

fn delta(points: &[[f64; 2]]) {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    let (mut vertices, mut window) = ([Vertex::default(); 24], [Knot::default(); 64]);
    let points = points.iter().map(|[x, y]| [*x, *y, -300.0]);
    let paths = smoothed(points, &mut vertices).map(|curve| delta.path(curve).unwrap());
    let segments = |path: &DeltaPath| segments_within(path, 1, TOLERANCE_MM, DeltaPath::departure);
    let rows = LookAhead::new(paths, [JOINT; 3], segments, &mut window).unwrap();
    black_box(rows.last());
}

/// Shapers of both axes, and the most instructions for each row and impulse of an axis.
const SHAPED: [(&str, [Make; 2], f64); 3] = [
    ("ZV and ZV", [Shaper::zv; 2], 150.0),
    ("ZVD and MZV", [Shaper::zvd, Shaper::mzv], 150.0),
    ("3HUMP and EI", [Shaper::three_hump, Shaper::ei], 150.0),
];

type Make = fn(Mode) -> Result<Shaper, path_timing::ShaperError>;

/// The rows of a line, shaped so often; the rows and impulses of it.
fn shape(make: [Make; 2], rounds: u32) -> usize {
    let modes = [40.0, 55.0].map(|hz| Mode { hz, damping: 0.05 });
    let [x, y] = make;
    let shapers = [x(modes[0]).unwrap(), y(modes[1]).unwrap()];
    let line = Curve::line([0.0, 0.0], [60.0, 80.0]).unwrap();
    let mut knots = [Knot::default(); 201];
    let table = Table::plan([line], [LINEAR; 2], |_| 200, &mut knots).unwrap();
    let mut memory = [Row::default(); 203];
    let mut rows = 0;
    for _ in 0..rounds {
        rows = Shaped::new(table.rows(), black_box(shapers), &mut memory).count();
    }
    rows * shapers
        .map(|shaper| shaper.impulses().len())
        .iter()
        .sum::<usize>()
}

/// Sides of 2 to 5 mm that turn by 5 to 30 degrees.
fn corners(count: u32) -> Vec<[f64; 2]> {
    let mut random = Random::new(1);
    let (mut at, mut heading) = ([0.0, 0.0], 0.0_f64);
    (0..count)
        .map(|_| {
            let turn = random.within(5.0, 30.0_f64).to_radians();
            heading += if random.below(2) == 0 { turn } else { -turn };
            let (length, (sin, cos)) = (random.within(2.0, 5.0), heading.sin_cos());
            at = [at[0] + length * cos, at[1] + length * sin];
            at
        })
        .collect()
}

/// A stream with limits of jerk. Its rows.
fn smooth(points: &[[f64; 2]]) -> u32 {
    let mut vertices = [Vertex::default(); 24];
    let mut window = vec![Knot::default(); 200];
    let axis = AxisLimits {
        speed: 150.0,
        acceleration: 3000.0,
        jerk: Some(100_000.0),
    };
    let waypoints = points.iter().copied().map(Waypoint::from);
    let curves = Smoothed::new(waypoints, 0.02, &mut vertices).unwrap();
    let curves = curves.map(Result::unwrap);
    let rows = LookAhead::new(curves, [axis; 2], |_| Ok(8), &mut window).unwrap();
    let rows: Result<Vec<_>, _> = rows.collect();
    u32::try_from(rows.unwrap().len()).unwrap()
}

fn run(case: &str, rounds: u32) {
    if let Some((_, make, _)) = SHAPED.iter().find(|(name, ..)| *name == case) {
        black_box(shape(*make, rounds));
        return;
    }
    if case == SMOOTH {
        let points = corners(CORNERS);
        for _ in 0..rounds {
            assert_eq!(smooth(black_box(&points)), KNOTS);
        }
        return;
    }
    let found = CASES.iter().find(|(name, ..)| *name == case);
    let (_, machine, step_mm, _) = *found.unwrap();
    let points = circle(points(machine), step_mm);
    for _ in 0..rounds {
        let points = black_box(&points);
        match machine {
            Machine::Cartesian => cartesian(points),
            Machine::TwoLinks => arm(points),
            Machine::ThreeArms => delta(points),
        }
    }
}

fn main() -> ExitCode {
    let limits = CASES.map(|(case, machine, _, most)| Limit {
        case,
        unit: "per point",
        units: f64::from(points(machine)),
        rounds: [1, 4],
        most,
    });
    let shaped = SHAPED.map(|(case, make, most)| Limit {
        case,
        unit: "per row and impulse",
        units: f64::from(u32::try_from(shape(make, 1)).unwrap()),
        rounds: [1, 4],
        most,
    });
    let smooth = Limit {
        case: SMOOTH,
        unit: "per knot",
        units: f64::from(KNOTS),
        rounds: [1, 2],
        most: 135_000.0,
    };
    let limits: Vec<_> = limits.into_iter().chain(shaped).chain([smooth]).collect();
    bench(run, &limits)
}
