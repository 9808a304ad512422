//! Instructions of our inverses beside those of the best published crate, counted by callgrind: no noise
//! of the machine is in them.

#[path = "../../crates/delta-kin/benches/kinematics/points.rs"]
mod delta_points;
#[path = "../../crates/scara-kin/benches/inverse/points.rs"]
mod points;

use std::hint::black_box;
use std::process::ExitCode;

use delta_kin::{Delta, Dimensions};
use oxictl::kinematics::serial::delta::{DeltaConfig, DeltaRobot};
use oxictl::kinematics::serial::scara::{ScaraConfig, ScaraRobot};
use scara_kin::{Arm, Elbow};
use test_support::instructions::{Limit, bench};

use points::{LINK, POINTS, points};

const BOTH: &str = "scara-kin, both elbows";
const ONE: &str = "scara-kin, one elbow";
const THEIR_ONE: &str = "oxictl, one elbow";
const DELTA: &str = "delta-kin, inverse";
const THEIR_DELTA: &str = "oxictl, Delta inverse";

/// A case, its points, and the most instructions for each.
const CASES: [(&str, u32, f64); 5] = [
    (BOTH, POINTS, 450.0),
    (ONE, POINTS, 310.0),
    (THEIR_ONE, POINTS, f64::INFINITY),
    (DELTA, delta_points::POINTS, 850.0),
    (THEIR_DELTA, delta_points::POINTS, f64::INFINITY),
];

fn run(case: &str, rounds: u32) {
    let (points, delta_points) = (points(), delta_points::points());
    let arm = Arm::new(LINK, LINK).expect("lengths are good");
    let their_arm = ScaraRobot::new(ScaraConfig {
        a1: LINK,
        a2: LINK,
        ..ScaraConfig::desktop()
    });
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .expect("lengths are good");
    let their_delta = DeltaRobot::new(DeltaConfig {
        r_f: 42.0,
        r_e: 18.0,
        l1: 120.0,
        l2: 243.0,
        theta_min: -7.0,
        theta_max: 7.0,
    });
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
