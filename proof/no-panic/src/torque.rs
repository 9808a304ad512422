//! Torques of arms along segments, set-points of servo drives.

use std::hint::black_box;

use delta_kin::{Delta, DeltaDynamics, DeltaMasses, Dimensions};
use no_panic::no_panic;
use path_timing::{
    Cia402Scale, Cia402Target, Row, SetPoint, SetPoints, Span, TargetError, TorqueCurve,
    TorqueLimits,
};
use scara_kin::{Arm, ArmDynamics, ArmMasses, JointDrive, LinkMass};

type Given = Result<Row<[f64; 2]>, u8>;

#[no_panic]
#[inline(never)]
fn arm_torques(limits: &TorqueLimits<ArmDynamics>, span: &Span<[f64; 2]>) -> [[f64; 2]; 2] {
    limits.torques(span)
}

#[no_panic]
#[inline(never)]
fn arm_utilisation(limits: &TorqueLimits<ArmDynamics>, span: &Span<[f64; 2]>) -> f64 {
    limits.utilisation(span)
}

#[no_panic]
#[inline(never)]
fn delta_torques(limits: &TorqueLimits<DeltaDynamics>, span: &Span<[f64; 3]>) -> [[f64; 3]; 2] {
    limits.torques(span)
}

#[no_panic]
#[inline(never)]
fn delta_utilisation(limits: &TorqueLimits<DeltaDynamics>, span: &Span<[f64; 3]>) -> f64 {
    limits.utilisation(span)
}

#[no_panic]
#[inline(never)]
fn motor_torque(curve: &TorqueCurve, speed: f64) -> f64 {
    curve.at(speed)
}

#[no_panic]
#[inline(never)]
fn next_set_point<I: Iterator<Item = Given>>(
    points: &mut SetPoints<I, [f64; 2]>,
) -> Option<Result<SetPoint<[f64; 2]>, u8>> {
    points.next()
}

#[no_panic]
#[inline(never)]
fn target(scale: &Cia402Scale, point: [f64; 3]) -> Result<Cia402Target, TargetError> {
    let [position, velocity, torque] = point;
    scale.target(position, velocity, torque)
}

fn span<const N: usize>() -> Span<[f64; N]> {
    let row = Row {
        duration_s: 0.1,
        ..Row::default()
    };
    black_box(Span {
        s: [0.0, 1.0],
        rows: [row; 2],
    })
}

pub fn run() {
    arms();
    let mut given = black_box([Ok(Row::default()), Err(3)]).into_iter().cycle();
    let rows = core::iter::from_fn(move || black_box(given.next()));
    let mut points = SetPoints::new(rows, black_box(0.001));
    for _ in 0..black_box(8) {
        black_box(next_set_point(&mut points).is_some());
    }
    let scale = black_box(Cia402Scale {
        counts_per_unit: 1e4,
        rated_torque: 1.0,
    });
    black_box(target(&scale, black_box([1.0, 2.0, 3.0])).is_ok());
}

/// Of a Delta.
const WEIGHT: DeltaMasses = DeltaMasses {
    arm_kg_m2: 0.01,
    arm_kg_m: 0.02,
    rods_kg: 0.1,
    platform_kg: 0.2,
    payload_kg: 0.1,
    viscous_nm_s: 0.01,
    coulomb_nm: 0.05,
    gravity_m_s2: 9.8,
};

fn arms() {
    let Ok(motor) = TorqueCurve::holding(black_box(30.0), 3.0, 30.0) else {
        return;
    };
    black_box(motor_torque(&motor, black_box(1.0)));
    let drive = JointDrive {
        rotor_kg_m2: 0.1,
        viscous_nm_s: 0.3,
        coulomb_nm: 0.8,
    };
    let link = LinkMass {
        mass_kg: 2.0,
        centre_m: 0.1,
        inertia_kg_m2: 0.02,
    };
    let masses = black_box(ArmMasses {
        upper: link,
        fore: link,
        payload_kg: 1.0,
        shoulder: drive,
        elbow: drive,
        gravity_m_s2: 9.8,
    });
    if let Ok(arm) = Arm::new(black_box(300.0), 240.0)
        && let Ok(dynamics) = arm.dynamics(1e-3, masses)
    {
        let limits = TorqueLimits {
            dynamics,
            motors: [motor; 2],
        };
        black_box(arm_torques(&limits, &span()));
        black_box(arm_utilisation(&limits, &span()));
    }
    let dimensions = Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    };
    if let Ok(delta) = Delta::new(black_box(dimensions))
        && let Ok(dynamics) = delta.dynamics(1e-3, black_box(WEIGHT))
    {
        let limits = TorqueLimits {
            dynamics,
            motors: [motor; 3],
        };
        black_box(delta_torques(&limits, &span()));
        black_box(delta_utilisation(&limits, &span()));
    }
}
