//! A two-link arm along a line with several payloads, as fast as the torque of its steppers allows,
//! and what of it each of them gives at most.

use core::error::Error;

use path_timing::{AxisLimits, Curve, Knot, TorqueCurve, TorqueLimits};
use scara_kin::{Arm, ArmMasses, Elbow, JointDrive, LinkMass};

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(300.0, 300.0)?; // mm
    let link = LinkMass {
        mass_kg: 2.5,
        centre_m: 0.14,
        inertia_kg_m2: 0.03,
    };
    let drive = JointDrive {
        rotor_kg_m2: 0.08, // at the joint: the rotor's times the square of the gear ratio
        viscous_nm_s: 0.3,
        coulomb_nm: 0.8,
    };
    let empty = arm.dynamics(
        1e-3, // 1 mm in m
        ArmMasses {
            upper: link,
            fore: link,
            payload_kg: 0.0,
            shoulder: drive,
            elbow: drive,
            gravity_m_s2: 0.0, // a horizontal plane
        },
    )?;
    // Holding torque in Nm, the speed from which it falls and the largest one in rad/s, at the
    // joints.
    let motors = [
        TorqueCurve::holding(30.0, 3.0, 30.0)?,
        TorqueCurve::holding(12.0, 4.0, 30.0)?,
    ];
    let line = arm.path(Curve::line([-200.0, 300.0], [250.0, 300.0])?, Elbow::Right)?;
    let joint = AxisLimits {
        speed: 30.0,          // rad/s
        acceleration: 1000.0, // rad/s²
        jerk: None,
    };
    for payload_kg in [0.0, 1.0, 2.0, 3.0] {
        let dynamics = empty.with_payload(payload_kg)?;
        let torque = TorqueLimits { dynamics, motors };
        let mut knots = [Knot::default(); 201];
        let table = torque.plan([line], [joint; 2], |_| 200, &mut knots)?;
        let mut largest = [0.0_f64; 2];
        for torques in table.spans().flat_map(|span| torque.torques(&span)) {
            for (largest, torque) in largest.iter_mut().zip(torques) {
                *largest = largest.max(torque.abs());
            }
        }
        let time_s = table.duration_s();
        println!("{payload_kg} kg: {time_s:.4} s, at most {largest:.2?} Nm");
    }
    Ok(())
}
