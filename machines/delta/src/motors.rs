//! What the emitted edges ask of the motors, and whether they follow.

use anyhow::Result;
use delta_kin::DeltaDynamics;
use known_load::PoseLoad;
use machine_sim::{DrivenAxis, Followed, Motor, StepSize};

use crate::machine::Machine;

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
    load: Option<PoseLoad<DeltaDynamics, 3>>,
}

impl Motors {
    /// Motors at home, with what they turn: a load that changes with the pose where the machine's
    /// is known and `is_loaded`, else the same all along.
    pub(crate) fn new(machine: &Machine, is_loaded: bool) -> Result<Self> {
        let load = machine.load.filter(|_| is_loaded);
        let motors = load.map_or([MOTOR; 3], |load| load.motors.map(|motor| motor.motor));
        let mut axes = motors.map(|motor| {
            DrivenAxis::new(Motor {
                microsteps: machine.microsteps,
                ..motor
            })
        });
        let rotors = axes.each_mut().map(DrivenAxis::rotor_mut);
        let home = machine.angles([0; 3]).into();
        let load = load.map(|load| PoseLoad::new(load, &home, rotors));
        Ok(Self {
            load: load.transpose()?,
            axes,
            position: [0; 3],
        })
    }

    /// They are commanded to a position at a time.
    pub(crate) fn follow(
        &mut self,
        machine: &Machine,
        time_s: f64,
        position: [i32; 3],
    ) -> Result<()> {
        if let Some(load) = &mut self.load {
            let rotors = self.axes.each_mut().map(DrivenAxis::rotor_mut);
            load.turn_until(time_s, &machine.angles(self.position).into(), rotors)?;
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

    /// What was seen of each, in degrees of the arms; each edge is at most `deviation_steps` off
    /// its place.
    pub(crate) fn finish(self, machine: &Machine, deviation_steps: f64) -> [Followed; 3] {
        let step = StepSize::Degrees(machine.rad_per_step.to_degrees());
        self.axes.map(|axis| axis.finish(deviation_steps, step))
    }
}
