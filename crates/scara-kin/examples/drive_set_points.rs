//! What servo drives of CiA 402 get each millisecond: a geared arm along a line, within the torque
//! of its motors, at 80 % of the speed that this allows.
//!
//! `cargo run -p scara-kin --features path-timing --example drive_set_points`

use core::error::Error;

use path_timing::{
    AxisLimits, Cia402Scale, Curve, Knot, SetPoint, SetPoints, Table, TorqueCurve, TorqueLimits,
    TorqueTable,
};
use scara_kin::{Arm, ArmMasses, Elbow, JointDrive, LinkMass};

const RATIO: f64 = 50.0;
const RATED_NM: f64 = 0.64;

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(300.0, 300.0)?; // mm
    let link = LinkMass {
        mass_kg: 2.5,
        centre_m: 0.14,
        inertia_kg_m2: 0.03,
    };
    let drive = JointDrive {
        rotor_kg_m2: 0.08,
        viscous_nm_s: 0.3,
        coulomb_nm: 0.8,
    };
    let masses = ArmMasses {
        upper: link,
        fore: link,
        payload_kg: 1.0,
        shoulder: drive,
        elbow: drive,
        gravity_m_s2: 0.0,
    };
    // The motors' torque in Nm up to a speed in rad/s, behind gears of 50:1.
    let motor = TorqueCurve::constant(RATED_NM, 300.0)?.geared(RATIO)?;
    let torque = TorqueLimits {
        dynamics: arm.dynamics(1e-3, masses)?,
        motors: [motor; 2],
    };
    let line = arm.path(Curve::line([-200.0, 300.0], [250.0, 300.0])?, Elbow::Right)?;
    let joint = AxisLimits {
        speed: 6.0,
        acceleration: 1000.0,
        jerk: None,
    }; // rad, s
    let mut knots = [Knot::default(); 201];
    let table: TorqueTable<'_, [f64; 2]> = torque.plan([line], [joint; 2], |_| 200, &mut knots)?;
    println!(
        "{:.4} s by the torque of motors given at up to {} speeds",
        table.duration_s(),
        TorqueCurve::MAX_POINTS
    );

    // The same line by speed and acceleration alone leaves room for a feed up to 125 %.
    let mut knots = [Knot::default(); 201];
    let slow = AxisLimits {
        acceleration: 20.0,
        ..joint
    };
    let slow = Table::plan([line], [slow; 2], |_| 200, &mut knots)?.at_speed(0.8)?;
    let scale = Cia402Scale {
        counts_per_unit: 131_072.0 * RATIO / core::f64::consts::TAU,
        rated_torque: RATED_NM * RATIO,
    };
    for point in SetPoints::new(slow.rows(), 0.001).step_by(100) {
        let SetPoint {
            time_s,
            position: [shoulder, _],
            velocity: [rate, _],
            ..
        } = point?;
        let target = scale.target(shoulder, rate, 0.0)?;
        println!("{time_s:.3} s: the shoulder's drive gets {target:?}");
    }
    Ok(())
}
