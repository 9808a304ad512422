//! What the emitted edges ask of the motors, and whether they follow.

use anyhow::{Context, Result};
use machine_sim::{DrivenAxis, Followed, Motor, StepSize};
use nalgebra::{Matrix3, Vector3};

use crate::load::Load;
use crate::machine::Machine;

/// From one look at what the arms carry to the next: a fraction of the swings of a rotor.
const LOOK_S: f64 = 250e-6;

/// 0.4 N m on each arm. At the motor, through 27:1: the rotor 5.4, the gear 2.0, an arm of 60 g and
/// its share of rods and platform, 80 g at 120 mm, 2.0, in 1e-6 kg m².
const MOTOR: Motor = Motor {
    holding_torque_nm: 0.4,
    corner_speed_hz: 1000.0,
    inertia_kg_m2: 9.4e-6,
    friction_nm: 0.03,
    damping_ratio: 0.02,
    full_steps_per_turn: 200,
    microsteps: 1,
};

/// The three motors.
#[derive(Debug, Clone)]
pub(crate) struct Motors {
    axes: [DrivenAxis; 3],
    position: [i32; 3],
    load: Option<Load>,
    looked_s: f64,
}

impl Motors {
    /// Motors at home, with what they turn: a load that changes with the pose where the machine's is known
    /// and `is_loaded`, else the same all along.
    pub(crate) fn new(machine: &Machine, is_loaded: bool) -> Result<Self> {
        let load = machine.load.filter(|_| is_loaded);
        let motor = load.map_or(MOTOR, |load| load.motor);
        let motor = Motor {
            microsteps: machine.microsteps,
            ..motor
        };
        let mut motors = Self {
            axes: [motor; 3].map(DrivenAxis::new),
            position: [0; 3],
            load,
            looked_s: 0.0,
        };
        motors.look(machine)?;
        Ok(motors)
    }

    /// They are commanded to a position at a time.
    pub(crate) fn follow(
        &mut self,
        machine: &Machine,
        time_s: f64,
        position: [i32; 3],
    ) -> Result<()> {
        if self.load.is_some() {
            while self.looked_s + LOOK_S < time_s {
                self.looked_s += LOOK_S;
                for axis in &mut self.axes {
                    axis.rotor_mut().turn_until(self.looked_s);
                }
                self.look(machine)?;
            }
        }
        let last = core::mem::replace(&mut self.position, position);
        let axes = self.axes.iter_mut().zip(position.into_iter().zip(last));
        for (axis, (to, from)) in axes {
            if to != from {
                axis.step(time_s, to - from);
            }
        }
        Ok(())
    }

    /// Gives each motor what it turns in this pose and at these speeds. With M the inertia, h what
    /// velocities and gravity ask for, t what the motors have:
    ///
    /// ```text
    /// M q'' = t - h,  load of a motor = h + Σ of the others' M q''
    /// ```
    fn look(&mut self, machine: &Machine) -> Result<()> {
        let Some(load) = &self.load else {
            return Ok(());
        };
        let (dynamics, ratio) = (&load.limits.dynamics, load.gear_ratio);
        let pose = machine.delta.pose_of(machine.angles(self.position))?;
        let mut rotors = self.axes.each_mut().map(DrivenAxis::rotor_mut);
        let rates = Vector3::from(rotors.each_ref().map(|it| it.speed_rad_s() / ratio));
        let has = Vector3::from(rotors.each_ref().map(|it| it.torque_nm() * ratio));
        let zero = Vector3::zeros();
        let held = dynamics.torques(&pose, zero, zero)?;
        let mut inertia = Matrix3::zeros();
        for (axis, mut column) in inertia.column_iter_mut().enumerate() {
            let unit = Vector3::from_fn(|row, _| f64::from(u8::from(row == axis)));
            column.copy_from(&(dynamics.torques(&pose, zero, unit)? - held));
        }
        let moved = dynamics.torques(&pose, rates, zero)?;
        let accelerations = inertia.lu().solve(&(has - moved));
        let accelerations = accelerations.context("arms without inertia")?;
        let own = inertia.diagonal();
        let loads = moved + inertia * accelerations - own.component_mul(&accelerations);
        for (rotor, (own, load)) in rotors.iter_mut().zip(own.iter().zip(&loads)) {
            rotor.set_load(own / ratio / ratio, load / ratio);
        }
        Ok(())
    }

    /// What was seen of each, in degrees of the arms; each edge is at most `deviation_steps` off
    /// its place.
    pub(crate) fn finish(self, machine: &Machine, deviation_steps: f64) -> [Followed; 3] {
        let step = StepSize::Degrees(machine.rad_per_step.to_degrees());
        self.axes.map(|axis| axis.finish(deviation_steps, step))
    }
}
