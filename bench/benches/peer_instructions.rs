//! Instructions of our inverses beside those of the best published crate, counted by callgrind: no
//! noise of the machine is in them.

use std::hint::black_box;
use std::process::ExitCode;

use pose2pulse_bench::{
    ARM_POINTS, DELTA_POINTS, arm, arm_points, delta, delta_points, peer_arm, peer_delta,
};
use scara_kin::Elbow;
use test_support::instructions::{Limit, bench};

const BOTH: &str = "scara-kin, both elbows";
const ONE: &str = "scara-kin, one elbow";
const THEIR_ONE: &str = "oxictl, one elbow";
const DELTA: &str = "delta-kin, inverse";
const THEIR_DELTA: &str = "oxictl, Delta inverse";

/// A case, its points, and the most instructions for each.
const CASES: [(&str, u32, f64); 5] = [
    (BOTH, ARM_POINTS, 300.0),
    (ONE, ARM_POINTS, 230.0),
    (THEIR_ONE, ARM_POINTS, f64::INFINITY),
    (DELTA, DELTA_POINTS, 680.0),
    (THEIR_DELTA, DELTA_POINTS, f64::INFINITY),
];

fn run(case: &str, rounds: u32) {
    let (points, delta_points) = (arm_points(), delta_points());
    let (arm, their_arm) = (arm(), peer_arm());
    let (delta, their_delta) = (delta(), peer_delta());
    for _ in 0..rounds {
        match case {
            BOTH => points.iter().for_each(|p| {
                let _ = black_box(arm.inverse(black_box(*p)));
            }),
            ONE => points.iter().for_each(|p| {
                let _ = black_box(arm.inverse_elbow(black_box(*p), Elbow::Left));
            }),
            THEIR_ONE => points.iter().for_each(|p| {
                let p = black_box(*p);
                black_box(their_arm.inverse(p.x, p.y, 0.0, 0.0));
            }),
            DELTA => delta_points.iter().for_each(|p| {
                let _ = black_box(delta.inverse(black_box(*p)));
            }),
            _ => delta_points.iter().for_each(|p| {
                let p = black_box(*p);
                black_box(their_delta.inverse(p.x, p.y, p.z));
            }),
        }
    }
}

fn main() -> ExitCode {
    bench(
        run,
        &CASES.map(|(case, points, most)| Limit {
            case,
            unit: "per point",
            units: f64::from(points),
            rounds: [1, 3],
            most,
        }),
    )
}
