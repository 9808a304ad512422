//! Torques against other derivations: forces and moments of each body, and the energy that they
//! bring in.

use proptest::prelude::*;
use scara_kin::nalgebra::{Isometry2, Vector2};
use scara_kin::{Arm, ArmDynamics, ArmMasses, JointDrive, Joints, LinkMass};

/// Of sums of some hundred Nm.
const ROUNDING: f64 = 1e-10;

/// Link lengths in m.
const LENGTHS: [f64; 2] = [0.3, 0.24];
/// The base's angle in rad.
const BASE: f64 = 0.7;

fn dynamics(masses: ArmMasses) -> ArmDynamics {
    let [upper, fore] = LENGTHS.map(|length| length * 1000.0);
    let base = Isometry2::new(Vector2::new(50.0, -20.0), BASE);
    let arm = Arm::new(upper, fore).unwrap().with_base(base).unwrap();
    arm.dynamics(1e-3, masses).unwrap()
}

/// A place that turns with both links: its position, and its acceleration from the angles of the
/// links.
#[derive(Clone, Copy)]
struct Place {
    position: Vector2<f64>,
    acceleration: Vector2<f64>,
}

/// So far along a link at an angle, with rate and acceleration, from a place.
fn along(from: Place, length: f64, [angle, rate, acceleration]: [f64; 3]) -> Place {
    let direction = Vector2::new(angle.cos(), angle.sin()) * length;
    let across = Vector2::new(-direction.y, direction.x);
    Place {
        position: from.position + direction,
        acceleration: from.acceleration + across * acceleration - direction * rate * rate,
    }
}

/// Newton and Euler: the moment about a joint of all that is beyond it.
fn newton_euler(
    masses: &ArmMasses,
    joints: [f64; 2],
    rates: [f64; 2],
    accelerations: [f64; 2],
) -> [f64; 2] {
    let upper = [BASE + joints[0], rates[0], accelerations[0]];
    let fore = [
        upper[0] + joints[1],
        rates[0] + rates[1],
        accelerations[0] + accelerations[1],
    ];
    let shoulder = Place {
        position: Vector2::zeros(),
        acceleration: Vector2::zeros(),
    };
    let elbow = along(shoulder, LENGTHS[0], upper);
    let tool = along(elbow, LENGTHS[1], fore);
    let gravity = Vector2::new(0.0, -masses.gravity_m_s2);
    let bodies = [
        (
            masses.upper.mass_kg,
            masses.upper.inertia_kg_m2,
            along(shoulder, masses.upper.centre_m, upper),
            upper[2],
        ),
        (
            masses.fore.mass_kg,
            masses.fore.inertia_kg_m2,
            along(elbow, masses.fore.centre_m, fore),
            fore[2],
        ),
        (masses.payload_kg, 0.0, tool, 0.0),
    ];
    let moment = |about: Vector2<f64>, bodies: &[(f64, f64, Place, f64)]| -> f64 {
        let each = bodies.iter().map(|(mass, inertia, place, turning)| {
            let (arm, force) = (
                place.position - about,
                (place.acceleration - gravity) * *mass,
            );
            arm.perp(&force) + inertia * turning
        });
        each.sum()
    };
    let drive = |drive: &JointDrive, rate: f64, acceleration: f64| {
        let coulomb = if rate == 0.0 {
            0.0
        } else {
            drive.coulomb_nm * rate.signum()
        };
        drive.rotor_kg_m2 * acceleration + drive.viscous_nm_s * rate + coulomb
    };
    [
        moment(shoulder.position, &bodies) + drive(&masses.shoulder, rates[0], accelerations[0]),
        moment(elbow.position, &bodies[1..]) + drive(&masses.elbow, rates[1], accelerations[1]),
    ]
}

fn masses() -> impl Strategy<Value = ArmMasses> {
    let link = || {
        (0.0..5.0_f64, -0.05..0.3_f64, 0.0..0.1_f64).prop_map(
            |(mass_kg, centre_m, inertia_kg_m2)| LinkMass {
                mass_kg,
                centre_m,
                inertia_kg_m2,
            },
        )
    };
    let drive = || {
        (0.0..0.5_f64, 0.0..1.0_f64, 0.0..2.0_f64).prop_map(
            |(rotor_kg_m2, viscous_nm_s, coulomb_nm)| JointDrive {
                rotor_kg_m2,
                viscous_nm_s,
                coulomb_nm,
            },
        )
    };
    let rest = (0.0..3.0_f64, prop_oneof![Just(0.0), Just(9.806_65)]);
    (link(), link(), drive(), drive(), rest).prop_map(
        |(upper, fore, shoulder, elbow, (payload_kg, gravity_m_s2))| ArmMasses {
            upper,
            fore,
            payload_kg,
            shoulder,
            elbow,
            gravity_m_s2,
        },
    )
}

fn pair(largest: f64) -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(-largest..largest)
}

proptest! {
    #[test]
    fn torques_are_the_moments_of_all_that_is_beyond(
        masses in masses(),
        joints in pair(4.0),
        rates in pair(10.0),
        accelerations in pair(50.0),
    ) {
        let [shoulder, elbow] = joints;
        let torques = dynamics(masses).torques(Joints::new(shoulder, elbow), rates.into(), accelerations.into());
        let moments = newton_euler(&masses, joints, rates, accelerations);
        for (torque, moment) in torques.iter().zip(moments) {
            prop_assert!((torque - moment).abs() < ROUNDING, "{torques}, {moments:?}");
        }
    }
}

/// What the torques bring in along a motion is the energy of all bodies, and what friction takes.
#[test]
fn work_is_the_energy_of_all_bodies() {
    const STEPS: u32 = 20_000;
    /// Of the trapezoidal rule.
    const CLOSE: f64 = 1e-6;
    let link = LinkMass {
        mass_kg: 2.0,
        centre_m: 0.14,
        inertia_kg_m2: 0.02,
    };
    let drive = JointDrive {
        rotor_kg_m2: 0.05,
        viscous_nm_s: 0.3,
        coulomb_nm: 0.4,
    };
    let masses = ArmMasses {
        upper: link,
        fore: link,
        payload_kg: 1.5,
        shoulder: drive,
        elbow: drive,
        gravity_m_s2: 9.806_65,
    };
    let dynamics = dynamics(masses);
    let at = |time_s: f64| {
        let (sin, cos) = (3.0 * time_s).sin_cos();
        let (sin2, cos2) = (2.0 * time_s + 0.4).sin_cos();
        [
            [0.8 * sin, 2.4 * cos, -7.2 * sin],
            [0.3 + 1.2 * sin2, 2.4 * cos2, -4.8 * sin2],
        ]
    };
    // Kinetic and potential energy from the places of all bodies.
    let energy = |time_s: f64| {
        let [[q1, v1, _], [q2, v2, _]] = at(time_s);
        let (a, b, w) = (BASE + q1, BASE + q1 + q2, v1 + v2);
        let place = |far: f64, beyond: f64| {
            let [x, y] = [
                far * a.cos() + beyond * b.cos(),
                far * a.sin() + beyond * b.sin(),
            ];
            let speed = [
                far * v1 * a.sin() + beyond * w * b.sin(),
                far * v1 * a.cos() + beyond * w * b.cos(),
            ];
            let _ = x;
            (speed[0].hypot(speed[1]), y)
        };
        let body = |mass: f64, (speed, height): (f64, f64)| {
            mass * (0.5 * speed * speed + 9.806_65 * height)
        };
        let turning = 0.5 * (0.02 + 0.05) * v1 * v1 + 0.5 * 0.02 * w * w + 0.5 * 0.05 * v2 * v2;
        let links = body(2.0, place(0.14, 0.0)) + body(2.0, place(LENGTHS[0], 0.14));
        links + body(1.5, place(LENGTHS[0], LENGTHS[1])) + turning
    };
    let powers = |time_s: f64| {
        let [[q1, v1, a1], [q2, v2, a2]] = at(time_s);
        let torques = dynamics.torques(
            Joints::new(q1, q2),
            Vector2::new(v1, v2),
            Vector2::new(a1, a2),
        );
        let friction = 0.3 * (v1 * v1 + v2 * v2) + 0.4 * (v1.abs() + v2.abs());
        torques.x * v1 + torques.y * v2 - friction
    };
    let end_s = 2.0;
    let step_s = end_s / f64::from(STEPS);
    let work: f64 = (0..STEPS)
        .map(|n| powers(step_s * (f64::from(n) + 0.5)) * step_s)
        .sum();
    assert!(
        (work - (energy(end_s) - energy(0.0))).abs() < CLOSE,
        "{work}"
    );
}

#[test]
fn bodies_that_cannot_be_are_refused() {
    let arm = Arm::new(300.0, 300.0).unwrap();
    let masses = ArmMasses {
        payload_kg: -1.0,
        ..ArmMasses::default()
    };
    let error = arm.dynamics(1e-3, masses).unwrap_err();
    assert_eq!(error.to_string(), "payload is -1, which no body has");
    let error = arm.dynamics(0.0, ArmMasses::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "unit of length, in metres, is 0, which no body has"
    );
    let none = arm.dynamics(1e-3, ArmMasses::default()).unwrap();
    assert!(none.with_payload(f64::NAN).is_err());
    assert_eq!(
        none.with_payload(2.0)
            .unwrap()
            .masses()
            .payload_kg
            .to_bits(),
        2.0_f64.to_bits()
    );
}
