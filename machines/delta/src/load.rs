//! What the arms carry, and the torque that their motors have for it.

use anyhow::{Context, Result, ensure};
use delta_kin::{Delta, DeltaDynamics, DeltaMasses};
use known_load::{MotorSettings, Transmission};
use serde::Deserialize;

const MM_IN_M: f64 = 1e-3;

/// `[load]`, as written: at the arms' side of the gears.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadSettings {
    arm_kg_m2: f64,
    arm_kg_m: f64,
    rods_kg: f64,
    platform_kg: f64,
    #[serde(default)]
    payload_kg: f64,
    #[serde(default = "LoadSettings::gravity")]
    gravity_m_s2: f64,
}

/// What a step, a turn and a rate of an arm are to its motor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) step_deg: f64,
    pub(crate) microsteps: u32,
    pub(crate) gear_ratio: f64,
    pub(crate) max_rate_deg_s: f64,
}

/// At the arms.
pub(crate) type Load = known_load::Load<DeltaDynamics, 3>;

impl LoadSettings {
    const fn gravity() -> f64 {
        9.806_65
    }

    /// With the machine's geometry, its motors' steps, gears and rates.
    pub(crate) fn check(
        &self,
        torque: &MotorSettings,
        delta: &Delta,
        drive: Drive,
    ) -> Result<Load> {
        let full_steps = (360.0 / drive.step_deg).round();
        ensure!(
            (1.0..=1e6).contains(&full_steps),
            "step_deg = {} is no step of a motor",
            drive.step_deg
        );
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "1 to 1e6"
        )]
        let full_steps_per_turn = full_steps as u32;
        let rotor_kg_m2 = torque.rotor_at_axis(drive.gear_ratio)?;
        let masses = DeltaMasses {
            arm_kg_m2: self.arm_kg_m2,
            arm_kg_m: self.arm_kg_m,
            rods_kg: self.rods_kg,
            platform_kg: self.platform_kg,
            payload_kg: self.payload_kg,
            gravity_m_s2: self.gravity_m_s2,
            // What turns with the motor's friction is in its pull-out torque.
            viscous_nm_s: 0.0,
            coulomb_nm: 0.0,
        };
        // The arm alone first: named as it is written.
        delta.dynamics(MM_IN_M, masses).context("[load]")?;
        let masses = DeltaMasses {
            arm_kg_m2: self.arm_kg_m2 + rotor_kg_m2,
            ..masses
        };
        let dynamics = delta.dynamics(MM_IN_M, masses).context("[load]")?;
        let transmission = Transmission {
            full_steps_per_turn,
            microsteps: drive.microsteps,
            ratio: drive.gear_ratio,
            max_speed: drive.max_rate_deg_s.to_radians(),
        };
        let motor = torque.at_axis(transmission, masses.arm_kg_m2)?;
        Ok(Load::new(dynamics, [motor; 3], torque.reserve()))
    }
}
