//! Instructions per call, counted by callgrind: the same from run to run.
//!
//! `cargo install gungraun-runner` once, with valgrind installed.

use std::hint::black_box;

use gungraun::{library_benchmark, library_benchmark_group, main};
use scara_kin::Arm;
use scara_kin::nalgebra::Point2;

const LINK: f64 = 132.0;

fn point() -> Point2<f64> {
    Point2::new(150.0, 80.0)
}

fn arm() -> (Arm, Point2<f64>) {
    (Arm::new(LINK, LINK).expect("lengths are good"), point())
}

// The arithmetic of both elbows without base, checks, limits or types.
#[library_benchmark(setup = point)]
fn inverse_bare(point: Point2<f64>) -> [f64; 4] {
    let (x, y) = (point.x, point.y);
    let r2 = x * x + y * y;
    let r = r2.sqrt();
    let s2 = r2 * ((2.0 * LINK - r) * (2.0 * LINK + r));
    let s = s2.max(0.0).sqrt();
    let elbow = libm::atan2(s, (r - LINK) * (r + LINK) - LINK * LINK);
    let right = libm::atan2(r2 * y - s * x, r2 * x + s * y);
    let left = libm::atan2(r2 * y + s * x, r2 * x - s * y);
    black_box([right, elbow, left, -elbow])
}

#[library_benchmark(setup = arm)]
fn inverse_both((arm, point): (Arm, Point2<f64>)) {
    let _ = black_box(black_box(arm).inverse(point));
}

library_benchmark_group!(name = kinematics; benchmarks = inverse_bare, inverse_both);

main!(library_benchmark_groups = kinematics);
