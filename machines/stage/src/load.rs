//! What the screws carry, and the torque that their motors have for it.

use core::f64::consts::TAU;

use anyhow::{Result, ensure};
use known_load::{MotorSettings, Transmission};
use path_timing::{Dynamics, Friction, Span};
use serde::Deserialize;

use crate::grid::{FULL_STEPS_PER_TURN, MICROSTEPS, PITCH_MM};

/// `[load]`, as written.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadSettings {
    x_kg: f64,
    y_kg: f64,
    screw_kg_m2: f64,
}

/// X and Y.
pub(crate) type Load = known_load::Load<Tables, 2>;

/// Two tables, each a mass that its screw moves, that of screw and rotor with it. Forces are in
/// Nm/mm, masses in what goes with these and mm/s²: 1 kg m²/mm² is 10⁶ kg.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tables {
    masses: [f64; 2],
}

impl Dynamics for Tables {
    type Axes = [f64; 2];

    fn torques(&self, _: &[f64; 2], _: &[f64; 2], &[x, y]: &[f64; 2]) -> [f64; 2] {
        let [x_mass, y_mass] = self.masses;
        [x_mass * x, y_mass * y]
    }

    /// That of nuts and guides is in the motors' pull-out torque.
    fn friction(&self) -> [Friction; 2] {
        [Friction::default(); 2]
    }

    /// Accelerations are straight lines in time.
    fn bend(&self, _: &Span<[f64; 2]>) -> [f64; 2] {
        [0.0; 2]
    }
}

impl LoadSettings {
    /// With the motors, whose axes go so fast at most.
    pub(crate) fn check(&self, torque: &MotorSettings, max_speed_mm_s: f64) -> Result<Load> {
        const KG: f64 = 1e-6;
        for (name, value) in [
            ("x_kg", self.x_kg),
            ("y_kg", self.y_kg),
            ("screw_kg_m2", self.screw_kg_m2),
        ] {
            ensure!(
                value.is_finite() && value >= 0.0,
                "[load] {name} = {value} is not zero or above"
            );
        }
        let transmission = Transmission {
            full_steps_per_turn: FULL_STEPS_PER_TURN,
            microsteps: MICROSTEPS,
            ratio: TAU / PITCH_MM,
            max_speed: max_speed_mm_s,
        };
        let ratio = transmission.ratio;
        let turned = torque.rotor_at_axis(ratio)? + self.screw_kg_m2 * ratio * ratio;
        let masses = [self.x_kg, self.y_kg].map(|kg| kg * KG + turned);
        let [x, y] = masses.map(|mass| {
            let mut motor = torque.at_axis(transmission, mass)?;
            // What it turns is always the same.
            motor.motor.inertia_kg_m2 = mass / ratio / ratio;
            Ok::<_, anyhow::Error>(motor)
        });
        Ok(Load::new(Tables { masses }, [x?, y?], torque.reserve()))
    }
}
