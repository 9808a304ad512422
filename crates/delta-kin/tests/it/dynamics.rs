//! Torques of the arms against the energy of all bodies, from places alone.

use delta_kin::nalgebra::Vector3;
use delta_kin::{Delta, DeltaMasses, Dimensions, Positive, ZAxis};
use proptest::prelude::*;

/// Steps of the differences, in s, and what they leave, in W of some tens.
const STEP_S: f64 = 1e-4;
const CLOSE: f64 = 2e-5;

const MASSES: DeltaMasses = DeltaMasses {
    arm_kg_m2: 3e-3,
    arm_kg_m: 0.02,
    rods_kg: 0.12,
    platform_kg: 0.2,
    payload_kg: 0.7,
    viscous_nm_s: 0.0,
    coulomb_nm: 0.0,
    gravity_m_s2: 9.806_65,
};

fn machines() -> [Delta; 3] {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    [
        delta,
        delta.with_z(ZAxis::Down),
        delta
            .with_positive(Positive::Inward)
            .with_zero(0.4)
            .unwrap(),
    ]
}

/// Places of all bodies at angles, in m: the platform, and each elbow as its rods have it, upwards
/// positive.
fn places(delta: &Delta, angles: Vector3<f64>) -> (Vector3<f64>, [Vector3<f64>; 3]) {
    let pose = delta.pose_of(angles).unwrap();
    let up = |place: Vector3<f64>| {
        let sign = if pose.point().z > 0.0 { -1.0 } else { 1.0 };
        Vector3::new(place.x, place.y, sign * place.z) * 1e-3
    };
    (
        up(pose.point().coords),
        pose.elbows().map(|elbow| up(elbow.coords)),
    )
}

/// Kinetic and potential energy at a time of a motion of constant accelerations, in J.
fn energy(delta: &Delta, motion: [Vector3<f64>; 3], time_s: f64) -> f64 {
    let [angles, rates, accelerations] = motion;
    let at = |time_s: f64| {
        places(
            delta,
            angles + rates * time_s + accelerations * (time_s * time_s / 2.0),
        )
    };
    let (before, here, after) = (at(time_s - STEP_S), at(time_s), at(time_s + STEP_S));
    let speed = |before: Vector3<f64>, after: Vector3<f64>| (after - before) / (2.0 * STEP_S);
    let platform = speed(before.0, after.0);
    let carried = MASSES.platform_kg + MASSES.payload_kg;
    let mut energy = carried * (0.5 * platform.norm_squared() + MASSES.gravity_m_s2 * here.0.z);
    let rate = rates + accelerations * time_s;
    for arm in 0..3 {
        let elbow = speed(before.1[arm], after.1[arm]);
        // An even rod by Simpson's rule, which is exact for squares.
        let squares =
            elbow.norm_squared() + (elbow + platform).norm_squared() + platform.norm_squared();
        energy += MASSES.rods_kg
            * (squares / 12.0 + MASSES.gravity_m_s2 * 0.5 * (here.1[arm].z + here.0.z));
        // The arm's centre is so much below its shoulder as the elbow is, by its distance.
        let below = here.1[arm].z / 0.12;
        energy += 0.5 * MASSES.arm_kg_m2 * rate[arm] * rate[arm]
            + MASSES.arm_kg_m * MASSES.gravity_m_s2 * below;
    }
    energy
}

fn vector(largest: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-largest..largest).prop_map(Vector3::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// With one arm turning and all accelerating, the power is that arm's torque alone.
    #[test]
    fn power_is_the_change_of_the_energy(
        offset in vector(0.3),
        rates in vector(3.0),
        accelerations in vector(30.0),
        machine in 0..3_usize,
        arm in 0..4_usize,
    ) {
        let delta = machines()[machine];
        let angles = middle(&delta) + offset;
        let mut rates = rates;
        if arm < 3 {
            rates = Vector3::from_fn(|row, _| if row == arm { rates[row] } else { 0.0 });
        }
        let dynamics = delta.dynamics(1e-3, MASSES).unwrap();
        let pose = delta.pose_of(angles).unwrap();
        let torques = dynamics.torques(&pose, rates, accelerations).unwrap();
        let motion = [angles, rates, accelerations];
        let change = energy(&delta, motion, STEP_S) - energy(&delta, motion, -STEP_S);
        let power = change / (2.0 * STEP_S);
        prop_assert!((torques.dot(&rates) - power).abs() < CLOSE * (1.0 + power.abs()), "{} W, {power}", torques.dot(&rates));
    }
}

/// The angles with the platform in the middle of its workspace.
fn middle(delta: &Delta) -> Vector3<f64> {
    let below = delta.inverse([0.0, 0.0, -260.0]);
    let below = below.or_else(|_| delta.inverse([0.0, 0.0, 260.0]));
    below.unwrap()
}

#[test]
fn friction_acts_along_and_bodies_that_cannot_be_are_refused() {
    let [delta, ..] = machines();
    let masses = DeltaMasses {
        viscous_nm_s: 0.1,
        coulomb_nm: 0.3,
        ..DeltaMasses::default()
    };
    let dynamics = delta.dynamics(1e-3, masses).unwrap();
    let pose = delta.pose_at([10.0, 5.0, -250.0]).unwrap();
    let torques = dynamics
        .torques(&pose, Vector3::new(1.0, -2.0, 0.0), Vector3::zeros())
        .unwrap();
    assert!(
        (torques - Vector3::new(0.4, -0.5, 0.0)).norm() < 1e-12,
        "{torques}"
    );
    assert_eq!(*dynamics.masses(), masses);
    let error = dynamics.with_payload(-2.0).unwrap_err();
    assert_eq!(error.to_string(), "payload is -2, which no body has");
    assert!(delta.dynamics(f64::NAN, masses).is_err());
    // At rest it holds what it carries: as the holding torques of a pose.
    let masses = DeltaMasses {
        payload_kg: 1.5,
        gravity_m_s2: 9.806_65,
        ..DeltaMasses::default()
    };
    let dynamics = delta.dynamics(1e-3, masses).unwrap();
    let torques = dynamics
        .torques(&pose, Vector3::zeros(), Vector3::zeros())
        .unwrap();
    let holding = pose
        .holding_torques(Vector3::new(0.0, 0.0, -1.5 * 9.806_65))
        .unwrap()
        * 1e-3;
    assert!((torques - holding).norm() < 1e-12, "{torques}, {holding}");
}
