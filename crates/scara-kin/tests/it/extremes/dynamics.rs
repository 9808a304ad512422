//! Masses and torques of any numbers.

use proptest::prelude::*;
use scara_kin::nalgebra::Vector2;
use scara_kin::{Arm, ArmMasses, JointDrive, Joints, LinkMass};

use super::anything;

fn link([mass_kg, centre_m, inertia_kg_m2]: [f64; 3]) -> LinkMass {
    LinkMass {
        mass_kg,
        centre_m,
        inertia_kg_m2,
    }
}

fn drive([rotor_kg_m2, viscous_nm_s, coulomb_nm]: [f64; 3]) -> JointDrive {
    JointDrive {
        rotor_kg_m2,
        viscous_nm_s,
        coulomb_nm,
    }
}

fn three() -> impl Strategy<Value = [f64; 3]> {
    let body = prop::array::uniform3(0.0..1e3_f64);
    prop_oneof![3 => body, 1 => prop::array::uniform3(anything())]
}

proptest! {
    #[test]
    fn bodies_are_refused_or_have_torques(
        [upper, fore, shoulder, elbow] in prop::array::uniform4(three()),
        [payload_kg, gravity_m_s2, unit_m] in three(),
        motion in prop::array::uniform6(anything()),
        off in prop::array::uniform2(anything()),
    ) {
        let arm = Arm::new(0.3, 0.2).unwrap();
        let masses = ArmMasses {
            upper: link(upper),
            fore: link(fore),
            payload_kg,
            shoulder: drive(shoulder),
            elbow: drive(elbow),
            gravity_m_s2,
        };
        let weights = [upper[0], upper[2], fore[0], fore[2], payload_kg];
        let weights = weights.into_iter().chain(shoulder).chain(elbow);
        let is_body = weights.into_iter().all(|weight| weight >= 0.0 && weight.is_finite())
            && [upper[1], fore[1], gravity_m_s2].into_iter().all(f64::is_finite)
            && unit_m > 0.0 && unit_m.is_finite();
        let dynamics = arm.dynamics(unit_m, masses);
        prop_assert_eq!(dynamics.is_ok(), is_body);
        let [q1, q2, v1, v2, a1, a2] = motion;
        if let Ok(dynamics) = dynamics {
            prop_assert_eq!(*dynamics.masses(), masses);
            prop_assert!(dynamics.with_payload(-1.0).is_err());
            let torques = dynamics.torques(Joints::new(q1, q2), Vector2::new(v1, v2), Vector2::new(a1, a2));
            let is_small = |x: f64| x.abs() < 1e6;
            let sizes = [motion.as_slice(), &upper, &fore, &shoulder, &elbow, &[payload_kg, gravity_m_s2, unit_m]];
            if sizes.concat().into_iter().all(is_small) {
                prop_assert!(torques.iter().all(|torque| torque.is_finite()));
            }
        }
        let shift = arm.tool_shift(off);
        prop_assert!(shift >= 0.0 || off.iter().any(|off| off.is_nan()));
    }
}
