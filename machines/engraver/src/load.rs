//! What arm and disc carry, and the torque that their motors have for it.

use core::f64::consts::FRAC_PI_2;

use anyhow::{Context, Result, ensure};
use known_load::{MotorSettings, Transmission};
use path_timing::{Dynamics, Friction, Row, Span};
use scara_kin::{Arm, ArmDynamics, ArmMasses, JointDrive, LinkMass};
use serde::{Deserialize, Serialize};

const MM_IN_M: f64 = 1e-3;

/// `[load]`, as written: links as rigid bodies, a point mass at the tool, a disc that turns about
/// it.
#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadSettings {
    upper_kg: f64,
    upper_centre_m: f64,
    upper_kg_m2: f64,
    fore_kg: f64,
    fore_centre_m: f64,
    fore_kg_m2: f64,
    tool_kg: f64,
    disc_kg_m2: f64,
}

/// Shoulder, elbow and disc.
pub(crate) type Load = known_load::Load<ArmAndDisc, 3>;

/// The dynamics of the arm with a disc on its end, whose centre of mass is on its axis: it is felt
/// as a mass at the tool, which the tool's is with, and where it turns.
///
/// ```text
/// τ = τ arm + I (q̈1 + q̈2 + q̈3) of each,  τ3 with the rotor's R q̈3
/// ```
#[derive(Debug, Clone, Copy)]
pub(crate) struct ArmAndDisc {
    arm: ArmDynamics,
    disc_kg_m2: f64,
    rotor_kg_m2: f64,
}

impl Dynamics for ArmAndDisc {
    type Axes = [f64; 3];

    fn torques(
        &self,
        &[q1, q2, _]: &[f64; 3],
        &[v1, v2, _]: &[f64; 3],
        &[a1, a2, a3]: &[f64; 3],
    ) -> [f64; 3] {
        let [shoulder, elbow] = Dynamics::torques(&self.arm, &[q1, q2], &[v1, v2], &[a1, a2]);
        let disc = self.disc_kg_m2 * (a1 + a2 + a3);
        [shoulder + disc, elbow + disc, disc + self.rotor_kg_m2 * a3]
    }

    /// What turns with the motors' friction is in their pull-out torque.
    fn friction(&self) -> [Friction; 3] {
        [Friction::default(); 3]
    }

    /// The arm's alone: accelerations are straight lines in time.
    fn bend(&self, span: &Span<[f64; 3]>) -> [f64; 3] {
        let first_two = |[first, second, _]: [f64; 3]| [first, second];
        let rows = span.rows.map(|row| Row {
            time_s: row.time_s,
            duration_s: row.duration_s,
            position: first_two(row.position),
            velocity: first_two(row.velocity),
            leg: row.leg,
            s: row.s,
        });
        let [shoulder, elbow] = self.arm.bend(&Span { s: span.s, rows });
        [shoulder, elbow, 0.0]
    }
}

impl LoadSettings {
    /// With the arm, and the motors' steps, gears and speeds at shoulder, elbow and disc.
    pub(crate) fn check(
        &self,
        torque: &MotorSettings,
        arm: &Arm,
        joints: [Transmission; 3],
    ) -> Result<Load> {
        let [shoulder, elbow, disc] = joints.map(|joint| torque.rotor_at_axis(joint.ratio));
        let rotor = |rotor_kg_m2| JointDrive {
            rotor_kg_m2,
            ..JointDrive::default()
        };
        let link = |mass_kg, centre_m, inertia_kg_m2| LinkMass {
            mass_kg,
            centre_m,
            inertia_kg_m2,
        };
        let masses = ArmMasses {
            upper: link(self.upper_kg, self.upper_centre_m, self.upper_kg_m2),
            fore: link(self.fore_kg, self.fore_centre_m, self.fore_kg_m2),
            payload_kg: self.tool_kg,
            shoulder: rotor(shoulder?),
            elbow: rotor(elbow?),
            gravity_m_s2: 0.0,
        };
        ensure!(
            self.disc_kg_m2.is_finite() && self.disc_kg_m2 >= 0.0,
            "[load] disc_kg_m2 = {} is not zero or above",
            self.disc_kg_m2
        );
        let dynamics = ArmAndDisc {
            arm: arm.dynamics(MM_IN_M, masses).context("[load]")?,
            disc_kg_m2: self.disc_kg_m2,
            rotor_kg_m2: disc?,
        };
        let unit = |axis| core::array::from_fn(|other| f64::from(u8::from(other == axis)));
        let own = |axis| dynamics.torques(&[0.0, FRAC_PI_2, 0.0], &[0.0; 3], &unit(axis));
        let [[own_shoulder, ..], [_, own_elbow, _], [.., own_disc]] = [own(0), own(1), own(2)];
        let [shoulder, elbow, disc] = joints;
        let motors = [
            torque.at_axis(shoulder, own_shoulder)?,
            torque.at_axis(elbow, own_elbow)?,
            torque.at_axis(disc, own_disc)?,
        ];
        Ok(Load::new(dynamics, motors, torque.reserve()))
    }
}
