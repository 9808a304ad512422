//! What the machine carries, the torque that its motors have for it, and the mode in which it swings.

use anyhow::{Context, Result, anyhow, ensure};
use delta_kin::{Delta, DeltaDynamics, DeltaMasses};
use machine_sim::Motor;
use path_timing::{Mode, Shaper, TorqueCurve, TorqueLimits};
use serde::Deserialize;

/// Of a pull-out curve that is reckoned.
const SPEEDS: u32 = 15;
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

impl LoadSettings {
    const fn gravity() -> f64 {
        9.806_65
    }
}

/// `[torque]`, as written: at the motors' shafts.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TorqueSettings {
    holding_torque_nm: f64,
    corner_speed_hz: f64,
    rotor_kg_m2: f64,
    friction_nm: f64,
    damping_ratio: f64,
    #[serde(default)]
    pull_out: Vec<[f64; 2]>,
    reserve: f64,
}

/// `[mode]`, as written.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModeSettings {
    hz: f64,
    damping: f64,
    shaper: String,
}

/// What the arms weigh, and what turns them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Load {
    /// At the arms.
    pub(crate) limits: TorqueLimits<DeltaDynamics>,
    /// At its shaft, with the rotor alone.
    pub(crate) motor: Motor,
    pub(crate) gear_ratio: f64,
    /// The part of the motors' torque that is not planned.
    pub(crate) reserve: f64,
}

/// What a step, a turn and a rate of an arm are to its motor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) step_deg: f64,
    pub(crate) microsteps: u32,
    pub(crate) gear_ratio: f64,
    pub(crate) max_rate_deg_s: f64,
}

/// A mode in which the tool swings, in any direction, and the shaper for it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Elastic {
    pub(crate) mode: Mode,
    pub(crate) shaper: Shaper,
}

impl Elastic {
    pub(crate) fn check(settings: &ModeSettings) -> Result<Self> {
        let ModeSettings { hz, damping, .. } = *settings;
        let mode = Mode { hz, damping };
        let shaper = commissioning::shaper(&settings.shaper, mode)
            .map_err(|error| anyhow!("[mode] {error:#}"))?;
        Ok(Self { mode, shaper })
    }
}

impl Load {
    /// With the machine's geometry, its motors' steps, gears and rates.
    pub(crate) fn check(
        (load, torque): (&LoadSettings, &TorqueSettings),
        delta: &Delta,
        drive: Drive,
    ) -> Result<Self> {
        let (reserve, gear_ratio) = (torque.reserve, drive.gear_ratio);
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
        for (name, value) in [
            ("holding_torque_nm", torque.holding_torque_nm),
            ("corner_speed_hz", torque.corner_speed_hz),
            ("rotor_kg_m2", torque.rotor_kg_m2),
        ] {
            ensure!(
                value.is_finite() && value > 0.0,
                "[torque] {name} = {value} is not above zero"
            );
        }
        for (name, value) in [
            ("friction_nm", torque.friction_nm),
            ("damping_ratio", torque.damping_ratio),
        ] {
            ensure!(
                value.is_finite() && value >= 0.0,
                "[torque] {name} = {value} is not zero or above"
            );
        }
        ensure!(
            (0.0..1.0).contains(&reserve),
            "[torque] reserve = {reserve} is not 0 to below 1"
        );
        let motor = Motor {
            holding_torque_nm: torque.holding_torque_nm,
            corner_speed_hz: torque.corner_speed_hz,
            inertia_kg_m2: torque.rotor_kg_m2,
            friction_nm: torque.friction_nm,
            damping_ratio: torque.damping_ratio,
            full_steps_per_turn,
            microsteps: drive.microsteps,
        };
        let rotor_kg_m2 = torque.rotor_kg_m2 * gear_ratio * gear_ratio;
        let masses = DeltaMasses {
            arm_kg_m2: load.arm_kg_m2,
            arm_kg_m: load.arm_kg_m,
            rods_kg: load.rods_kg,
            platform_kg: load.platform_kg,
            payload_kg: load.payload_kg,
            gravity_m_s2: load.gravity_m_s2,
            // What turns with the motor's friction is in its pull-out torque.
            viscous_nm_s: 0.0,
            coulomb_nm: 0.0,
        };
        // The arm alone first: named as it is written.
        delta.dynamics(MM_IN_M, masses).context("[load]")?;
        let masses = DeltaMasses {
            arm_kg_m2: load.arm_kg_m2 + rotor_kg_m2,
            ..masses
        };
        let dynamics = delta.dynamics(MM_IN_M, masses).context("[load]")?;

        let hz_per_rad_s = gear_ratio / drive.step_deg.to_radians();
        let points = if torque.pull_out.is_empty() {
            let top_hz = drive.max_rate_deg_s.to_radians() * hz_per_rad_s;
            let inertia = masses.arm_kg_m2 / gear_ratio / gear_ratio;
            reckoned(&motor, inertia, top_hz)?
        } else {
            torque.pull_out.clone()
        };
        let points: Vec<_> = points
            .into_iter()
            .map(|[hz, nm]| [hz / hz_per_rad_s, nm * gear_ratio * (1.0 - reserve)])
            .collect();
        let curve = TorqueCurve::from_points(&points).context("[torque] pull_out")?;
        Ok(Self {
            limits: TorqueLimits {
                dynamics,
                motors: [curve; 3],
            },
            motor,
            gear_ratio,
            reserve,
        })
    }
}

/// The pull-out curve of the simulated motor with an inertia, up to a speed.
fn reckoned(motor: &Motor, inertia_kg_m2: f64, top_hz: f64) -> Result<Vec<[f64; 2]>> {
    (0..=SPEEDS)
        .map(|n| {
            let hz = top_hz * f64::from(n) / f64::from(SPEEDS);
            let nm = motor.pull_out_nm(hz, inertia_kg_m2);
            ensure!(
                nm > 0.0,
                "[torque] the motor has nothing left at {hz:.0} Hz"
            );
            Ok([hz, nm])
        })
        .collect()
}
